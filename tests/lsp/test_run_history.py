"""A clause in all stored runs, and two runs side by side, as requested by clients and shown in hovers."""

from __future__ import annotations

import asyncio
import json
import os
import re
from collections.abc import AsyncIterator
from contextlib import closing
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest
import pytest_asyncio
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pytest_lsp import client_capabilities, make_test_lsp_client

from fork_kit import ROBBDD_LSP
from kit import EXAMPLES, schema_errors
from lsp_kit import PATIENCE, Editor, begin_session, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.project import Project
from robbdd_tools.protocol.specs import ClauseSpec
from robbdd_tools.run.database import open_database
from robbdd_tools.run.store import store_beside
from robbdd_tools.workbench.judged_text import judged_texts, write_texts
from run.recorded import record_run

CLAUSE = "at-goal: holds("
VARIANT = "https://example.org/robbdd/criteria/part-to-bin"
EDIT = ("<thing> is located at <goal>, after <evt-place-end>", "<thing> is located at <goal>, after <evt-pick-end>")


def record(model: Path, *runs: list[float | None]) -> str:
    """Record runs in which the goal clause has some margins (m); return its IRI."""
    project = Project()
    uri = path_to_uri(model)
    project.load(uri)
    snapshot = project.snapshot()
    iri = next(clause.iri for clause in clauses_in(snapshot, uri) if clause.name == "at-goal")
    for number, margins in enumerate(runs, start=1):
        clauses = (ClauseSpec(5, iri, "at-goal", "then", "at goal"),)
        place = record_run(store_beside(model), margins, clauses=clauses, seed=number)
        write_texts(judged_texts([("", snapshot, uri)]), place.folder)
    return iri


async def ask(editor: Editor, request: str, **parameters: object) -> Any:
    answer = await editor.client.protocol.send_request_async(f"robbdd/{request}", {"uri": editor.uri, **parameters})
    return plain(answer)


async def test_the_history_of_a_clause_counts_each_run_and_tells_which_judged_another_text(editor: Editor) -> None:
    iri = record(editor.path, [0.2, 0.1], [0.2, -0.1])
    editor.open()
    answer = await ask(editor, "history", position={"line": editor.position(CLAUSE).line, "character": 20})
    assert schema_errors("history.schema.json", answer) == []
    assert (answer["clause"], answer["name"]) == (iri, "at-goal")
    first, second = answer["runs"]
    assert (first["run"], first["judged"], first["margin"], first["stale"]) == (
        1, {"holds": 2, "violated": 0, "unknown": 0}, 0.1, False,
    )  # fmt: skip
    assert (second["run"], second["judged"]["violated"], second["worst"], second["state"]) == (2, 1, 1, "finished")
    editor.change(*EDIT)
    edited = await ask(editor, "history", clause=iri)
    assert [run["stale"] for run in edited["runs"]] == [True, True]
    assert await ask(editor, "history", position={"line": 0, "character": 0}) is None


async def test_a_large_run_is_announced_with_the_time_that_stored_runs_need(editor: Editor) -> None:
    record(editor.path, [0.2, 0.1], [0.2])
    with closing(open_database(store_beside(editor.path).database)) as database:
        database.execute("UPDATE execution SET wall = 400, variant = ?", (VARIANT,))
    editor.open()
    answer = await estimated(editor, jobs=2, repeat=3)
    assert answer == {"executions": 12, "seconds": 2400, "measured": 3, "words": "12 executions, about 40 min"}
    assert (await estimated(editor, where="goal=left_ws", first=1))["words"] == "1 execution, about 7 min"
    assert await estimated(editor, where="goal=nowhere") == {"problem": "no scenario fits the selection"}
    assert (await estimated(editor, jobs="two"))["problem"].endswith("it must be a whole number above 0")
    everything = types.Range(types.Position(0, 0), types.Position(1000, 0))
    document = types.TextDocumentIdentifier(editor.uri)
    hints = await editor.client.text_document_inlay_hint_async(types.InlayHintParams(document, everything))
    minutes = round(4 * 400 / min(4, os.cpu_count() or 1) / 60)
    assert f"4 scenarios, about {minutes} min" in [hint.label for hint in hints or ()]


async def estimated(editor: Editor, **options: object) -> Any:
    params = types.ExecuteCommandParams("robbdd.estimate", [{"uri": editor.uri, **options}])
    answer = plain(await editor.client.workspace_execute_command_async(params))
    assert schema_errors("estimate.schema.json", answer) == []
    return answer


async def test_two_runs_are_compared_as_documented(editor: Editor) -> None:
    record(editor.path, [0.2, 0.1, None], [0.2, -0.1])
    answer = await ask(editor, "compare", before=1, after=2)
    assert schema_errors("compare.schema.json", answer) == []
    assert (answer["before"]["run"], answer["after"]["violated"], answer["same"]) == (1, 1, 1)
    assert (answer["flipped"], len(answer["changes"]), answer["inputs"]) == (1, 2, ["seed 1 became 2"])
    (clause,) = answer["changes"][0]["clauses"]
    assert (clause["name"], clause["before"], clause["after"]) == ("at-goal", "holds", "violated")
    for parameters in ({"before": 1, "after": 9}, {"before": 1}):
        with pytest.raises(JsonRpcException, match=r"there is no run '9'|must be the numbers of two stored runs"):
            await ask(editor, "compare", **parameters)


@pytest_asyncio.fixture
async def recorded(tmp_path: Path, request: pytest.FixtureRequest) -> AsyncIterator[Editor]:
    """The example with three runs in a client that shows histories, or does not."""
    client: Any = make_test_lsp_client()
    await client.start_io(*ROBBDD_LSP, "--stdio")
    capabilities = client_capabilities("visual-studio-code")
    await begin_session(client, tmp_path, capabilities, [], {"history": getattr(request, "param", True)})
    editor = Editor(client, tmp_path)
    assert editor.path.read_text() == (EXAMPLES / "pickplace/pickplace.bdd").read_text()
    record(editor.path, [0.2, 0.1], [0.2, None], [-0.1, -0.2])
    editor.open()
    await ask(editor, "testResults")
    yield editor
    await client.shutdown_session()


@pytest.mark.parametrize("recorded", [True, False], indirect=True, ids=["linked", "plain"])
async def test_a_hover_lists_the_verdicts_of_the_latest_runs(recorded: Editor, request: pytest.FixtureRequest) -> None:
    lines: list[str] = []
    async with asyncio.timeout(PATIENCE):  # until the results of the stored runs are shown
        while not lines:
            shown = await recorded.client.text_document_hover_async(types.HoverParams(**recorded.at(CLAUSE)))
            assert shown is not None
            assert isinstance(shown.contents, types.MarkupContent)
            lines = [line for line in shown.contents.value.splitlines() if line.startswith("Runs of at-goal")]
    (line,) = lines
    assert line.startswith("Runs of at-goal: ✗ 0/2 (run 3) · ? 1/2 (run 2) · ✔ 2/2 (run 1)")
    links = re.findall(r"\[History\]\(command:robbdd.showHistory\?([^)]*)\)", line)
    if request.node.callspec.params["recorded"]:
        (target,) = json.loads(unquote(links[0]))
        assert target == {"uri": recorded.uri, "clause": (await ask(recorded, "history", **target))["clause"]}
    else:
        assert links == []
