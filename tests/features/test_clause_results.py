"""Results stand behind their clauses, aggregated over variations, until the clause is edited."""

from kit import MODEL, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.clause_results import (
    ClauseResult,
    JudgedClause,
    clause_diagnostics,
    clause_hints,
    clause_text,
)

IRI = "https://example.org/t/in-tray"
HOLDS = ClauseResult("holds", "✔ +31 mm", "part = bolt: ✔ +31 mm", 2.03)
VIOLATED = ClauseResult("violated", "✗ −12 mm at 3.40 s", "part = nut: ✗ −12 mm at 3.40 s", -0.012)
UNKNOWN = ClauseResult("unknown", "? unknown", "part = nut: ? unknown: event never occurred", 1.0)


def hints(*results: ClauseResult, text: str = MODEL) -> list[str]:
    case = fixture(MODEL)
    judged = {IRI: JudgedClause(clause_text(case.snapshot, IRI, [case.uri]) or "", results)}
    case.project.open(case.uri, 2, text)
    source = case.project.texts()[case.uri][1]
    return [
        f"{source[: hint.span.end].rsplit(':', 2)[-2][-7:]} {hint.label}"
        for hint in clause_hints(case.snapshot, case.uri, judged)
    ]


def test_one_result_is_shown_as_it_is() -> None:
    assert hints(HOLDS) == ["in-tray ✔ +31 mm"]


def test_several_results_show_the_worst_and_how_many_hold() -> None:
    assert hints(HOLDS, VIOLATED, HOLDS) == ["in-tray ✗ 2/3  worst −12 mm at 3.40 s"]


def test_an_edit_elsewhere_keeps_the_result() -> None:
    assert hints(HOLDS, text="// note\n" + MODEL) == ["in-tray ✔ +31 mm"]


def test_an_edited_clause_has_no_result() -> None:
    assert hints(HOLDS, text=MODEL.replace("0.5 seconds after", "0.6 seconds after")) == []


def test_what_does_not_hold_is_a_diagnostic() -> None:
    case = fixture(MODEL)
    text = clause_text(case.snapshot, IRI, [case.uri])
    assert text is not None
    for result, severity in ((VIOLATED, Severity.ERROR), (UNKNOWN, Severity.WARNING)):
        (found,) = clause_diagnostics(case.snapshot, case.uri, {IRI: JudgedClause(text, (HOLDS, result))})
        assert found.severity is severity
        assert result.detail in found.message
    assert clause_diagnostics(case.snapshot, case.uri, {IRI: JudgedClause(text, (HOLDS,))}) == []
