"""Judge a predicate under a time constraint on a trace: robustness is the smallest margin in the window."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.beside_gaps import decided_beside_gaps
from robbdd_tools.monitor.compound import CompoundEvaluator
from robbdd_tools.monitor.compound_samples import judge_samples
from robbdd_tools.monitor.durations import NOT_AN_INTERVAL, judge_duration
from robbdd_tools.monitor.sample_verdicts import at_some_time, throughout, whenever
from robbdd_tools.monitor.time import (
    During,
    NoWindow,
    TimeConstraint,
    Window,
    closing_time,
    occurrence_times,
    window,
)
from robbdd_tools.monitor.unobserved import Unobserved
from robbdd_tools.monitor.vacuity import Range
from robbdd_tools.monitor.verdict import EMPTY_WINDOW, Cause, Verdict, conjunction, unknown
from robbdd_tools.monitor.window_evidence import Regions as Regions
from robbdd_tools.monitor.window_evidence import WindowEvidence as WindowEvidence

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, FloatArray, Predicate
    from robbdd_tools.monitor.trace import Trace

PART = 65536
"""This many samples are evaluated at once."""
NOT_THROUGHOUT = "'whenever' needs a time constraint that says throughout, not 'at some time'"


def judge(
    predicate: Predicate,
    arguments: Arguments,
    constraint: TimeConstraint,
    trace: Trace,
    regions: Regions,
    condition: tuple[Predicate, Arguments] | None = None,
) -> Verdict:
    """Judge ``holds(predicate(arguments), constraint)``, ``whenever`` a condition holds if there is one.

    ρ is the smallest margin in the window, or the largest if the predicate must hold only at some time. The verdict is
    *holds* when ρ ≥ 0, *violated* when ρ < 0, *unknown* without a window, an evaluator or a record of an argument.
    """
    if not isinstance(constraint, During) and constraint.which == "every" and not constraint.number:
        times = occurrence_times(constraint, trace)
        if isinstance(times, NoWindow):
            return unknown(times.reason, Cause.NO_EVENT)
        each = (replace(constraint, number=number) for number in range(1, len(times) + 1))
        return conjunction(judge(predicate, arguments, one, trace, regions, condition) for one in each)
    for judged in (predicate, *(() if condition is None else condition[:1])):
        if judged.evaluate is None:
            return unknown(f"there is no evaluator for '{judged.name}'", Cause.NO_STEP)
    if predicate.duration is not None:
        if condition is not None:
            return unknown(NOT_AN_INTERVAL, Cause.NO_STEP)
        unit = unit_of(predicate, WindowEvidence(trace, Window(0, 0), regions), arguments)
        return judge_duration(predicate.duration, arguments, constraint, trace, unit)
    if condition is not None and condition[0].duration is not None:
        return unknown(NOT_AN_INTERVAL, Cause.NO_STEP)
    if condition is not None and constraint.some_time:
        return unknown(NOT_THROUGHOUT, Cause.NO_STEP)
    selected = window(constraint, trace)
    missing = selected if isinstance(selected, NoWindow) else None
    rows = selected.recorded if isinstance(selected, NoWindow) else selected
    if missing is not None and (rows is None or not constraint.some_time):
        if missing.empty:
            return unknown(missing.reason, Cause.EMPTY, EMPTY_WINDOW)
        return unknown(missing.reason, Cause.NO_EVENT)
    assert rows is not None
    evidence = WindowEvidence(trace, rows, regions)
    closing = closing_time(constraint, trace) if constraint.some_time else None
    compound = predicate.evaluate if isinstance(predicate.evaluate, CompoundEvaluator) else None
    try:
        samples = None if compound is None else compound.samples(evidence, arguments)
        margins = margins_of(predicate, evidence, arguments) if samples is None else samples.margins
        applies = None if condition is None else margins_of(condition[0], evidence, condition[1])
        unit = unit_of(predicate, evidence, arguments)
    except KeyError as missing:
        return unknown(f"the trace has no record of '{missing.args[0]}'", Cause.NO_RECORD)
    except Unobserved as gap:
        if compound is not None or condition is not None:
            return unknown(str(gap), Cause.UNOBSERVED)
        some_time = constraint.some_time
        decided = decided_beside_gaps(predicate, arguments, evidence, str(gap), closing, some_time=some_time)
        return decided or unknown(str(gap), Cause.UNOBSERVED)
    if samples is not None:
        return judge_samples(samples, evidence.times, applies, closing, missing, some_time=constraint.some_time)
    if applies is not None:
        return whenever(margins, applies, evidence.times, unit)
    if constraint.some_time:
        return at_some_time(margins, evidence.times, unit, closing, missing)
    return throughout(margins, evidence.times, unit)


def unit_of(predicate: Predicate, evidence: WindowEvidence, arguments: Arguments) -> str:
    """Return the unit of a predicate's margin."""
    return predicate.unit if predicate.unit_for is None else predicate.unit_for(evidence, arguments)


def margins_of(predicate: Predicate, evidence: WindowEvidence, arguments: Arguments) -> FloatArray:
    """Return the margins of a predicate with an evaluator, shape (n,). Raises ``KeyError`` for a missing record.

    A long window is evaluated in parts where the predicate allows it: an hour of a log has a million samples.
    """
    assert predicate.evaluate is not None
    first, after = evidence.window.first, evidence.window.last + 1
    if predicate.pointwise and after - first > PART:
        parts = (Window(begin, min(begin + PART, after) - 1) for begin in range(first, after, PART))
        # Without an observation, the reason must be that of the whole window.
        with suppress(Unobserved):
            return np.concatenate([predicate.evaluate(replace(evidence, window=one), arguments) for one in parts])
    return predicate.evaluate(evidence, arguments)


def margin_range(predicate: Predicate, arguments: Arguments, trace: Trace, regions: Regions) -> Range | None:
    """Return the range of a predicate's margin over all samples of a trace.

    Returns ``None`` if the trace cannot show that the margin could vary: without an evaluator or a record, with fewer
    than two samples, for quantities that are measured only within windows, and for conditions that are set up instead
    of observed.
    """
    if predicate.evaluate is None or predicate.quantities or predicate.set_up or len(trace.times) < 2:
        return None
    try:
        margins = margins_of(predicate, WindowEvidence(trace, Window(0, len(trace.times) - 1), regions), arguments)
    except (KeyError, Unobserved):
        return None
    finite = margins[np.isfinite(margins)]
    return (float(finite.min()), float(finite.max())) if finite.size > 1 else None
