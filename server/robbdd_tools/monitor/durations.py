"""Judge predicates about the time between two events, such as *it takes less than 12 s*."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import si_factor
from robbdd_tools.monitor.time import During, NoWindow, TimeConstraint, interval
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, DurationMargin
    from robbdd_tools.monitor.trace import Trace

NOT_AN_INTERVAL = "a duration needs 'from <start> until <end>', without 'at some time' and 'whenever'"

NO_DURATION = "a policy cannot judge how long something takes: that follows from the times of the events"


def judge_duration(
    margin: DurationMargin, arguments: Arguments, constraint: TimeConstraint, trace: Trace, unit: str
) -> Verdict:
    """Judge a predicate on the exact time between the two events of an interval.

    If a simulated execution has finished without the second event, the duration is longer than the time since the first
    event. The clause is violated if this time is already too long, and unknown otherwise. A log does not show this,
    because it may lack an event that occurred.
    """
    if not isinstance(constraint, During) or constraint.some_time:
        return unknown(NOT_AN_INTERVAL, Cause.NO_STEP)
    found = interval(constraint, trace)
    if isinstance(found, NoWindow):
        begin = trace.event_time(constraint.start, constraint.iterations[0])
        overdue = begin is not None and found.missing == constraint.end and trace.finished and not trace.log
        verdict = _verdict(margin, arguments, begin or 0.0, trace.end, unit)
        if overdue and verdict.outcome is Outcome.VIOLATED:
            return replace(verdict, reason=f"it took more than {trace.end - (begin or 0.0):.2f} s: {found.reason}")
        return unknown(found.reason, Cause.NO_EVENT)
    return _verdict(margin, arguments, *found, unit)


def _verdict(margin: DurationMargin, arguments: Arguments, begin: float, end: float, unit: str) -> Verdict:
    """Return the verdict on an interval (s)."""
    seconds = end - begin
    robustness = margin(seconds, arguments)
    if robustness >= 0:
        return Verdict(Outcome.HOLDS, robustness, unit, end, f"it took {seconds:.2f} s", end)
    too_late = end + robustness * si_factor(unit)
    return Verdict(Outcome.VIOLATED, robustness, unit, too_late, f"it took {seconds:.2f} s", end)
