"""Find the clauses that prove little in an execution.

Their margin did not vary, or they held from the start.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.catalog.coordination import START, emitter
from robbdd_tools.judging.decisions import decide, ranges
from robbdd_tools.judging.scenario_clauses import behaviour_calls, iteration_of
from robbdd_tools.monitor.time import Before, During
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.clauses import Clause, Fluent, Junction, fluents_of
from robbdd_tools.protocol.messages import MarginRanges

if TYPE_CHECKING:
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

BEGIN = "the behaviour begins"
"""Name of the artificial event at the beginning of a behaviour."""


def margin_ranges(
    index: int, clause: Clause, stated: ClauseSpec, spec: ScenarioSpec, trace: Trace, regions: Regions
) -> MarginRanges | None:
    """Return the message with the margin ranges of a clause in scenario number ``index``.

    Returns ``None`` if the trace has no information on the clause.
    """
    if trace.unreached:
        return None
    found = ranges(clause, trace, regions)
    held = _held_before(clause, stated, spec, trace, regions)
    return MarginRanges(index, stated.line, found, held) if found or held is not None else None


def _held_before(clause: Clause, stated: ClauseSpec, spec: ScenarioSpec, trace: Trace, regions: Regions) -> bool | None:
    """Return whether a Then clause holds and its predicates already held before the behaviour.

    The second instant is the beginning of the first behaviour in the clause's scope. The result is ``None`` where the
    question is meaningless: for other clauses, for intervals, which require a state to persist, and for predicates that
    are set up or only measured in windows.
    """
    fluents = list(fluents_of(clause))
    if stated.role != "then" or not fluents:
        return None
    if any(_persists(one) or one.predicate.set_up or one.predicate.quantities for one in fluents):
        return None
    time = _beginning(stated, spec, trace)
    if time is None:
        return None
    before = replace(trace, events=(EventStamp(BEGIN, time),))
    outcome = decide(_at_beginning(clause), before, regions, {BEGIN}).outcome
    if outcome is Outcome.UNKNOWN:
        return None
    holds = decide(clause, trace, regions, spec.events.keys()).outcome is Outcome.HOLDS
    return holds and outcome is Outcome.HOLDS


def _persists(fluent: Fluent) -> bool:
    """Return whether a fluent requires more than a state at one instant."""
    return fluent.condition is not None or (isinstance(fluent.time, During) and not fluent.time.some_time)


def _beginning(stated: ClauseSpec, spec: ScenarioSpec, trace: Trace) -> float | None:
    """Return the time (s) at which the first behaviour in a clause's scope began."""
    if spec.node:
        emitting = emitter(spec.node, START)
    else:
        number = stated.iterations[0] if stated.iterations else 0
        calls = enumerate(behaviour_calls(spec), start=1)
        iterations = ((call, iteration_of(known) or (1 if call.part else index)) for index, (call, known) in calls)
        first = next((call for call, iteration in iterations if iteration == (number or 1)), None)
        if first is None:
            return None
        if first.part:
            return trace.event_time(first.start, number)
        emitting = first.behaviour.events[0]
    names = [event for event, emits in spec.events.items() if emits == emitting]
    return trace.event_time(names[0], stated.iterations[0] if stated.iterations else 0) if names else None


def _at_beginning(clause: Clause) -> Clause:
    match clause:
        case Fluent():
            return replace(clause, time=Before(BEGIN))
        case Junction():
            return replace(clause, operands=tuple(map(_at_beginning, clause.operands)))
        case _:
            return clause
