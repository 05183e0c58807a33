"""Report clauses of a graph that a run cannot judge, because of texts, events, configurations or sets."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING

from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.step_files import may_define
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.event_names import inner_event
from robbdd_tools.catalog.phrases_in_text import predicates_in_text
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.catalog.settings import SETTINGS, SettingError, setting_of
from robbdd_tools.checks.graph_site import members, values_of
from robbdd_tools.checks.no_emitter import CODE as NO_EMITTER
from robbdd_tools.checks.no_emitter import not_emitted
from robbdd_tools.checks.no_evaluator import CODE as NO_EVALUATOR
from robbdd_tools.checks.no_evaluator import needs_evaluator, sample_sentence
from robbdd_tools.checks.setting import CODE as SETTING
from robbdd_tools.checks.setting import may_have, not_configurable, unknown_setting
from robbdd_tools.checks.several_places import CODE as SEVERAL_PLACES
from robbdd_tools.checks.several_places import PLACED, at_each, have_nothing_in_common
from robbdd_tools.checks.single_element import CODE as SINGLE_ELEMENT
from robbdd_tools.checks.single_element import needs_one
from robbdd_tools.graph.acceptance_model import (
    BehaviourClause,
    Condition,
    Fluent,
    Iri,
    TextClause,
    TextFluent,
    behaviour_clauses,
    every_clause,
)
from robbdd_tools.graph.clause_parts import named_events
from robbdd_tools.protocol.time_words import time_words

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.checks.graph_site import GraphSite
    from robbdd_tools.graph.acceptance_model import Cell, Clause, Value, Variant


def clause_findings(site: GraphSite) -> Iterator[Diagnostic]:
    """Report the clauses of each variant that stay unknown in a run."""
    for variant in site.variants:
        clauses = tuple(every_clause((*variant.template.clauses, *variant.clauses)))
        yield from _unjudged(site, clauses)
        yield from _unemitted(site, variant, clauses)
        for clause in clauses:
            if isinstance(clause, BehaviourClause):
                yield from _sets(site, variant, clause)
            elif isinstance(clause, Fluent) and clause.predicate == "has-config":
                yield from _configuration(site, variant, clause)
            elif isinstance(clause, Fluent) and clause.predicate in PLACED and not _is_lenient(clause):
                yield from _places(site, variant, clause)


def _unjudged(site: GraphSite, clauses: tuple[Clause, ...]) -> Iterator[Diagnostic]:
    by_policy = {policy.clause for execution in site.model.executions for policy in execution.policies}
    path = uri_to_path(site.built.uri)
    for clause in clauses:
        if not isinstance(clause, TextFluent | TextClause) or clause.iri in by_policy:
            continue
        if isinstance(clause, TextFluent) and predicates_in_text(clause.template, clause.arguments):
            continue
        text = clause.template if isinstance(clause, TextFluent) else clause.text
        conditions = clause.conditions if isinstance(clause, TextFluent) else ()
        sentence = sample_sentence(text, time_words(clause.time), [_sentence_of(one) for one in conditions])
        if text.strip() and (path is None or not may_define(path, sentence)):
            message = needs_evaluator(may_have_policy=isinstance(clause, TextFluent))
            yield site.finding(clause.iri, NO_EVALUATOR, message)


def _sentence_of(condition: Condition) -> str:
    predicate = condition.named or load_catalog().predicates[condition.predicate]
    return predicate.sentence


def _unemitted(site: GraphSite, variant: Variant, clauses: tuple[Clause, ...]) -> Iterator[Diagnostic]:
    template = variant.template
    bound = dict.fromkeys((template.start, template.end, *(event.iri for event in template.events)))
    inner: dict[str, None] = {}
    for behaviour in behaviour_clauses(clauses):
        events = load_catalog().behaviours[behaviour.behaviour].events
        inner |= dict.fromkeys(events)
        bound |= dict.fromkeys((behaviour.start, behaviour.end))
        bound |= dict.fromkeys(event for moment, event in behaviour.emits if moment in events)
    for clause in clauses:
        for event in named_events(clause):
            if event not in bound and inner_event(event, inner) is None:
                message = not_emitted(site.name(event), map(site.name, bound), inner)
                yield site.finding(clause.iri, NO_EMITTER, message)


def _sets(site: GraphSite, variant: Variant, clause: BehaviourClause) -> Iterator[Diagnostic]:
    behaviour = load_catalog().behaviours[clause.behaviour]
    several = {variable for variable, cell in values_of(variant) if isinstance(cell, tuple)} | set(site.model.sets)
    for slot in behaviour.slots:
        term = clause.arguments.get(slot.name)
        if slot.kind is not Kind.WORKSPACE and term in several:
            message = needs_one(behaviour.name, slot.name, site.name(str(term)))
            yield site.finding(clause.iri, SINGLE_ELEMENT, message)


def _configuration(site: GraphSite, variant: Variant, clause: Fluent) -> Iterator[Diagnostic]:
    name = clause.arguments["name"]
    if name not in SETTINGS:
        yield site.finding(clause.iri, SETTING, unknown_setting(name)[0])
        return
    for cell in _given(variant, clause.arguments["value"]):
        try:
            setting_of(name).read(" ".join(str(value) for value in members(cell)))
        except SettingError as error:
            yield site.finding(clause.iri, SETTING, str(error))
    for element in (value for cell in _given(variant, clause.arguments["target"]) for value in _elements(site, cell)):
        kind = site.model.kinds.get(element, "")
        model = site.object_model(element) if kind == "object" else None
        if not may_have(kind, model, name):
            message = not_configurable(site.local_name(element), model, kind, name)
            yield site.finding(clause.iri, SETTING, message)


def _is_lenient(clause: Fluent) -> bool:
    return bool(clause.conditions) or clause.time.some_time


def _places(site: GraphSite, variant: Variant, clause: Fluent) -> Iterator[Diagnostic]:
    """Report a clause in which an object is at each of several places that have nothing in common."""
    scene, variable = variant.scene, clause.arguments["workspace"]
    carriers = {str(place): set(map(str, things)) for place, things in scene.carriers.items()}
    inner = {str(place): set(map(str, parts)) for place, parts in scene.contains.items()}
    for cell in _given(variant, variable):
        places = dict.fromkeys(map(str, cell)) if isinstance(cell, tuple) else ()
        for one, other in combinations(places, 2):
            if have_nothing_in_common(one, other, carriers, inner):
                thing, several = site.name(clause.arguments["object"]), site.name(variable)
                message = at_each(clause.predicate, thing, several, site.name(one), site.name(other))
                yield site.finding(clause.iri, SEVERAL_PLACES, message)
                return


def _given(variant: Variant, term: Iri | str) -> tuple[Cell, ...]:
    """Return the values of a variable, or the term itself if it is not a variable of the variation."""
    values = tuple(dict.fromkeys(cell for variable, cell in values_of(variant) if variable == term))
    return values or (term,)


def _elements(site: GraphSite, cell: Cell) -> Iterator[Iri]:
    values: tuple[Value, ...] = site.model.sets.get(cell, (cell,)) if isinstance(cell, Iri) else members(cell)
    return (value for value in values if isinstance(value, Iri))
