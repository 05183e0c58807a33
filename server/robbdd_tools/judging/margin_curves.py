"""Record the margins of a scenario's clauses over time. They are stored as JSON with the trace of the scenario."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.writing import replace_file
from robbdd_tools.catalog.coordination import END, START, emitter
from robbdd_tools.judging.decisions import Instance, alternatives
from robbdd_tools.monitor.curve import Curve, curve
from robbdd_tools.monitor.judge import WindowEvidence, margins_of
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.unobserved import Unobserved
from robbdd_tools.protocol.clauses import BehaviourCall, Clause, Fluent, Junction, Text

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.trace import Trace


def curves(clause: Clause, trace: Trace, regions: Regions, negated: bool = False) -> Iterator[Curve]:
    """Yield the curve of each fluent.

    For a fluent over a set, this is the curve of the worst element or, if one element suffices, of the best element.
    """
    match clause:
        case Fluent():
            yield _curve(clause, trace, regions, negated)
        case Junction(operator, operands):
            for operand in operands:
                yield from curves(operand, trace, regions, negated != (operator == "not"))
        case Text():
            return


def behaviour_curves(
    call: BehaviourCall, trace: Trace, emitters: Mapping[str, str], node: str = "", iteration: int = 0
) -> tuple[Curve, ...]:
    """Return the duration of a behaviour as a curve without a margin. ``emitters`` maps events to their emitters.

    ``node`` is the node of the behaviour tree that executes the behaviour, if any. ``iteration`` is 0 for a behaviour
    that is executed once.
    """
    if call.part:
        begin, end = (trace.event_time(name, iteration) for name in (call.start, call.end))
        return () if begin is None else (Curve(begin, begin if end is None else max(begin, end)),)
    limits = call.behaviour.events[0], call.behaviour.events[-1]
    if node:
        limits = emitter(node, START), emitter(node, END)
    stamps = [stamp for stamp in trace.events if stamp.iteration == iteration or not iteration]
    times = [stamp.time for stamp in stamps if emitters.get(stamp.name) in limits]
    return (Curve(min(times), max(times)),) if times else ()


def write_curves(path: Path, scenario: tuple[str, int], by_line: Mapping[int, tuple[Curve, ...]], trace: Trace) -> None:
    """Write the curves of clauses by their feature lines, together with the events. Raises ``OSError``.

    ``scenario`` consists of the IRI of the scenario's variant and the number of the scenario.
    """
    document = {
        "scenario": scenario,
        "duration": trace.end,
        "remark": trace.remark,
        "events": [
            {"name": stamp.name, "time": stamp.time} for stamp in sorted(trace.events, key=lambda stamp: stamp.time)
        ],
        "clauses": {str(line): [asdict(one) for one in found] for line, found in by_line.items()},
    }
    path.parent.mkdir(exist_ok=True)
    replace_file(path, json.dumps(document, ensure_ascii=False) + "\n")


def fluent_margins(fluent: Fluent, evidence: WindowEvidence) -> FloatArray:
    """Return the margin of a fluent at each sample of a window, shape (n,). For sets, this is the deciding margin.

    If one sample suffices, this is the margin of one element at all samples. It is infinite at samples at which the
    fluent's condition does not hold. Raises the errors of evaluators, which may be users' code.
    """
    groups = ([_margins(fluent, evidence, one) for one in group] for group in alternatives(fluent))
    if fluent.time.some_time:
        # Elements may satisfy the fluent at different samples, so they are compared by their largest margins.
        return max((min(group, key=_largest) for group in groups), key=_largest)
    best: FloatArray = np.max([np.min(group, axis=0) for group in groups], axis=0)
    return best


def unit_of(fluent: Fluent, trace: Trace, regions: Regions) -> str:
    """Return the unit of a fluent's margins; empty if they have none."""
    if fluent.predicate.unit_for is not None:
        with suppress(KeyError, IndexError, StopIteration, Unobserved):
            first = next(next(alternatives(fluent)))
            return fluent.predicate.unit_for(WindowEvidence(trace, Window(0, 0), regions), first.arguments)
    return fluent.predicate.unit


def _largest(margins: FloatArray) -> float:
    return float(np.max(margins, where=np.isfinite(margins), initial=-np.inf))


def _margins(fluent: Fluent, evidence: WindowEvidence, instance: Instance) -> FloatArray:
    """Return the margins of one instance, shape (n,); infinite at samples at which its condition does not hold."""
    margins = margins_of(fluent.predicate, evidence, instance.arguments)
    if fluent.condition is None or instance.condition is None:
        return margins
    applies = margins_of(fluent.condition.predicate, evidence, instance.condition)
    return np.where(applies >= 0, margins, np.inf)


def _curve(fluent: Fluent, trace: Trace, regions: Regions, negated: bool) -> Curve:
    def margins(rows: Window) -> FloatArray | None:
        if fluent.predicate.evaluate is None:
            return None
        try:
            return fluent_margins(fluent, WindowEvidence(trace, rows, regions))
        except Exception:  # no record, an empty set, failing users' code: the verdict reports it
            return None

    return curve(Curve(unit=unit_of(fluent, trace, regions), negated=negated), fluent.time, trace, margins)
