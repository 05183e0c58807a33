"""Find the occurrences of events that a model defines by conditions: ``event near when <a> is nearer than …``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.quantity_units import si_factor
from robbdd_tools.judging.decisions import alternatives
from robbdd_tools.judging.margin_curves import fluent_margins, unit_of
from robbdd_tools.judging.uncertainty import bound_of
from robbdd_tools.monitor.judge import WindowEvidence
from robbdd_tools.monitor.rising_edges import rising_edges
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.trace import Doubt, EventStamp
from robbdd_tools.monitor.unobserved import Unobserved, Unplaced
from robbdd_tools.user_code.calls import fault_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.clauses import DefinedEvent, Fluent

FROM_START = "its condition held from the beginning, so it did not become true"


def with_defined_events(
    trace: Trace, defined: Sequence[DefinedEvent], regions: Regions, *, numbered: bool = True
) -> Trace:
    """Return a trace in which occurrences of defined events replace any other occurrences of these events.

    An occurrence belongs to the iteration of the latest event with an iteration; before the first iteration, it belongs
    to the first. If ``numbered`` is false, as in the execution of a behaviour tree, it belongs to all iterations.
    """
    if not defined:
        return trace
    names = {one.name for one in defined}
    stamps = [stamp for stamp in trace.events if stamp.name not in names]
    numbers = sorted((stamp.time, stamp.iteration) for stamp in stamps if stamp.iteration) if numbered else []
    new: list[EventStamp] = []
    doubts: list[Doubt] = []
    remarks: dict[str, str] = {}
    for one in defined:
        margins, problem = _margins(one, trace, regions)
        edges = rising_edges(margins, trace.times, one.seconds)
        new += (EventStamp(one.name, time, _iteration(numbers, time)) for time in edges.times)
        for since, until in edges.doubtful:
            iterations = _iteration(numbers, since), _iteration(numbers, until)
            doubts.append(Doubt(one.name, since, until, iterations, problem))
        remarks[one.name] = FROM_START if edges.held_from_start else ""
    events = tuple(sorted((*stamps, *new), key=lambda stamp: stamp.time))
    return replace(trace, events=events, doubts=tuple(doubts), defined=remarks)


def _iteration(numbers: Sequence[tuple[float, int]], time: float) -> int:
    """Return the iteration at a time (s). ``numbers`` are the times and iterations of events, sorted."""
    if not numbers:
        return 0
    return next((number for at, number in reversed(numbers) if at <= time), numbers[0][1])


def _margins(event: DefinedEvent, trace: Trace, regions: Regions) -> tuple[FloatArray, str]:
    """Return the margin of an event's conditions at each sample, shape (n,), and why some conditions are unknown.

    The margin is negative where a condition does not hold, else NaN where a condition is unknown.
    """
    problems: list[str] = []
    every = np.stack([_of_condition(one, trace, regions, problems) for one in event.conditions])
    unknown = np.isnan(every)
    least: FloatArray = np.where(unknown, np.inf, every).min(axis=0)
    return np.where((least >= 0) & unknown.any(axis=0), np.nan, least), next(iter(problems), "")


def _of_condition(fluent: Fluent, trace: Trace, regions: Regions, problems: list[str]) -> FloatArray:
    """Return the margin of one condition at each sample, shape (n,), NaN where it is unknown."""
    margins = np.full(len(trace.times), np.nan)
    if fluent.predicate.evaluate is None:
        problems.append(f"there is no evaluator for '{fluent.predicate.name}'")
        return margins
    _fill(margins, fluent, trace, regions, Window(0, len(margins) - 1), problems)
    if trace.uncertain:
        bound = _bound(fluent, trace, regions)
        if isinstance(bound, str):
            problems.append(bound)
            return np.full(len(margins), np.nan)
        margins[(margins >= -bound) & (margins < bound)] = np.nan
        problems.append("its margin was within the uncertainty of the measurements")
    return margins


def _fill(
    margins: FloatArray, fluent: Fluent, trace: Trace, regions: Regions, rows: Window, problems: list[str]
) -> None:
    """Write the margins in a window into ``margins``. A window with unobserved samples is divided around them."""
    try:
        margins[rows.first : rows.last + 1] = fluent_margins(fluent, WindowEvidence(trace, rows, regions))
    except Unplaced as unplaced:
        problems.append(str(unplaced))
    except Unobserved as gap:
        problems.append(str(gap))
        if rows.first < rows.last:
            middle = (rows.first + rows.last) // 2
            _fill(margins, fluent, trace, regions, Window(rows.first, middle), problems)
            _fill(margins, fluent, trace, regions, Window(middle + 1, rows.last), problems)
    except KeyError as missing:
        problems.append(f"the trace has no record of '{missing.args[0]}'")
    except Exception as error:  # an evaluator may be third-party code; its failure is missing evidence
        fault = fault_of(error, fluent.predicate.name, fluent.predicate.evaluate)
        problems.append(f"the evaluator of '{fluent.predicate.name}' failed: {fault.summary}")


def _bound(fluent: Fluent, trace: Trace, regions: Regions) -> float | str:
    """Return the largest error of a condition's margin in its own unit, or the reason why the error is unknown."""
    found = [
        bound_of(fluent.predicate, one.arguments, trace, regions) for group in alternatives(fluent) for one in group
    ]
    unknown = next((bound for bound in found if isinstance(bound, str)), None)
    if unknown is not None:
        return unknown
    return max((bound for bound in found if not isinstance(bound, str)), default=0.0) / si_factor(
        unit_of(fluent, trace, regions)
    )
