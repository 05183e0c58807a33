"""The editor shows the verdicts of the store: those of the command line, and those of a server that died."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any, cast

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient, client_capabilities, make_test_lsp_client

import robbdd_tools as robbdd
from kit import MODEL, SCENE, make_endless
from lsp_kit import PATIENCE, Editor, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main
from robbdd_tools.features.run_verdicts import JudgedScenario, Results


async def session(folder: Path) -> LanguageClient:
    """A client with its own server."""
    client = make_test_lsp_client()
    # The type of its further arguments is left open.
    await cast(Any, client).start_io(sys.executable, "-m", "robbdd_tools.lsp.main", "--stdio")
    root = types.WorkspaceFolder(uri=path_to_uri(folder), name="test")
    capabilities = client_capabilities("neovim")
    await client.initialize_session(types.InitializeParams(capabilities=capabilities, workspace_folders=[root]))
    return client


async def kept(client: LanguageClient) -> list[Any]:
    answer = await client.protocol.send_request_async("robbdd/testResults", {})
    return sorted(plain(answer)["scenarios"], key=lambda one: one["variation"])


async def until(so: Callable[[], Awaitable[bool]]) -> None:
    async with asyncio.timeout(PATIENCE):
        while not await so():
            await asyncio.sleep(0.02)


@pytest.mark.physics
async def test_the_first_tree_of_tests_knows_the_stored_results(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    path = tmp_path / "main.bdd"
    path.write_text(MODEL, encoding="utf-8")
    assert main(["run", str(path), "--first", "1"]) in (0, 1)
    client = await session(tmp_path)
    answer = await client.protocol.send_request_async("robbdd/tests", {"uri": path_to_uri(path)})
    ((variant,),) = [story["tests"] for story in plain(answer)["tests"]]
    assert variant["detail"][1:].startswith(" 1 of 4 executed, ")
    await client.shutdown_session()


def report_ended_run(editor: Editor, number: int) -> None:
    """Send the notifications of a client that watches files."""
    results = editor.path.parent / ".robbdd" / "runs" / str(number) / "results.json"
    change = types.FileEvent(path_to_uri(results), types.FileChangeType.Created)
    editor.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([change]))


@pytest.mark.physics
async def test_runs_of_the_command_line_are_shown_when_they_end_and_after_a_restart(
    editor: Editor, tmp_path: Path
) -> None:
    editor.open()
    assert await kept(editor.client) == []
    assert main(["run", str(editor.path), "--first", "1", "--seed", "3"]) == 0
    report_ended_run(editor, 1)

    async def is_shown() -> bool:
        return len(await kept(editor.client)) == 1

    await until(is_shown)
    (scenario,) = await kept(editor.client)
    assert (scenario["uri"], scenario["variation"], scenario["stale"]) == (editor.uri, 1, False)
    assert {(clause["verdict"], clause["stale"]) for clause in scenario["clauses"]} == {("holds", False)}

    assert main(["run", str(editor.path), "--first", "2"]) == 0
    editor.path.write_text(editor.text.replace("<thing> is located at <goal>", "<thing> is located at <source>"))
    later = await session(tmp_path)
    found = await kept(later)
    assert [one["variation"] for one in found] == [1, 2]
    stale = {clause["clause"].rpartition("/")[2] for one in found for clause in one["clauses"] if clause["stale"]}
    assert stale == {"at-goal"}
    await later.shutdown_session()
    known = json.loads((tmp_path / ".robbdd" / "results.json").read_text(encoding="utf-8"))
    store = str(editor.path.parent / ".robbdd" / "runs")
    assert {folder: run["number"] for folder, run in known["seen"].items()} == {store: 2}


@pytest.mark.physics
async def test_what_a_killed_server_had_finished_is_shown_by_the_next_one(
    editor: Editor, tmp_path: Path, run_messages: list[Any]
) -> None:
    make_endless(editor.path)
    client = await session(tmp_path)

    def hear(notification: Any) -> None:
        run_messages.append(notification)

    client.feature("robbdd/runMessage")(hear)
    target = {"uri": editor.uri, "jobs": 1}
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[target])
    running = asyncio.ensure_future(client.workspace_execute_command_async(params))

    async def has_finished_one() -> bool:
        return any(entry.message.type == "ScenarioFinished" for entry in run_messages)

    await until(has_finished_one)
    server: Any = client
    os.kill(server._server.pid, signal.SIGKILL)
    running.cancel()
    (run,) = robbdd.runs(editor.path)
    finished = sum(result.duration is not None for result in run.results)
    later = await session(tmp_path)
    found = await kept(later)
    assert len(found) == finished > 0
    assert {clause["verdict"] for one in found for clause in one["clauses"]} == {"holds"}
    await later.shutdown_session()


def scenario(run: int, repetition: int = 1, execution: str = "") -> JudgedScenario:
    return JudgedScenario("", "v", 1, "", "", "", run=run, repetition=repetition, execution=execution)


def runs(results: Results) -> list[tuple[int, int]]:
    return [(one.run, one.repetition) for one in results]


def test_a_stored_run_replaces_older_results_only() -> None:
    results = Results([scenario(2, 1), scenario(2, 2)])
    results.merge([scenario(1)], newest=3)
    assert runs(results) == [(2, 1), (2, 2)]
    results.merge([scenario(3, 2)], newest=3, some_repetitions=True)
    assert runs(results) == [(2, 1), (3, 2)]
    results.merge([scenario(4, 1), scenario(4, 2)], newest=4)
    assert runs(results) == [(4, 1), (4, 2)]
    results.merge([scenario(1)], newest=1)
    assert runs(results) == [(1, 1)], "numbers begin again in a store that was deleted"
