"""The first, the last and every occurrence of an event. What may still come is unknown."""

from __future__ import annotations

from dataclasses import replace

import pytest

from monitor.random_traces import ABOVE
from monitor.traces import heights, trace_of
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import After, Before, NoWindow, TimeConstraint, in_iterations, window
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.monitor.verdict import Outcome, Verdict

STAMPS = (EventStamp("e", 0.1, 1), EventStamp("e", 0.3, 2), EventStamp("e", 0.5, 3))


def trace(*path: float, events: tuple[EventStamp, ...] = STAMPS) -> Trace:
    return replace(trace_of({"x": heights(list(path))}), events=events)


PATH = trace(9, 1, 9, -2, 9, 3, 9)


def judged(time: TimeConstraint, found: Trace = PATH) -> Verdict:
    return judge(ABOVE, {"thing": "x"}, time, found, {})


@pytest.mark.parametrize(
    ("time", "margin", "at"),
    [
        (After("e", which="first"), 1.0, 0.1),
        (After("e", which="last"), 3.0, 0.5),
        (After("e", which="every"), -2.0, 0.3),
        (Before("e", 0.1, which="every"), -2.0, 0.3),
        (After("e", 0.1, some_time=True, which="every"), 9.0, 0.2),
        (After("e", which="every", scope=(1, 1)), 1.0, 0.1),
        (After("e", which="every", scope=(3, 3)), 3.0, 0.5),
        (After("e", which="first", scope=(2, 3)), -2.0, 0.3),
        (After("e", which="last", scope=(1, 2)), -2.0, 0.3),
        (After("e", which="last", scope=(0, LAST)), 3.0, 0.5),
    ],
)
def test_the_selected_occurrences_are_judged(time: TimeConstraint, margin: float, at: float) -> None:
    found = judged(time)
    assert found.robustness == margin
    assert found.worst_at == pytest.approx(at)


@pytest.mark.parametrize("which", ["last", "every"])
@pytest.mark.parametrize("found", [replace(PATH, finished=False), replace(PATH, pending=("e",))])
def test_the_last_and_every_occurrence_are_unknown_while_another_one_may_come(which: str, found: Trace) -> None:
    time = After("e", which=which, scope=(1, 1))
    assert judged(time, found).outcome is Outcome.UNKNOWN
    selected = window(time, found)
    assert isinstance(selected, NoWindow)
    assert selected.open is not found.finished


def test_the_first_occurrence_is_known_at_once() -> None:
    assert judged(After("e", which="first"), replace(PATH, finished=False, pending=("e",))).robustness == 1.0


@pytest.mark.parametrize("which", ["first", "last", "every"])
def test_an_event_that_never_occurs_is_unknown_and_not_true(which: str) -> None:
    found = judged(After("f", which=which))
    assert (found.outcome, found.reason) == (Outcome.UNKNOWN, "event f never occurred")
    assert judged(After("e", which=which, scope=(4, 4))).outcome is Outcome.UNKNOWN


def test_one_occurrence_without_evidence_leaves_every_unknown_unless_another_one_is_violated() -> None:
    assert judged(After("e", 0.2, which="every"), trace(9, 9, 9, 9, 9, 9, 9)).outcome is Outcome.UNKNOWN
    assert judged(After("e", 0.2, which="every"), trace(9, -1, 9, 9, 9, 9, 9)).outcome is Outcome.VIOLATED


def test_in_a_loop_the_occurrences_of_its_iterations_count() -> None:
    time = in_iterations(After("e", which="every"), "then", (2, 3))
    assert time == After("e", which="every", scope=(2, 3))
    assert in_iterations(Before("e", which="first"), "given", ()) == Before("e", which="first")
