"""Time constraints of fluents and the window of a trace that each selects (paper, section on fluents)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.monitor.trace import Trace

TOLERANCE = 1e-9
"""Seconds; sample times are sums of floating-point steps."""


@dataclass(frozen=True, slots=True)
class Before:
    """At the last sample at or before ``event``, or throughout the ``horizon`` (s) that ends at it."""

    event: str
    horizon: float | None = None


@dataclass(frozen=True, slots=True)
class After:
    """At the first sample at or after ``event``, or throughout the ``horizon`` (s) that starts at it."""

    event: str
    horizon: float | None = None


@dataclass(frozen=True, slots=True)
class During:
    """From event ``start`` until event ``end``, both included."""

    start: str
    end: str


TimeConstraint = Before | After | During


@dataclass(frozen=True, slots=True)
class Window:
    """Samples ``[first, last]`` of a trace, both included."""

    first: int
    last: int


@dataclass(frozen=True, slots=True)
class NoWindow:
    """The window cannot be had: ``reason`` says why; ``open`` while a longer trace may still close it.

    ``empty`` tells that it is closed and holds no sample.
    """

    reason: str
    open: bool
    empty: bool = False


def window(constraint: TimeConstraint, trace: Trace) -> Window | NoWindow:
    """Select the samples that a constraint speaks of.

    docs/semantics.md is its definition.

    With ``t_e`` the time of an event's first occurrence and ``h`` the horizon: ``before``: the last sample in
    ``[0, t_e]``, or all in ``[t_e - h, t_e]``; ``after``: the first sample in ``[t_e, ∞)``, or all in
    ``[t_e, t_e + h]``; ``from a until b``: all in ``[t_a, t_b]``.
    """
    match constraint:
        case Before(event, horizon):
            return _before(trace, event, horizon)
        case After(event, horizon):
            return _after(trace, event, horizon)
        case During(start, end):
            return _during(trace, start, end)


def _before(trace: Trace, event: str, horizon: float | None) -> Window | NoWindow:
    time = trace.event_time(event)
    if time is None:
        return _missing(trace, event)
    last = trace.last_at_or_before(time + TOLERANCE)
    if horizon is None:
        return Window(last, last) if last >= 0 else NoWindow(f"no sample was taken before event {event}", False, True)
    if time - horizon < -TOLERANCE:
        return NoWindow(
            f"event {event} occurred at {time:.2f} s, less than {horizon:g} s after the execution began",
            False,
        )
    return _closed(trace.first_at_or_after(time - horizon - TOLERANCE), last)


def _after(trace: Trace, event: str, horizon: float | None) -> Window | NoWindow:
    time = trace.event_time(event)
    if time is None:
        return _missing(trace, event)
    first = trace.first_at_or_after(time - TOLERANCE)
    end = time + (horizon or 0.0)
    if first >= len(trace.times) or trace.times[-1] < end - TOLERANCE:
        reason = f"the execution ended at {trace.end:.2f} s, before {end:.2f} s when the window closes"
        return NoWindow(reason, not trace.finished)
    if horizon is None:
        return Window(first, first)
    return _closed(first, trace.last_at_or_before(end + TOLERANCE))


def _during(trace: Trace, start: str, end: str) -> Window | NoWindow:
    begin, finish = trace.event_time(start), trace.event_time(end)
    if begin is None:
        return _missing(trace, start)
    if finish is None:
        return _missing(trace, end)
    if finish < begin:
        return NoWindow(f"event {end} occurred before event {start}", False)
    return _closed(trace.first_at_or_after(begin - TOLERANCE), trace.last_at_or_before(finish + TOLERANCE))


def _closed(first: int, last: int) -> Window | NoWindow:
    return Window(first, last) if first <= last else NoWindow("no sample was taken in the window", False, True)


def _missing(trace: Trace, event: str) -> NoWindow:
    why = f": {trace.remark}" if trace.remark else ""
    return NoWindow(f"event {event} never occurred{why}", not trace.finished)
