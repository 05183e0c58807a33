"""Edits are judged at once on stored traces: beside the clause, marked, and never in place of an execution."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import sys
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

import robbdd_tools as robbdd
from kit import EXAMPLES, schema_errors
from lsp_kit import PATIENCE, Editor, plain
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.cli import main
from robbdd_tools.lsp.framing import Edited
from robbdd_tools.lsp.rejudge_worker import Worker
from robbdd_tools.lsp.worker import Inbox
from robbdd_tools.workbench.stored import store_at

pytestmark = pytest.mark.physics
GOAL = "<thing> is located at <goal>, after <evt-place-end>"
EARLY = GOAL.replace("place-end", "pick-end")
LATE = GOAL.replace("after", "30 seconds after")
MARK = "(re-judged, not executed)"
AGAIN = "changed since the run: execute a new run"


@pytest.fixture
def judged(editor: Editor) -> Editor:
    """Two executions of the example, by the command line, and the document open and unedited."""
    assert main(["run", str(editor.path), "--first", "2"]) == 0
    editor.open()
    return editor


async def hints(editor: Editor) -> dict[str, str]:
    """The verdicts in the text, by the name of the clause or the words of the row."""
    document = types.TextDocumentIdentifier(uri=editor.uri)
    found = await editor.client.text_document_inlay_hint_async(types.InlayHintParams(document, editor.everything()))
    lines = editor.text.splitlines()
    verdicts = [hint for hint in found or () if hint.data is not None]
    return {lines[hint.position.line].partition(":")[0].strip(): str(hint.label) for hint in verdicts}


async def hint(editor: Editor, clause: str, beginning: str) -> str:
    """Wait until the verdict on a clause begins with some words, and return it."""
    async with asyncio.timeout(PATIENCE):
        while not (shown := (await hints(editor)).get(clause, "")).startswith(beginning):
            await asyncio.sleep(0.02)
    return shown


async def test_clients_that_draw_verdicts_get_those_of_the_whole_document(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    document = types.TextDocumentIdentifier(uri=judged.uri)
    hints = await judged.client.text_document_inlay_hint_async(types.InlayHintParams(document, judged.everything()))
    answer = plain(await judged.client.protocol.send_request_async("robbdd/verdicts", {"uri": judged.uri}))
    assert schema_errors("verdicts.schema.json", answer) == []
    expected = [
        {
            "position": {"line": hint.position.line, "character": hint.position.character},
            "label": hint.label,
            "tooltip": hint.tooltip,
            "data": plain(hint.data),
        }
        for hint in hints or ()
        if hint.data is not None
    ]
    assert len(expected) > 3
    assert [{name: one[name] for name in expected[0]} for one in answer] == expected


async def test_an_edited_clause_shows_which_executions_flip_until_the_edit_is_undone(judged: Editor) -> None:
    assert "stale" not in await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change(GOAL, EARLY)
    shown = await hint(judged, "at-goal", "✗")
    assert shown.startswith(f"✗ 2 flipped, 0 of 2 hold {MARK} · worst −")
    (found,) = await judged.diagnostics("clause-rejudged")
    assert found.severity is types.DiagnosticSeverity.Information
    assert found.range.start.line == judged.position(EARLY).line
    assert "→ ✗" in found.message
    others = {clause: label for clause, label in (await hints(judged)).items() if clause != "at-goal"}
    assert not [label for label in others.values() if MARK in label], "only the edited clause is re-judged"

    answer = plain(await judged.client.protocol.send_request_async("robbdd/testResults", {}))
    assert {one["verdict"] for scenario in answer["scenarios"] for one in scenario["clauses"]} == {"holds"}
    (run,) = robbdd.runs(judged.path)
    assert {clause.verdict for result in run.results for clause in result.clauses} == {"holds"}, "nothing is stored"

    judged.change(EARLY, GOAL)
    await hint(judged, "at-goal", "? 2 of 4 executed")
    await judged.diagnostics()


async def test_what_the_traces_do_not_tell_is_unknown(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change(GOAL, LATE)
    assert await hint(judged, "at-goal", "? 0 of") == f"? 0 of 2 hold, 2 unknown {MARK}"
    (found,) = await judged.diagnostics("clause-rejudged")
    assert "the stored trace ends at" in found.message
    assert "when the window closes: execute a new run" in found.message


async def test_a_change_beyond_clauses_makes_every_verdict_stale_and_judges_nothing(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change("at-source: holds(<thing> is located at <source>", "at-source: holds(<thing> is located at <goal>")
    for clause in ("at-source", "in-hand", "at-goal"):
        assert await hint(judged, clause, "? the") == f"? the scene {AGAIN}"
    await judged.diagnostics()
    judged.change("at-source: holds(<thing> is located at <goal>", "at-source: holds(<thing> is located at <source>")
    await hint(judged, "in-hand", "? 2 of 4 executed")


async def test_an_edit_of_an_imported_scene_reaches_the_verdicts(judged: Editor, tmp_path: Path) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    scene = Editor(judged.client, tmp_path, "pickplace/bench.scene")
    scene.open()
    scene.change("balls { base name: ball count: 1 }", "balls { base name: ball count: 2 }")
    assert await hint(judged, "at-goal", "? the") == f"? the scene {AGAIN}"


async def test_values_that_a_scenario_no_longer_has_are_not_judged(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change("{ <cubes.cube0>, <balls.ball0> }", "{ <balls.ball0> }")
    shown = await hint(judged, "at-goal", "? the model")
    assert shown == "? the model no longer has this scenario with these values: execute a new run"


async def test_a_text_with_errors_is_not_judged_and_the_next_edit_is(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change(GOAL, EARLY)
    await hint(judged, "at-goal", "✗ 2 flipped")
    judged.change("<robot> picks", "<robo> picks")
    assert (await hint(judged, "at-goal", "? 2 of 4 executed")).endswith("(stale)")
    judged.change("<robo> picks", "<robot> picks")
    await hint(judged, "at-goal", "✗ 2 flipped")


async def test_a_clause_that_a_step_of_the_project_may_judge_is_left_to_a_run(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    steps = judged.path.parent / "steps"
    steps.mkdir()
    text = "from behave import then\n\n\n@then('{anything} after event {other}')\ndef judge(*_):\n    pass\n"
    (steps / "pickplace_steps.py").write_text(text, encoding="utf-8")
    judged.change(GOAL, EARLY)
    assert (await hint(judged, "at-goal", "? 0 of 2 hold, 2 unknown")).endswith(MARK)
    (found,) = await judged.diagnostics("clause-rejudged")
    assert "a step of the project judges it: execute a new run" in found.message


async def test_a_run_replaces_what_was_rejudged_clauses(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change(GOAL, EARLY)
    await hint(judged, "at-goal", "✗ 2 flipped")
    target = {"uri": judged.uri, "first": 2}
    await judged.client.workspace_execute_command_async(types.ExecuteCommandParams("robbdd.run", [target]))
    assert MARK not in await hint(judged, "at-goal", "✗ 0/2")
    await judged.diagnostics("clause-violated")


async def test_a_setting_turns_it_off_and_on(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change(GOAL, EARLY)
    await hint(judged, "at-goal", "✗ 2 flipped")
    set_rejudge(judged, wanted=False)
    assert (await hint(judged, "at-goal", "? 2 of 4 executed")).endswith("(stale)")
    await judged.diagnostics()
    judged.change(EARLY, LATE)
    assert (await hint(judged, "at-goal", "? 2 of 4 executed")).endswith("(stale)")
    set_rejudge(judged, wanted=True)
    assert (await hint(judged, "at-goal", "? 0 of 2")).endswith(MARK)


def set_rejudge(editor: Editor, *, wanted: bool) -> None:
    """Change the setting ``robbdd.rejudge`` in the client."""
    settings = {"robbdd": {"rejudge": wanted}}
    editor.client.set_configuration(settings)
    editor.client.set_configuration(settings, scope_uri=path_to_uri(editor.path.parent))
    editor.client.workspace_did_change_configuration(types.DidChangeConfigurationParams(settings=settings))


@pytest.mark.skipif(sys.platform != "linux", reason="finds the process in /proc")
async def test_a_process_that_dies_is_replaced_at_the_next_edit(judged: Editor) -> None:
    await hint(judged, "at-goal", "? 2 of 4 executed")
    judged.change(GOAL, EARLY)
    await hint(judged, "at-goal", "✗ 2 flipped")
    client: Any = judged.client
    for process in processes(client._server.pid):
        os.kill(process, signal.SIGKILL)
    judged.change(EARLY, LATE)
    await hint(judged, "at-goal", "? 0 of 2")


def processes(server: int) -> list[int]:
    """The processes that judge traces for a server."""
    found: list[int] = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                words = (entry / "cmdline").read_text(encoding="utf-8").split("\0")
                parent = int((entry / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()[1])
            except OSError:
                continue
            if parent == server and any("rejudge_worker" in word for word in words):
                found.append(int(entry.name))
    return found


def test_the_process_keeps_nothing_of_runs_that_are_no_longer_shown(tmp_path: Path) -> None:
    shutil.copytree(EXAMPLES / "pickplace", tmp_path / "pickplace")
    model = tmp_path / "pickplace" / "pickplace.bdd"
    for _ in range(2):
        assert main(["run", str(model), "--first", "1"]) == 0
    uri, store = path_to_uri(model), str(store_at(model, None).folder)
    (tmp_path / "judge").mkdir()
    reading, writing = os.pipe()
    with os.fdopen(writing, "wb"):
        worker = Worker(Inbox(os.fdopen(reading, "rb")), tmp_path / "judge")
        kept: list[set[str]] = []
        for shown in ({1: (0,), 2: (0,)}, {2: (0,)}):
            answers = list(worker.answers(Edited(1, uri, {uri: (1, model.read_text("utf-8"))}, store, shown)))
            assert [answer.problem for answer in answers] == [""]
            kept.append({path.parent.name for path in (*worker.manifests, *(run / "_" for run in worker.loaded))})
        assert worker.judge is not None
        worker.judge.end()
    assert kept == [{"1", "2"}, {"2"}]
