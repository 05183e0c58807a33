"""Shape findings move with their text during edits, and arrive even while the user keeps typing."""

from __future__ import annotations

import io
from typing import Any

import pytest

from kit import FOLDER, MODEL, SCENE
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp.framing import Answer, Forget, Request
from robbdd_tools.lsp.shape_findings import ShapeFindings
from robbdd_tools.lsp.worker import MAX_LEFT, Inbox, Worker
from robbdd_tools.names.project import Project

MAIN = f"{FOLDER}main.bdd"
FOUND = "0.5 seconds"


def finding(text: str) -> Diagnostic:
    start = text.index(FOUND)
    return Diagnostic(MAIN, Span(start, start + len(FOUND)), Severity.ERROR, "shacl-test", "found")


def shown(text: str, *answers: Answer) -> list[Diagnostic]:
    """The findings shown in a text after some answers, all of which are about the model."""
    findings, project = ShapeFindings(), Project()
    for revision in range(3):
        findings.request(MAIN, revision, {MAIN: MODEL})
    for answer in answers:
        findings.take(answer)
    project.open(MAIN, 1, text)
    return findings.valid(project.snapshot(), MAIN)


@pytest.mark.parametrize(
    "text", [MODEL, f"// above\n{MODEL}", f"{MODEL}// below\n", MODEL.replace("before <", "after <")]
)
def test_a_finding_stays_where_its_text_is(text: str) -> None:
    assert shown(text, Answer(1, MAIN, (finding(MODEL),))) == [finding(text)]


@pytest.mark.parametrize("new", ["0.7 seconds", "0.5 secondss", "1 0.5 seconds", ""])
def test_a_finding_is_gone_where_its_text_was_edited(new: str) -> None:
    assert shown(MODEL.replace(FOUND, new), Answer(1, MAIN, (finding(MODEL),))) == []


def test_a_newer_answer_takes_the_place_of_an_older_one_and_not_the_other_way_round() -> None:
    found, nothing = Answer(1, MAIN, (finding(MODEL),)), Answer(2, MAIN, ())
    assert shown(MODEL, found, nothing) == shown(MODEL, nothing, found) == []


def test_an_answer_that_nobody_asked_for_is_not_shown() -> None:
    assert shown(MODEL, Answer(7, MAIN, (finding(MODEL),))) == []


def test_a_validation_that_failed_is_told_in_the_file() -> None:
    (told,) = shown(MODEL, Answer(1, MAIN, (), "KeyError: 'x'"))
    assert (told.code, told.severity) == ("shapes-unchecked", Severity.WARNING)
    assert "KeyError" in told.message


def test_one_validation_is_let_through_while_newer_ones_never_cease_to_come(monkeypatch: pytest.MonkeyPatch) -> None:
    def always(_: str) -> bool:
        return True

    inbox: Inbox[Request | Forget] = Inbox(io.BytesIO())
    monkeypatch.setattr(inbox, "has_newer", always)
    worker = Worker(inbox)

    def ask(revision: int) -> Any:
        texts = {f"{FOLDER}lab.scene": (1, SCENE), MAIN: (revision, MODEL.replace(FOUND, f"0.{revision + 1} seconds"))}
        return worker.answer(Request(revision, MAIN, texts, EditorShapes()))

    answers = [ask(revision) for revision in range(2 * (MAX_LEFT + 1))]
    through = [answer for answer in answers if answer is not None]
    assert [answer.revision for answer in through] == [MAX_LEFT, 2 * MAX_LEFT + 1]
