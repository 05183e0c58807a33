"""Map the events of a scenario to their emitters: the execution, its behaviours, or nodes of a behaviour tree."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.catalog.coordination import DEFINED, END, EXTERNAL, START, emitter, joined
from robbdd_tools.catalog.event_names import inner_event
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import (
    BehaviourClause,
    Clause,
    EventClause,
    Iri,
    Variant,
    every_clause,
)
from robbdd_tools.graph.clause_parts import named_events, whens_of

if TYPE_CHECKING:
    from robbdd_tools.run.related_scenarios import Linked


def emitters_of(variant: Variant, linked: Linked | None) -> dict[Iri, str]:
    """Map each event of the model to its emitter.

    The execution emits the events of the template's duration. A behaviour's duration is emitted by the behaviour's
    first and last event. For any other event, the emitter is the behaviour event that the model states (``emits``), or
    the behaviour event with the same name (``inner_event``). If the scenario is ``linked`` to a node of a behaviour
    tree, this node emits the duration, unless it is the root. If a template has several behaviours, the IRIs of their
    clauses distinguish their events. If an event ends one behaviour of a When and starts another one, the first
    behaviour emits it. If a name fits events of several behaviours of a When, it is used for none of them. In different
    parts of a template, behaviours may emit the same event. An awaited event without an emitter is external: only a log
    can report it. An event that the template defines by conditions is found in the trace.
    """
    template = variant.template
    bound = {template.start: "scenario-start", template.end: "scenario-end"}
    if linked is not None and not linked.is_root:
        bound = {template.start: emitter(linked.node, START), template.end: emitter(linked.node, END)}
    clauses = tuple(every_clause((*template.clauses, *variant.clauses)))
    behaviours = [clause for clause in clauses if isinstance(clause, BehaviourClause)]
    limits: dict[Iri, list[str]] = {}
    whens = list(whens_of((*template.clauses, *variant.clauses)))
    for when in whens:
        own: dict[Iri, str] = {}
        for clause in when:
            first, last = _limits(clause, linked)
            if not clause.has_siblings:
                own |= {clause.start: first, clause.end: last}
                continue
            for event, name in ((clause.start, first), (clause.end, last)):
                own.setdefault(event, name)
        for event, name in own.items():
            limits.setdefault(event, []).append(name)
    bound |= {event: joined(names) for event, names in limits.items()}
    _bind_inner(bound, clauses, whens, linked)
    if any(clause.has_siblings for clause in behaviours):
        for clause in clauses:
            if isinstance(clause, EventClause):
                bound.setdefault(clause.event, EXTERNAL)
    # If an event is both defined and emitted, only the definition counts (diagnostic ``defined-event``).
    return bound | {event.iri: DEFINED for event in template.events}


def _limits(clause: BehaviourClause, linked: Linked | None) -> tuple[str, str]:
    """Return the emitters of the start and the end of a behaviour's duration."""
    events = load_catalog().behaviours[clause.behaviour].events
    first, last = (events[0], events[-1]) if linked is None else (START, END)
    return _emitter(first, clause, linked), _emitter(last, clause, linked)


def _emitter(moment: str, clause: BehaviourClause, linked: Linked | None) -> str:
    """Return the emitter of a behaviour's own event."""
    if linked is not None:
        return emitter(linked.node, moment)
    return emitter(clause.iri, moment) if clause.has_siblings else moment


def _bind_inner(
    bound: dict[Iri, str],
    clauses: Iterable[Clause],
    whens: Iterable[tuple[BehaviourClause, ...]],
    linked: Linked | None,
) -> None:
    """Add the emitters of events that the model states by ``emits``, or that have the name of a behaviour's event."""
    stated: dict[Iri, list[str]] = {}
    emitted: dict[str, list[str]] = {}
    ambiguous: set[str] = set()
    for when in whens:
        own: dict[str, set[str]] = {}
        said: dict[Iri, str] = {}
        for clause in when:
            events = load_catalog().behaviours[clause.behaviour].events
            for moment in events:
                own.setdefault(moment, set()).add(_emitter(moment, clause, linked))
            said |= {event: _emitter(moment, clause, linked) for moment, event in clause.emits if moment in events}
        for event, name in said.items():
            stated.setdefault(event, []).append(name)
        for moment, names in own.items():
            emitted.setdefault(moment, []).extend(names)
            if len(names) > 1:
                ambiguous.add(moment)
    known = {moment: joined(names) for moment, names in emitted.items() if moment not in ambiguous}
    for clause in clauses:
        for event in named_events(clause):
            moment = inner_event(event, known)
            name = joined(stated[event]) if event in stated else None if moment is None else known[moment]
            if name is not None:
                bound.setdefault(event, name)
