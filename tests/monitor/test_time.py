"""Windows of time constraints: which samples each one selects, and why there may be none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from monitor.traces import STEP, still, trace_of
from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import (
    After,
    Before,
    During,
    NoWindow,
    TimeConstraint,
    Window,
    closing_time,
    in_iterations,
    occurrences,
    window,
)
from robbdd_tools.monitor.trace import EventStamp

COUNT = 21
"""Samples, from 0 s to 2 s."""


def a_window(constraint: TimeConstraint, **events: float) -> Window | NoWindow:
    return window(constraint, trace_of({"a": still(COUNT)}, events))


@pytest.mark.parametrize(
    ("constraint", "expected"),
    [
        (Before("e"), Window(10, 10)),
        (After("e"), Window(10, 10)),
        (Before("late"), Window(15, 15)),
        (After("late"), Window(16, 16)),
        (Before("e", 0.3), Window(7, 10)),
        (After("e", 0.3), Window(10, 13)),
        (Before("late", 0.2), Window(14, 15)),
        (After("late", 0.2), Window(16, 17)),
        (During("e", "late"), Window(10, 15)),
        (During("e", "e"), Window(10, 10)),
    ],
)
def test_selects_the_samples_of_the_definition(constraint: TimeConstraint, expected: Window) -> None:
    assert a_window(constraint, e=1.0, late=1.55) == expected


@pytest.mark.parametrize(
    ("constraint", "reason"),
    [
        (Before("never"), "event never never occurred"),
        (After("never"), "event never never occurred"),
        (During("e", "never"), "event never never occurred"),
        (During("never", "e"), "event never never occurred"),
        (During("late", "e"), "event e occurred before event late"),
        (Before("e", 1.5), "event e occurred at 1.00 s, less than 1.5 s after the execution began"),
        (After("e", 1.5), "the execution ended at 2.00 s, before 2.50 s when the window closes"),
        (During("late", "late"), "no sample was taken in the window"),
    ],
)
def test_says_why_there_is_no_window(constraint: TimeConstraint, reason: str) -> None:
    found = a_window(constraint, e=1.0, late=1.55)
    assert isinstance(found, NoWindow)
    assert (found.reason, found.open, found.empty) == (reason, False, reason.startswith("no sample"))


@pytest.mark.parametrize("constraint", [Before("never"), After("never"), During("e", "never"), After("e", 1.5)])
def test_a_window_may_still_close_while_the_execution_goes_on(constraint: TimeConstraint) -> None:
    found = window(constraint, trace_of({"a": still(COUNT)}, {"e": 1.0}, finished=False))
    assert isinstance(found, NoWindow)
    assert found.open


def test_the_remark_of_the_execution_explains_a_missing_event() -> None:
    found = window(After("placed"), trace_of({"a": still(3)}, remark="gripper lost cube at 0.10 s"))
    assert isinstance(found, NoWindow)
    assert found.reason == "event placed never occurred: gripper lost cube at 0.10 s"


def test_an_event_after_the_last_sample_has_no_sample_after_it() -> None:
    found = a_window(After("e"), e=2.05)
    assert isinstance(found, NoWindow)


def test_a_trace_without_samples_has_no_window() -> None:
    empty = trace_of({}, {"e": 0.0})
    assert window(Before("e"), empty) == NoWindow("no sample was taken before event e", open=False, empty=True)
    assert window(After("e"), empty) == NoWindow(
        "the execution ended at 0.00 s, before 0.00 s when the window closes", open=False
    )
    assert window(During("e", "e"), empty) == NoWindow("no sample was taken in the window", open=False, empty=True)


def test_the_first_occurrence_counts() -> None:
    trace = trace_of({"a": still(COUNT)}, {"e": 0.5})
    twice = type(trace)(trace.names, trace.times, trace.positions, trace.orientations, {}, trace.events * 2)
    assert window(Before("e"), twice) == Window(5, 5)


@given(
    event=st.floats(0.0, 2.0),
    horizon=st.one_of(st.none(), st.floats(0.0, 2.0)),
    forward=st.booleans(),
)
def test_a_window_holds_exactly_the_samples_within_its_bounds(
    event: float, horizon: float | None, forward: bool
) -> None:
    trace = trace_of({"a": still(COUNT)}, {"e": event})
    found = window(After("e", horizon) if forward else Before("e", horizon), trace)
    if isinstance(found, NoWindow):
        assert horizon is not None
        return
    low, high = (event, event + (horizon or 0.0)) if forward else (event - (horizon or 0.0), event)
    times = trace.times
    if horizon is None:
        assert found.first == found.last
        nearest = np.flatnonzero(times >= event - 1e-9)[0] if forward else np.flatnonzero(times <= event + 1e-9)[-1]
        assert found.first == nearest
        return
    inside = np.flatnonzero((times >= low - 1e-9) & (times <= high + 1e-9))
    assert (found.first, found.last) == (inside[0], inside[-1])


@given(start=st.floats(0.0, 2.0), length=st.floats(0.0, 2.0))
def test_an_interval_grows_with_its_end(start: float, length: float) -> None:
    end = min(start + length, 2.0)
    shorter = a_window(During("a", "b"), a=start, b=end)
    longer = a_window(During("a", "b"), a=start, b=2.0)
    if isinstance(shorter, Window):
        assert isinstance(longer, Window)
        assert longer.first == shorter.first
        assert longer.last >= shorter.last
    elif isinstance(longer, Window):
        assert end - start < STEP + 1e-9


def test_an_occurrence_is_that_of_its_iteration_or_of_none() -> None:
    events = (EventStamp("e", 0.2, 1), EventStamp("e", 0.4, 2), EventStamp("e", 0.5, 2), EventStamp("end", 0.6))
    trace = replace(trace_of({"x": still(11)}), events=events)
    assert [trace.event_time("e", iteration) for iteration in (0, 1, 2, 3)] == [0.2, 0.2, 0.4, None]
    assert trace.event_time("end", 2) == 0.6
    assert window(During("e", "e", (1, 2)), trace) == Window(2, 4)
    found = window(After("e", None, 3), trace)
    assert isinstance(found, NoWindow)
    assert found.reason == "event e never occurred in iteration 3"


@pytest.mark.parametrize(
    ("constraint", "role", "expected"),
    [
        (Before("e", 0.5), "given", Before("e", 0.5, 1)),
        (Before("e"), "then", Before("e", None, 3)),
        (After("e", 0.5), "then", After("e", 0.5, 3)),
        (During("a", "b"), "given", During("a", "b", (1, 3))),
        (During("a", "b"), "then", During("a", "b", (1, 3))),
    ],
)
def test_a_clause_outside_a_loop_refers_to_its_first_or_last_iteration(
    constraint: TimeConstraint, role: str, expected: TimeConstraint
) -> None:
    assert in_iterations(constraint, role, (1, 3)) == expected
    assert in_iterations(constraint, role, ()) == constraint


def test_a_horizon_may_reach_from_the_first_sample_to_the_last() -> None:
    assert a_window(Before("e", 1.0), e=1.0) == Window(0, 10)
    assert a_window(After("e", 1.0), e=1.0) == Window(10, 20)
    assert a_window(After("e"), e=2.0) == Window(20, 20)


def test_a_time_constraint_names_its_events_with_their_iterations() -> None:
    assert occurrences(Before("e", 0.5, 2)) == (("e", 2),)
    assert occurrences(After("e", None, 1)) == (("e", 1),)
    assert occurrences(During("a", "b", (1, 3))) == (("a", 1), ("b", 3))


def test_an_end_that_is_missing_is_that_of_its_iteration() -> None:
    events = (EventStamp("a", 0.2, 1), EventStamp("b", 0.4, 1))
    trace = replace(trace_of({"x": still(11)}), events=events)
    for constraint, reason in (
        (During("a", "b", (1, 2)), "event b never occurred in iteration 2"),
        (During("a", "b", (3, 1)), "event a never occurred in iteration 3"),
        (Before("a", None, 4), "event a never occurred in iteration 4"),
    ):
        assert window(constraint, trace) == NoWindow(reason, open=False, missing=reason.split()[1])


def test_times_that_differ_by_rounding_only_are_the_same() -> None:
    early, late = 1.0 - 1e-12, 1.0 + 1e-12
    for time in (early, late):
        assert a_window(Before("e"), e=time) == a_window(After("e"), e=time) == Window(10, 10)
        assert a_window(During("e", "e"), e=time) == Window(10, 10)
        assert a_window(Before("e", 0.5), e=time) == Window(5, 10)
        assert a_window(After("e", 0.5), e=time) == Window(10, 15)
    assert a_window(Before("e", late), e=1.0) == Window(0, 10)
    assert a_window(After("e", late), e=1.0) == Window(10, 20)
    assert a_window(During("a", "b"), a=late, b=early) == NoWindow("event b occurred before event a", open=False)


def test_the_last_occurrence_is_that_of_the_last_execution() -> None:
    events = tuple(EventStamp("e", number / 5, number) for number in (1, 2))
    trace = replace(trace_of({"x": still(11)}), events=events, executions={"e": 2})
    assert window(After("e", None, LAST), trace) == Window(4, 4)
    assert window(During("e", "e", (0, LAST)), trace) == Window(2, 4)
    found = window(After("e", None, LAST), replace(trace, executions={"e": 3}))
    assert isinstance(found, NoWindow)
    assert found.reason == "event e never occurred in the last of 3 executions"


@pytest.mark.parametrize("finished", [True, False])
def test_nobody_knows_the_last_occurrence_while_there_may_be_another(finished: bool) -> None:
    trace = replace(trace_of({"x": still(11)}), events=(EventStamp("e", 0.2, 1),), executions={"e": 1})
    found = window(After("e", None, LAST), replace(trace, pending=("e",), finished=finished))
    assert isinstance(found, NoWindow)
    assert found.open is not finished
    assert "before it was certain that event e is the last one" in found.reason
    assert window(After("e"), replace(trace, pending=("e",))) == Window(2, 2)


def test_a_window_closes_in_its_own_iteration() -> None:
    stamps = (EventStamp("e", 0.3, 1), EventStamp("e", 0.9, 2))
    trace = replace(trace_of({"a": still(COUNT)}), events=stamps)
    assert closing_time(Before("e", None, 1), trace) == 0.3
    assert closing_time(After("e", 0.5, 2), trace) == 1.4
    assert closing_time(After("e", 0.5, 3), trace) is None
