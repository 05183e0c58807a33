"""Time constraints of fluents, and the window of a trace that each constraint selects (paper, section on fluents)."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from robbdd_tools.monitor.last_iteration import LAST

if TYPE_CHECKING:
    from robbdd_tools.monitor.trace import Trace

TOLERANCE = 1e-9
"""Tolerance (s) of times, because sample times are sums of floating-point steps."""


OCCURRENCES = ("first", "last", "every")
"""Words that select occurrences of an event."""


@dataclass(frozen=True, slots=True)
class Before:
    """At the last sample at or before ``event``, or throughout the ``horizon`` (s) that ends at it.

    ``iteration`` selects the occurrence of the event, as in ``Trace.event_time``. ``some_time`` is true if the
    predicate must hold at some sample of the window instead of at all of them.

    ``which`` is one of ``OCCURRENCES``, or empty. If it is set, it selects among all occurrences in the iterations
    ``scope``, as in ``Trace.event_times``, and ``iteration`` is ignored. ``number`` (from 1) is one occurrence of
    *every*.
    """

    event: str
    horizon: float | None = None
    iteration: int = 0
    some_time: bool = False
    which: str = ""
    scope: tuple[int, int] = (0, 0)
    number: int = 0


@dataclass(frozen=True, slots=True)
class After:
    """At the first sample at or after ``event``, or throughout the ``horizon`` (s) that starts at it.

    The other fields have the same meaning as in ``Before``.
    """

    event: str
    horizon: float | None = None
    iteration: int = 0
    some_time: bool = False
    which: str = ""
    scope: tuple[int, int] = (0, 0)
    number: int = 0


@dataclass(frozen=True, slots=True)
class During:
    """From event ``start`` until event ``end``, both included.

    ``iterations`` selects the occurrences of start and end, as in ``Trace.event_time``. ``some_time`` has the same
    meaning as in ``Before``.
    """

    start: str
    end: str
    iterations: tuple[int, int] = (0, 0)
    some_time: bool = False


TimeConstraint = Before | After | During


@dataclass(frozen=True, slots=True)
class Window:
    """Samples ``[first, last]`` of a trace, both included."""

    first: int
    last: int


@dataclass(frozen=True, slots=True)
class NoWindow:
    """A constraint has no window; ``reason`` says why.

    ``open`` is true if a longer trace may still have the window. ``empty`` is true if the window is closed but contains
    no sample. If the window extends beyond the trace, ``recorded`` are the samples of the window that the trace has. If
    an event has not occurred, ``missing`` is this event.
    """

    reason: str
    open: bool
    empty: bool = False
    recorded: Window | None = None
    missing: str = ""


def window(constraint: TimeConstraint, trace: Trace) -> Window | NoWindow:
    """Return the samples of a trace that a time constraint selects. ``docs/semantics.md`` defines them.

    Let ``t_e`` be the time of the selected occurrence of an event, and ``h`` the horizon.

    - ``before`` selects the last sample in ``[0, t_e]`` or, with a horizon, all samples in ``[t_e - h, t_e]``.
    - ``after`` selects the first sample in ``[t_e, ∞)`` or, with a horizon, all samples in ``[t_e, t_e + h]``.
    - ``from a until b`` selects all samples in ``[t_a, t_b]``.
    """
    match constraint:
        case Before() | After():
            times = occurrence_times(constraint, trace)
            if isinstance(times, NoWindow):
                return times
            # For *every* occurrence, return the window of the first one; ``judge`` judges them one by one.
            time = times[max(constraint.number - 1, 0)]
            return (
                _before(trace, constraint, time) if isinstance(constraint, Before) else _after(trace, constraint, time)
            )
        case During():
            found = interval(constraint, trace)
            if isinstance(found, NoWindow):
                return found
            begin, finish = found
            return _closed(trace.first_at_or_after(begin - TOLERANCE), trace.last_at_or_before(finish + TOLERANCE))


def occurrence_times(constraint: Before | After, trace: Trace) -> tuple[float, ...] | NoWindow:
    """Return the times (s) of the occurrences of the event to which a time constraint refers; at least one."""
    if not constraint.which:
        time = trace.event_time(constraint.event, constraint.iteration)
        missing = _missing(trace, constraint.event, constraint.iteration)
        doubtful = _doubtful(trace, constraint.event, (constraint.iteration, constraint.iteration), time)
        return _pending(constraint, trace) or doubtful or (missing if time is None else (time,))
    times = trace.event_times(constraint.event, constraint.scope)
    doubtful = _doubtful(
        trace, constraint.event, constraint.scope, times[0] if constraint.which == "first" and times else None
    )
    if doubtful is not None:
        return doubtful
    if constraint.which != "first" and (not trace.finished or constraint.event in trace.pending):
        return _uncertain(trace, constraint.event)
    if not times:
        return _missing(trace, constraint.event, 0)
    return {"first": times[:1], "last": times[-1:]}.get(constraint.which, times)


def interval(constraint: During, trace: Trace) -> tuple[float, float] | NoWindow:
    """Return the times (s) of the two events of an interval."""
    pending = _pending(constraint, trace)
    if pending is not None:
        return pending
    (start, first), (end, last) = occurrences(constraint)
    begin, finish = trace.event_time(start, first), trace.event_time(end, last)
    doubtful = _doubtful(trace, start, (first, first), begin) or _doubtful(trace, end, (last, last), finish)
    if doubtful is not None:
        return doubtful
    if begin is None:
        return _missing(trace, start, first)
    if finish is None:
        return _missing(trace, end, last)
    if finish < begin:
        return NoWindow(f"event {end} occurred before event {start}", False)
    return begin, finish


def occurrences(constraint: TimeConstraint) -> tuple[tuple[str, int], ...]:
    """Return the events that a time constraint names, each with its iteration."""
    match constraint:
        case Before(event, _, iteration) | After(event, _, iteration):
            return ((event, iteration),)
        case During(start, end, (first, last)):
            return (start, first), (end, last)


def closing_time(constraint: TimeConstraint, trace: Trace) -> float | None:
    """Return the time (s) at which the window of a time constraint closes; ``None`` if its event has not occurred."""
    if isinstance(constraint, During):
        event, iteration = occurrences(constraint)[-1]
        return trace.event_time(event, iteration)
    times = occurrence_times(constraint, trace)
    if isinstance(times, NoWindow):
        return None
    horizon = constraint.horizon if isinstance(constraint, After) else None
    return times[max(constraint.number - 1, 0)] + (horizon or 0.0)


def in_iterations(
    constraint: TimeConstraint,
    role: str,
    iterations: tuple[int, ...],
    emitting: Mapping[str, Collection[int]] = MappingProxyType({}),
) -> TimeConstraint:
    """Return a time constraint with the occurrences of events to which a clause refers.

    ``iterations`` are the first and the last iteration of the clause's scope; empty if the clause is not in a loop. An
    interval extends over the whole scope. Any other constraint refers to the first iteration in a Given or When clause
    (``role``) and to the last iteration in a Then clause, unless the constraint itself selects occurrences in the scope
    (see "Occurrences" in ``docs/semantics.md``). If an event is emitted only in some iterations, ``emitting`` maps it
    to these iterations. Then only these count for it, unless the scope contains none of them.
    """
    if not iterations:
        return constraint
    first, last = iterations[0], iterations[-1]

    def own(event: str) -> tuple[int, int]:
        found = [number for number in emitting.get(event, ()) if first <= number <= last]
        return (min(found), max(found)) if found else (first, last)

    if isinstance(constraint, During):
        return replace(constraint, iterations=(own(constraint.start)[0], own(constraint.end)[1]))
    if constraint.which:
        return replace(constraint, scope=(first, last))
    return replace(constraint, iteration=own(constraint.event)[1 if role == "then" else 0])


def _pending(constraint: TimeConstraint, trace: Trace) -> NoWindow | None:
    """Return the reason why a trace has no window yet: the event of a *last* occurrence may occur again."""
    for event, iteration in occurrences(constraint):
        if iteration == LAST and event in trace.pending:
            return _uncertain(trace, event)
    return None


def _uncertain(trace: Trace, event: str) -> NoWindow:
    reason = f"the execution ended at {trace.end:.2f} s, before it was certain that event {event} is the last one"
    return NoWindow(reason, not trace.finished)


def _doubtful(trace: Trace, event: str, scope: tuple[int, int], time: float | None) -> NoWindow | None:
    """Return the reason why the time of an event is unknown. ``time`` (s) is its first known occurrence."""
    doubt = trace.doubt(event, scope, time)
    return None if doubt is None else NoWindow(str(doubt), not trace.finished)


def _before(trace: Trace, constraint: Before, time: float) -> Window | NoWindow:
    event, horizon = constraint.event, constraint.horizon
    last = trace.last_at_or_before(time + TOLERANCE)
    if horizon is None:
        return Window(last, last) if last >= 0 else NoWindow(f"no sample was taken before event {event}", False, True)
    if time - horizon < -TOLERANCE:
        reason = f"event {event} occurred at {time:.2f} s, less than {horizon:g} s after the execution began"
        return NoWindow(reason, False, recorded=_between(0, last))
    return _closed(trace.first_at_or_after(time - horizon - TOLERANCE), last)


def _after(trace: Trace, constraint: After, time: float) -> Window | NoWindow:
    horizon = constraint.horizon
    first = trace.first_at_or_after(time - TOLERANCE)
    end = time + (horizon or 0.0)
    if first >= len(trace.times) or trace.times[-1] < end - TOLERANCE:
        reason = f"the execution ended at {trace.end:.2f} s, before {end:.2f} s when the window closes"
        return NoWindow(reason, not trace.finished, recorded=_between(first, len(trace.times) - 1))
    if horizon is None:
        return Window(first, first)
    return _closed(first, trace.last_at_or_before(end + TOLERANCE))


def _closed(first: int, last: int) -> Window | NoWindow:
    return _between(first, last) or NoWindow("no sample was taken in the window", False, True)


def _between(first: int, last: int) -> Window | None:
    return Window(first, last) if first <= last else None


def _missing(trace: Trace, event: str, iteration: int) -> NoWindow:
    return NoWindow(never_occurred(trace, event, iteration), not trace.finished, missing=event)


def never_occurred(trace: Trace, event: str, iteration: int = 0) -> str:
    """Return the reason why a clause is unknown because an event that it needs has not occurred."""
    executions = trace.executions.get(event, 0)
    where = f" in iteration {iteration}" if iteration > 0 else ""
    if iteration == LAST and executions > 1:
        where = f" in the last of {executions} executions"
    remark = trace.defined.get(event) or trace.remark
    why = f": {remark}" if remark else ""
    return f"event {event} never occurred{where}{why}"
