"""The windows of a time constraint that have opened in an unfinished trace."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import (
    TOLERANCE,
    After,
    Before,
    During,
    TimeConstraint,
    Window,
    occurrence_times,
    occurrences,
    window,
)

if TYPE_CHECKING:
    from robbdd_tools.monitor.trace import Trace


@dataclass(frozen=True, slots=True)
class WindowSoFar:
    """The samples of a window that the trace has. A longer trace can add samples unless the window is ``closed``.

    ``number`` (from 0) counts the windows of a constraint: *every* occurrence of an event has its own.
    """

    number: int
    rows: Window
    closed: bool


def windows_so_far(constraint: TimeConstraint, trace: Trace) -> tuple[WindowSoFar, ...]:
    """Return the windows of a time constraint that have opened.

    A window that ends at an event, such as the window of ``before``, is known only when the event has occurred, and
    then opens and closes at once. A window of the *last* occurrence is known only when the event cannot occur again.
    """
    if isinstance(constraint, During):
        return _numbered([_interval(constraint, trace)])
    if constraint.which == "every":
        count = len(trace.event_times(constraint.event, constraint.scope))
        each = (replace(constraint, which="first", number=0) for _ in range(count))
        return _numbered([_occurrence(one, _only(trace, constraint, index)) for index, one in enumerate(each)])
    return _numbered([_occurrence(constraint, trace)])


def _numbered(found: list[tuple[Window, bool] | None]) -> tuple[WindowSoFar, ...]:
    return tuple(WindowSoFar(number, *one) for number, one in enumerate(found) if one is not None)


def _only(trace: Trace, constraint: Before | After, index: int) -> Trace:
    """Return a trace in which only one occurrence of an event remains; ``index`` is its number in order of time."""
    time = trace.event_times(constraint.event, constraint.scope)[index]
    kept = (stamp for stamp in trace.events if stamp.name != constraint.event or stamp.time == time)
    return replace(trace, events=tuple(kept))


def _interval(constraint: During, trace: Trace) -> tuple[Window, bool] | None:
    (start, first), (end, last) = occurrences(constraint)
    if LAST in (first, last) and {start, end} & set(trace.pending):
        return None
    begin, finish = trace.event_time(start, first), trace.event_time(end, last)
    if begin is None:
        return None
    if finish is None:
        return _open_from(trace, begin)
    return _closed(constraint, trace)


def _occurrence(constraint: Before | After, trace: Trace) -> tuple[Window, bool] | None:
    found = _closed(constraint, trace)
    if found is not None:
        return found
    times = occurrence_times(constraint, trace)
    # A window of a Before closes at its event.
    if not isinstance(constraint, After) or constraint.horizon is None or not isinstance(times, tuple):
        return None
    return _open_from(trace, times[0])


def _closed(constraint: TimeConstraint, trace: Trace) -> tuple[Window, bool] | None:
    found = window(constraint, trace)
    return (found, True) if isinstance(found, Window) else None


def _open_from(trace: Trace, time: float) -> tuple[Window, bool] | None:
    first, last = trace.first_at_or_after(time - TOLERANCE), len(trace.times) - 1
    return (Window(first, last), False) if first <= last else None
