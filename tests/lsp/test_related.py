"""Related scenarios in an editor: each story's clauses show results of one execution of their tree."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from commands.test_related import LOST, model
from lsp.test_runs import execute
from lsp_kit import Editor, plain
from robbdd_tools.base.files import path_to_uri

pytestmark = pytest.mark.physics


def opened(client: LanguageClient, folder: Path, weight: float | None = None) -> Editor:
    """The example for its cube alone, which weighs so many kg where something is said, open in the client."""
    below = folder / "stories"
    below.mkdir()
    editor = Editor(client, folder)
    editor.path = model(below, weight)
    editor.uri = path_to_uri(editor.path)
    editor.open(editor.path.read_text(encoding="utf-8"))
    return editor


async def shown(editor: Editor) -> dict[str, str]:
    """Verdict and margin of each clause, by its name, without the behaviours."""
    document = types.TextDocumentIdentifier(uri=editor.uri)
    params = types.InlayHintParams(text_document=document, range=editor.everything())
    found = await editor.client.text_document_inlay_hint_async(params) or []
    lines = editor.text.split("\n")
    return {
        name: str(hint.label)
        for hint in found
        if hint.kind is None
        and not (name := lines[hint.position.line].strip(" (").partition(":")[0]).startswith("Behaviour")
    }


async def test_three_stories_show_what_one_execution_told(client: LanguageClient, tmp_path: Path) -> None:
    editor = opened(client, tmp_path)
    answer = await execute(editor, "run")
    assert (answer["total"], answer["holds"]) == (3, 3)
    found = await shown(editor)
    names = ["at-source", "in-hand", "still-in-hand", "at-goal", "goal-untouched", "on-bench", "in-bin"]
    assert list(found) == names
    assert all(label.startswith("✔") for label in found.values()), found
    # Two stories find the object on the bench, at one moment of one execution.
    assert found["at-source"] == found["on-bench"]


async def test_what_was_not_reached_is_shown_at_the_clauses_of_its_story(
    client: LanguageClient, tmp_path: Path, run_messages: list[Any]
) -> None:
    editor = opened(client, tmp_path, weight=10)
    answer = await execute(editor, "run")
    assert (answer["total"], answer["violated"], answer["unknown"]) == (3, 2, 1)
    found = await shown(editor)
    placing = ["still-in-hand", "at-goal", "goal-untouched"]
    assert [found[name] for name in placing] == ["? unknown", *["? for the same reason as still-in-hand"] * 2]
    assert found["on-bench"].startswith("✔")
    (lost,) = (entry for entry in client.diagnostics[editor.uri] if LOST.replace("env:", "") in entry.message)
    assert (lost.code, "and so 3 more clauses" in lost.message) == ("clause-unknown", True)
    lines = editor.text.split("\n")
    followers = [lines[one.location.range.start.line].strip(" (") for one in lost.related_information or ()]
    assert lines[lost.range.start.line].strip(" (").startswith("still-in-hand:")
    assert [line.partition(":")[0].partition(" ")[0] for line in followers] == [
        "Behaviour",
        "at-goal",
        "goal-untouched",
    ]
    judged = [entry.message for entry in run_messages if entry.message.type == "ClauseJudged"]
    (cause,) = (one for one in judged if one.name == "still-in-hand")
    assert cause.because is None
    expected = {
        "clause": cause.clause,
        "position": cause.position,
        "words": "unknown for the same reason as still-in-hand",
    }
    folded = [plain(one.because) for one in judged if one.index == cause.index and one is not cause]
    assert folded == [expected] * 3
    kept = plain(await client.protocol.send_request_async("robbdd/testResults", {}))
    clauses = [one for scenario in kept["scenarios"] for one in scenario["clauses"]]
    causes = [one["because"] for one in clauses if one["because"] and one["because"]["clause"] == cause.clause]
    assert causes == [{**expected, "position": None}] * 3
