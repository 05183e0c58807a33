"""Windows of an unfinished trace: open from their first sample, closed from their last, and the same as at the end."""

from __future__ import annotations

from dataclasses import replace

import pytest

from monitor.traces import STEP, still, trace_of
from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint, Window, window
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.monitor.windows_so_far import WindowSoFar, windows_so_far

COUNT = 21
A, B, C = EventStamp("a", 0.5, 1), EventStamp("b", 1.0, 1), EventStamp("a", 1.5, 2)


def whole(*events: EventStamp) -> Trace:
    return replace(trace_of({"x": still(COUNT)}), events=events)


def so_far(constraint: TimeConstraint, rows: int, *events: EventStamp) -> tuple[WindowSoFar, ...]:
    """Return the windows in the first samples of an execution."""
    trace = whole(*(stamp for stamp in events if stamp.time < rows * STEP - STEP / 2))
    begun = replace(trace, times=trace.times[:rows], positions=trace.positions[:rows], finished=rows == COUNT)
    return windows_so_far(constraint, begun)


@pytest.mark.parametrize(
    ("constraint", "opens", "closes"),
    [
        (After("a"), 5, 5),
        (After("a", 0.7), 5, 12),
        (During("a", "b"), 5, 10),
        # What ends at an event is known when the event occurs.
        (Before("b"), 10, 10),
        (Before("b", 0.3), 10, 10),
        (After("a", 0.2, iteration=2), 15, 17),
        (After("a", 0.2, which="first"), 5, 7),
        # Whether an occurrence is the last one is known at the end.
        (After("a", 0.2, which="last"), 20, 20),
        (After("a", 0.2, some_time=True), 5, 7),
    ],
)
def test_a_window_opens_and_closes_at_its_samples(constraint: TimeConstraint, opens: int, closes: int) -> None:
    seen = [so_far(constraint, rows, A, B, C) for rows in range(1, COUNT + 1)]
    assert next(index for index, found in enumerate(seen) if found) == opens
    assert next(index for index, found in enumerate(seen) if any(one.closed for one in found)) == closes
    final = seen[-1]
    assert [one.rows for one in final] == [window(constraint, whole(A, B, C))]
    begun = [found[0].rows for found in seen if found]
    assert {rows.first for rows in begun} == {final[0].rows.first}
    assert [rows.last for rows in begun] == [min(index, begun[-1].last) for index in range(opens, COUNT)]


def test_every_occurrence_has_its_own_window() -> None:
    constraint = After("a", 0.3, which="every")
    assert so_far(constraint, 11, A, B, C) == (WindowSoFar(0, Window(5, 8), True),)
    assert so_far(constraint, 17, A, B, C) == (
        WindowSoFar(0, Window(5, 8), True),
        WindowSoFar(1, Window(15, 16), False),
    )


def test_an_interval_without_its_second_event_stays_open() -> None:
    assert so_far(During("a", "never"), COUNT, A) == (WindowSoFar(0, Window(5, COUNT - 1), False),)


@pytest.mark.parametrize("constraint", [After("never", 1.0), Before("never"), During("never", "a"), Before("a", 0.9)])
def test_without_its_event_or_its_whole_horizon_a_window_never_opens(constraint: TimeConstraint) -> None:
    assert so_far(constraint, COUNT, A) == ()


def test_an_interval_whose_first_event_may_occur_again_has_not_opened() -> None:
    constraint = During("a", "b", iterations=(LAST, LAST))
    assert windows_so_far(constraint, replace(whole(A), pending=("a",))) == ()
