"""The end of a run's report lists its failures by their causes, without consequences."""

from __future__ import annotations

from dataclasses import replace

from robbdd_tools.commands.failure_summary import MAX_CAUSES, failure_summary
from robbdd_tools.monitor.verdict import Cause
from robbdd_tools.protocol.messages import ClauseJudged
from robbdd_tools.run.results import ScenarioResult
from run.recorded import CLAUSES, spec

STUCK = "panda cannot reach a free place"


def scenario(index: int, *judged: tuple[str, float | None, str, str]) -> ScenarioResult:
    """A result with these verdicts, margins (m), reasons and causes of its clauses."""
    result = ScenarioResult(spec(index))
    for clause, (verdict, margin, reason, cause) in zip(CLAUSES, judged, strict=True):
        result.judged[clause.line] = ClauseJudged(index, clause.line, verdict, margin, "m", None, reason, cause=cause)
    return result


def test_equal_failures_are_counted_once_with_the_worst_margin_and_without_consequences() -> None:
    waits = ("unknown", None, f"event e never occurred: {STUCK}", Cause.NO_EVENT)
    late = ("unknown", None, "it timed out", Cause.TIMED_OUT)
    lines = failure_summary(
        [
            scenario(0, ("violated", -0.01, STUCK, ""), waits),
            scenario(1, ("violated", -0.03, STUCK, ""), waits),
            scenario(2, ("holds", 0.1, "", ""), late),
            scenario(3, ("holds", 0.1, "", ""), ("holds", 0.1, "", "")),
        ]
    )
    assert lines == [
        ("violated", f"✗ c5 in 2 scenarios, worst: {STUCK} (violated by −30 mm)"),
        ("unknown", "? c6: it timed out (unknown)"),
    ]


def test_a_long_list_of_causes_is_cut() -> None:
    holds = ("holds", 0.1, "", "")
    every = [scenario(index, ("violated", -0.1, f"reason {index}", ""), holds) for index in range(MAX_CAUSES + 2)]
    lines = [words for _, words in failure_summary(every)]
    assert len(lines) == MAX_CAUSES + 1
    assert lines[-1] == "… and 2 more causes"
    assert [words for _, words in failure_summary(every[:-1])][-1] == "… and 1 more cause"


def test_reasons_that_differ_in_measured_numbers_only_are_one_cause() -> None:
    holds = ("holds", 0.1, "", "")
    every = [scenario(index, ("violated", -0.1 * index, f"it took {index}.25 s", ""), holds) for index in (8, 9)]
    assert [words for _, words in failure_summary(every)] == [
        "✗ c5 in 2 scenarios, worst: it took 9.25 s (violated by −900 mm)"
    ]


def test_clauses_of_one_title_in_one_scenario_are_one_failure_of_it() -> None:
    """The iterations of a loop, or several behaviours."""
    failed = ("violated", -0.1, STUCK, "")
    every = [scenario(index, failed, failed) for index in range(2)]
    for one in every:
        first, second = one.spec.clauses[:2]
        one.spec = replace(one.spec, clauses=(first, replace(first, line=second.line)))
    assert [words for _, words in failure_summary(every[:1])] == [f"✗ c5: {STUCK} (violated by −100 mm)"]
    assert [words for _, words in failure_summary(every)] == [
        f"✗ c5 in 2 scenarios, worst: {STUCK} (violated by −100 mm)"
    ]
