"""Verdicts of stored traces on edited clauses: counts, flips, and what must be run again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from features.judged_clauses import ONE
from gherkin_kit import edited
from kit import MODEL, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.features.clause_results import ResultHint, appearance, clause_diagnostics, clause_hints
from robbdd_tools.features.hover import hover
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import (
    JudgedScenario,
    Judgement,
    RejudgedExecution,
    Results,
    digests_of,
)

NS = "https://example.org/t/"
IRI = f"{NS}in-tray"
HOLDS = Judgement("in-tray", "holds", "+31 mm", 2e6, "✔ +31 mm", "")
VIOLATED = Judgement(
    "in-tray", "violated", "−12 mm", -0.012, "✗ −12 mm at 3.40 s", "", failure="violated by −12 mm at 3.40 s"
)
UNKNOWN = Judgement("in-tray", "unknown", "", 1e6, "? unknown: the stored trace ends at 2.00 s", "")
EDITED = edited("0.5 seconds after", "0.7 seconds after")
CHANGED = "the scene changed since the run: execute a new run"


def shown(
    executed: Sequence[Judgement],
    rejudged: Sequence[Judgement | str | None],
    text: str = EDITED,
) -> tuple[list[ResultHint], list[Diagnostic], str]:
    """The hints, the diagnostics and a hover of an edited text, whose executions were re-judged.

    A string is the reason why a trace is no evidence, and ``None`` an execution that was not judged yet.
    """
    case = fixture(MODEL)
    then = digests_of(case.snapshot, case.uri)
    case.project.open(case.uri, 2, text)
    now = digests_of(case.snapshot, case.uri)
    results = Results()
    found: dict[tuple[int, int], RejudgedExecution] = {}
    for index, (verdict, again) in enumerate(zip(executed, rejudged, strict=True)):
        scenario = JudgedScenario(
            case.uri, f"{NS}bench-to-tray", index + 1, f"part = {index}", "", "", run=1, index=index
        )
        scenario.judge(IRI, replace(verdict, digest=then.clauses[IRI]))
        scenario.finished = True
        results.add([scenario])
        if isinstance(again, str):
            found[1, index] = RejudgedExecution(again)
        elif again is not None:
            found[1, index] = RejudgedExecution("", {IRI: replace(again, digest=now.clauses[IRI])})
    findings = findings_of(results, {case.uri: found})
    described = hover(case.snapshot, case.uri, text.index("in-tray:"), findings)
    assert described is not None
    return (
        clause_hints(case.snapshot, case.uri, findings),
        clause_diagnostics(case.snapshot, case.uri, findings),
        described.markdown,
    )


def label(executed: Sequence[Judgement], rejudged: Sequence[Judgement | str | None], text: str = EDITED) -> str:
    ((hint,), _, _) = shown(executed, rejudged, text)
    return hint.label


def test_executions_that_flip_are_counted_and_listed_first() -> None:
    (hint,), (found,), described = shown([HOLDS, HOLDS, VIOLATED], [HOLDS, VIOLATED, VIOLATED])
    assert hint.label == "✗ 1 flipped, 1 of 3 hold (re-judged, not executed) · worst −12 mm"
    assert appearance(hint) == {"verdict": "violated", "stale": False, "rejudged": True}
    assert hint.tooltip.splitlines() == [
        "Re-judged on stored traces, not executed: run it to be sure.",
        "part = 1: ✔ +31 mm → ✗ −12 mm at 3.40 s",
        "part = 2: ✗ −12 mm at 3.40 s",
        "part = 0: ✔ +31 mm",
    ]
    assert (found.code, found.severity) == ("clause-rejudged", Severity.INFORMATION)
    first, second, *_ = found.message.splitlines()
    assert first == "violated by −12 mm at 3.40 s · 1 flipped, 1 of 3 hold (re-judged, not executed)"
    assert second == "part = 1: ✔ +31 mm → ✗ −12 mm at 3.40 s"
    assert "1 flipped, 1 of 3 hold (re-judged, not executed)" in described


def test_a_single_execution_shows_what_it_was() -> None:
    assert label([HOLDS], [VIOLATED]) == "✗ −12 mm at 3.40 s · was ✔ +31 mm (re-judged, not executed)"
    assert label([VIOLATED], [HOLDS]) == "✔ +31 mm · was ✗ −12 mm (re-judged, not executed)"
    assert label([HOLDS], [HOLDS]) == "✔ +31 mm (re-judged, not executed)"


def test_an_edit_that_all_traces_satisfy_is_no_finding_unless_some_flip() -> None:
    assert shown([HOLDS, HOLDS], [HOLDS, HOLDS])[1] == []
    ((found,),) = (shown([HOLDS, VIOLATED], [HOLDS, HOLDS])[1],)
    assert found.message.startswith("1 flipped, 2 of 2 hold (re-judged")


def test_what_a_trace_does_not_tell_is_unknown_and_no_flip() -> None:
    assert label([HOLDS, HOLDS], [HOLDS, UNKNOWN]) == "? 1 of 2 hold, 1 unknown (re-judged, not executed)"
    assert label([HOLDS], [UNKNOWN]) == (
        "? unknown: the stored trace ends at 2.00 s · was ✔ +31 mm (re-judged, not executed)"
    )


def test_a_trace_that_is_no_evidence_leaves_the_old_result_stale_with_the_reason() -> None:
    (hint,), found, _ = shown([HOLDS, HOLDS], [CHANGED, CHANGED], MODEL)
    assert hint.label == f"? {CHANGED}"
    assert appearance(hint) == {"verdict": "unknown", "stale": True, "rejudged": True}
    assert found == []
    assert (
        label([HOLDS, HOLDS], [CHANGED, HOLDS])
        == "✔ 1 of 1 hold, 1 to run again (re-judged, not executed) · worst +31 mm"
    )


def test_executions_that_are_not_judged_yet_are_counted() -> None:
    found = label([HOLDS, HOLDS, HOLDS], [HOLDS, None, None])
    assert found == "✔ 1 of 1 hold, 2 left to judge (re-judged, not executed) · worst +31 mm"


def test_a_verdict_on_an_older_text_of_the_clause_is_not_shown() -> None:
    case = fixture(ONE)
    digests = digests_of(case.snapshot, case.uri)
    scenario = JudgedScenario(case.uri, f"{NS}bench-to-tray", 1, "part = 1", "", "", run=1)
    scenario.judge(IRI, replace(HOLDS, digest=digests.clauses[IRI]))
    results = Results([scenario])
    rejudged = {case.uri: {(1, 0): RejudgedExecution("", {IRI: replace(VIOLATED, digest="of another text")})}}
    (hint,) = clause_hints(case.snapshot, case.uri, findings_of(results, rejudged))
    assert hint.label == "✔ +31 mm"
