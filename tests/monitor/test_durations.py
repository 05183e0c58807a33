"""The time between two events is measured exactly, and a missing event is never a short time."""

from __future__ import annotations

from dataclasses import replace

import pytest

from monitor.traces import still, trace_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import WindowEvidence, judge
from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint, Window
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict

TAKES = load_catalog().predicates["takes-less-than"]
SPAN = During("a", "b")


def trace(samples: int = 21, **events: float) -> Trace:
    return trace_of({"x": still(samples)}, events)


def judged(limit: str, found: Trace, time: TimeConstraint = SPAN) -> Verdict:
    return judge(TAKES, {"limit": limit}, time, found, {})


@pytest.mark.parametrize(
    ("limit", "outcome", "margin", "unit"),
    [
        ("1 s", Outcome.HOLDS, 0.0, "s"),
        ("1.25 s", Outcome.HOLDS, 0.25, "s"),
        ("0.75 s", Outcome.VIOLATED, -0.25, "s"),
        ("750 ms", Outcome.VIOLATED, -250.0, "ms"),
    ],
)
def test_the_margin_is_the_time_left(limit: str, outcome: Outcome, margin: float, unit: str) -> None:
    found = judged(limit, trace(a=0.25, b=1.25))
    assert (found.outcome, found.robustness, found.unit) == (outcome, pytest.approx(margin), unit)
    assert found.reason == "it took 1.00 s"


def test_events_between_samples_are_not_rounded_to_samples() -> None:
    # The samples inside the interval are 0.9 s apart.
    assert judged("0.95 s", trace(a=0.01, b=1.09)).outcome is Outcome.VIOLATED
    assert judged("0.001 s", trace(a=0.02, b=0.08)).outcome is Outcome.VIOLATED


def test_the_violation_is_when_the_time_was_up() -> None:
    found = judged("500 ms", trace(a=0.25, b=1.25))
    assert (found.at, found.worst_at) == (pytest.approx(0.75), pytest.approx(1.25))


def test_an_execution_that_ended_too_late_without_the_event_is_a_violation() -> None:
    found = judged("1 s", replace(trace(a=0.5), remark="gripper lost x"))
    assert (found.outcome, found.robustness) == (Outcome.VIOLATED, pytest.approx(-0.5))
    assert found.reason == "it took more than 1.50 s: event b never occurred: gripper lost x"


@pytest.mark.parametrize(
    ("limit", "found"),
    [
        ("1.5 s", trace(a=0.5)),  # exactly the limit so far
        ("9 s", trace(a=0.5)),
        ("1 s", replace(trace(a=0.5), finished=False)),
        ("1 s", replace(trace(a=0.5), log="bag")),
        ("1 s", trace(b=0.5)),
        ("1 s", trace()),
        ("9 s", trace(a=1.5, b=0.5)),
    ],
)
def test_missing_evidence_is_unknown(limit: str, found: Trace) -> None:
    verdict = judged(limit, found)
    assert (verdict.outcome, verdict.cause) == (Outcome.UNKNOWN, Cause.NO_EVENT)


def test_an_end_that_may_come_again_is_unknown() -> None:
    found = replace(trace(a=0.5, b=0.75), pending=("b",), executions={"a": 1, "b": 1})
    assert judged("1 s", found, During("a", "b", (0, LAST))).outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(
    "time", [After("a"), Before("b"), After("a", 9.0), Before("b", 0.5), During("a", "b", some_time=True)]
)
def test_only_an_interval_has_a_duration(time: TimeConstraint) -> None:
    assert judged("9 s", trace(a=0.5, b=1.0), time).cause is Cause.NO_STEP


def test_a_duration_neither_has_nor_is_a_condition() -> None:
    held, found = load_catalog().predicates["held-by"], trace(a=0.5, b=1.0)
    argument, other = {"limit": "9 s"}, {"object": "x", "agent": "x"}
    assert judge(TAKES, argument, SPAN, found, {}, (held, other)).cause is Cause.NO_STEP
    assert judge(held, other, SPAN, found, {}, (TAKES, argument)).cause is Cause.NO_STEP


def test_a_plot_shows_the_time_that_is_left() -> None:
    assert TAKES.evaluate is not None
    evidence = WindowEvidence(trace(a=0.5, b=1.0), Window(5, 7), {})
    assert list(TAKES.evaluate(evidence, {"limit": "150 ms"})) == pytest.approx([150, 50, -50])
