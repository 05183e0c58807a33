"""Progress of runs in the client's window: only where the client announced it, and did not refuse it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
import pytest_lsp
from lsprotocol import types
from pygls.exceptions import JsonRpcInternalError
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

from campaign.study_agents import QuickAgent, write_study
from fork_kit import ROBBDD_LSP
from kit import make_endless
from lsp_kit import PATIENCE, Editor, begin_session
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.run import scheduler
from robbdd_tools.run.run_policy import Policy

Told = list[tuple[str, Any]]
SHOWN, REFUSED, UNKNOWN = "shown", "refused", "unknown"


@pytest.fixture
def told() -> Told:
    """Kind and value of each progress message sent to the client."""
    return []


# pytest-lsp leaves the types of its decorator open.
@pytest_lsp.fixture(  # pyright: ignore[reportUnknownMemberType]
    config=ClientServerConfig(server_command=[*ROBBDD_LSP, "--stdio"]),
)
async def client(
    request: pytest.FixtureRequest, lsp_client: LanguageClient, tmp_path: Path, told: Told
) -> AsyncIterator[None]:
    capabilities = client_capabilities("neovim")
    capabilities.window = types.WindowClientCapabilities(work_done_progress=request.param != UNKNOWN)

    def create(_: types.WorkDoneProgressCreateParams) -> None:
        told.append(("create", None))
        if request.param == REFUSED:
            raise JsonRpcInternalError("no progress here")

    def hear(params: Any) -> None:
        told.append((params.value["kind"], params.value))

    def ignore(*_: object, **__: object) -> None:
        pass

    # In place of what pytest-lsp does by itself, which also takes a refusal for a failure of the client's.
    lsp_client.report_server_error = ignore
    for method, handler in {types.WINDOW_WORK_DONE_PROGRESS_CREATE: create, types.PROGRESS: hear}.items():
        # pygls leaves the type of its table open.
        lsp_client.protocol.fm.features[method] = handler  # pyright: ignore[reportUnknownMemberType]
    await begin_session(lsp_client, tmp_path, capabilities, [])
    yield
    await lsp_client.shutdown_session()


@pytest.mark.physics
@pytest.mark.parametrize(
    ("client", "kinds"),
    [(SHOWN, ["create", "begin", *["report"] * 4, "end"]), (REFUSED, ["create"]), (UNKNOWN, [])],
    indirect=["client"],
)
async def test_a_run_shows_its_progress_where_the_client_shows_such_things(
    client: LanguageClient, tmp_path: Path, told: Told, kinds: list[str]
) -> None:
    editor = Editor(client, tmp_path)
    editor.open()
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": editor.uri}])
    answer: Any = await client.workspace_execute_command_async(params)
    assert answer["total"] == 4
    assert [kind for kind, _ in told] == kinds
    messages = [value["message"] for kind, value in told if kind == "report"]
    assert messages == [f"{done}/4 scenarios" for done in range(1, 5)][: len(messages)]


@pytest.mark.physics
@pytest.mark.parametrize("client", [SHOWN], indirect=True)
async def test_the_progress_counts_violated_scenarios_as_failed_and_unknown_ones_as_errored(
    client: LanguageClient, tmp_path: Path, told: Told
) -> None:
    editor = Editor(client, tmp_path)
    editor.open()
    goal = "<thing> is located at <goal>, after <evt-{}>"
    for event, word in (("pick-end", "failed"), ("stray", "errored")):
        told.clear()
        editor.change(goal.format("place-end"), goal.format(event))
        if event == "stray":
            editor.change("Event (ns=crit) evt-end", "Event (ns=crit) evt-end\nEvent (ns=crit) evt-stray")
        params = types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": editor.uri, "first": 1}])
        await client.workspace_execute_command_async(params)
        assert [value["message"] for kind, value in told if kind == "report"] == [f"1/1 scenarios, 1 {word}"]
        editor.change(goal.format(event), goal.format("place-end"))


@pytest.mark.physics
@pytest.mark.parametrize("client", [SHOWN], indirect=True)
async def test_the_progress_of_a_cancelled_run_ends_by_saying_so(
    client: LanguageClient, tmp_path: Path, told: Told
) -> None:
    editor = Editor(client, tmp_path)
    make_endless(editor.path)
    editor.open()
    params = types.ExecuteCommandParams(command="robbdd.run", arguments=[{"uri": editor.uri}])
    running = asyncio.ensure_future(client.workspace_execute_command_async(params))
    async with asyncio.timeout(PATIENCE):
        while not told:
            await asyncio.sleep(0.01)
    await client.workspace_execute_command_async(types.ExecuteCommandParams(command="robbdd.cancel"))
    await running
    kind, value = told[-1]
    assert kind == "end"
    assert value["message"].startswith("cancelled: ")


async def progress_text(told: Told, kind: str) -> str:
    """Wait for a message of this kind about progress, and return its text."""
    async with asyncio.timeout(PATIENCE):
        while kind not in [name for name, _ in told]:
            await asyncio.sleep(0.01)
    return next(value["message"] for name, value in told if name == kind)


@pytest.mark.parametrize("client", [SHOWN], indirect=True)
@pytest.mark.parametrize("project", ["", "inside"])
async def test_a_study_that_another_process_executes_shows_its_progress(
    client: LanguageClient, tmp_path: Path, told: Told, monkeypatch: pytest.MonkeyPatch, project: str
) -> None:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    path = write_study(tmp_path / project)
    if project:
        # The results of a project inside the workspace are found by its open files.
        Editor(client, path.parent, path.name).open()
    with StudyRun(load_study(path), study_folder(path), Policy.of(jobs=1), resumed=False) as run:
        progress = run.progress()
        for _ in range(10):
            next(progress)
        words = await progress_text(told, "report")
        begun = next(value for name, value in told if name == "begin")
        assert begun["title"] == "Study fetching"
        done = int(words.split()[0])
        assert 10 <= done < 40
        assert words.startswith(f"{done} of 40 executions; ")
        assert " hold (" in words
        for _ in progress:
            pass
    assert await progress_text(told, "end") == "40 of 40 executions; 35 hold (88%), 5 do not; worst clause: on-bench"
    assert [kind for kind, _ in told].count("begin") == 1
