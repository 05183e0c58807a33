"""Read clauses into plain data."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    BehaviourClause,
    Clause,
    Condition,
    DefinedEvent,
    EventClause,
    Exists,
    Fluent,
    ForAll,
    Iri,
    Junction,
    TextClause,
    TextFluent,
    Variant,
)
from robbdd_tools.graph.clause_parts import part_numbers, with_siblings
from robbdd_tools.graph.rdf.records import Incomplete, Records, items_of
from robbdd_tools.graph.rdf.vocabulary import (
    EVENT_LIST,
    HORIZON_VARIABLE,
    JUNCTIONS,
    NAMED_USE,
    OCCURRENCE,
    SOME_TIME,
    TOGETHER,
    expand,
)
from robbdd_tools.graph.read.named_predicates import elements_named, read_arguments, read_use, read_value
from robbdd_tools.monitor.time import OCCURRENCES, After, Before, During, TimeConstraint

if TYPE_CHECKING:
    from rdflib.term import Node

    from robbdd_tools.catalog.api import Slot

ROLES = {"bdd:Given": "given", "bdd:When": "when", "bdd:Then": "then"}


@dataclass(frozen=True, slots=True)
class ClauseReader:
    """Reads clauses. Raises ``Incomplete`` for a clause that lacks something or contains itself."""

    records: Records

    def clauses(self, owner: str, term: str = "bdd:has-clause", inside: tuple[str, ...] = ()) -> tuple[Clause, ...]:
        """Return the clauses in the list ``term`` of a node ``owner``, in order."""
        found = _checked(tuple(self.clause(node, (*inside, owner)) for node in self.records.list_of(owner, term)))
        return found if inside else with_siblings(found)

    def clause(self, node: Node, inside: tuple[str, ...] = ()) -> Clause:
        """Return one clause. ``inside`` are the nodes that contain the clause, outermost first."""
        iri = Iri(node)
        if iri in inside:
            raise Incomplete(f"{iri} contains itself")
        records = self.records
        if records.is_a(iri, "bdd:ForAll"):
            return ForAll(iri, *self._quantified(iri), self.clauses(iri, inside=inside))
        if records.is_a(iri, "bdd:WhenBehaviour"):
            return self._behaviour(iri)
        if records.is_a(iri, "rbw:WhenEvent"):
            return EventClause(iri, records.one(iri, "rbw:event"))
        role = self._role(iri)
        if records.is_a(iri, "bdd:ThereExists"):
            return Exists(iri, role, *self._quantified(iri), self.clauses(iri, inside=inside))
        if records.is_a(iri, "rbw:TextClause"):
            return TextClause(iri, role, records.text(iri, "rbw:text"), self.time(iri), self._seconds(iri))
        for operator, kind in JUNCTIONS.items():
            if records.is_a(iri, kind):
                return Junction(iri, role, operator, self.clauses(iri, "rbw:operands", inside))
        return self._fluent(iri, role)

    def _quantified(self, iri: Iri) -> tuple[Iri, Iri]:
        return self.records.one(iri, "bdd:ref-variable"), self.records.one(iri, "bdd:in-set")

    def _role(self, iri: Iri) -> str:
        owner = self.records.one(iri, "bdd:clause-of")
        for kind, role in ROLES.items():
            if self.records.is_a(owner, kind):
                return role
        raise Incomplete(f"{owner} is neither Given nor When nor Then")

    def _fluent(self, iri: Iri, role: str) -> Fluent | TextFluent:
        if self.records.is_a(iri, "bdd:StringTemplatePredicate"):
            return self._text_fluent(iri, role)
        if self.records.is_a(iri, NAMED_USE):
            named, arguments = read_use(self.records, iri)
            time, conditions = self.time(iri), self._conditions(iri, "rbw:whenever")
            return Fluent(iri, role, named.name, arguments, time, conditions, self._seconds(iri), named)
        for word in load_catalog().predicates.values():
            if self.records.is_a(iri, word.rdf_type):
                arguments = self._arguments(iri, word.slots)
                time, conditions = self.time(iri), self._conditions(iri, "rbw:whenever")
                return Fluent(iri, role, word.name, arguments, time, conditions, self._seconds(iri))
        raise Incomplete(f"{iri} has no predicate that this installation knows")

    def _text_fluent(self, iri: Iri, role: str) -> TextFluent:
        names = [str(name) for name in self.records.list_of(iri, "bdd:argument-names")]
        values = [read_value(self.records, node) for node in self.records.list_of(iri, "bdd:argument-variables")]
        if len(names) != len(values):
            raise Incomplete(f"{iri} has {len(names)} argument names for {len(values)} variables")
        template = self.records.text(iri, "bdd:template-string")
        arguments = dict(zip(names, values, strict=True))
        time, conditions = self.time(iri), self._conditions(iri, "rbw:whenever")
        return TextFluent(iri, role, template, arguments, time, conditions, self._seconds(iri))

    def events(self, template: str) -> tuple[DefinedEvent, ...]:
        """Return the events that a template defines, in written order. Raises ``Incomplete``."""
        return tuple(map(self._event, self.records.iris(items_of(self.records, template, EVENT_LIST))))

    def _event(self, iri: Iri) -> DefinedEvent:
        conditions = self._conditions(iri, "rbw:occurs-when")
        seconds = self.records.literal(iri, "time:horizon-seconds")
        variables = self.records.iris(self.records.all(iri, HORIZON_VARIABLE))
        if not conditions or len(variables) + (seconds is not None) > 1 or isinstance(seconds, str):
            raise Incomplete(f"{iri} does not state when it occurs")
        return DefinedEvent(iri, conditions, seconds or 0.0, *variables)

    def _conditions(self, owner: Iri, term: str) -> tuple[Condition, ...]:
        """Return the conditions of a clause or event, in the order of the numbers in their generated names."""
        nodes = self.records.iris(self.records.all(owner, term))
        return tuple(self.condition(node) for node in sorted(nodes, key=lambda node: (len(node), node)))

    def condition(self, iri: Iri) -> Condition:
        """Return a condition of a clause or event, or one in the definition of a predicate. Raises ``Incomplete``."""
        if self.records.is_a(iri, NAMED_USE):
            named, arguments = read_use(self.records, iri)
            return Condition(iri, named.name, arguments, named)
        for word in load_catalog().predicates.values():
            if self.records.is_a(iri, word.rdf_type):
                return Condition(iri, word.name, self._arguments(iri, word.slots))
        raise Incomplete(f"{iri} has no predicate that this installation knows")

    def _behaviour(self, iri: Iri) -> BehaviourClause:
        records = self.records
        behaviour = records.one(iri, "bhv:of-behaviour")
        types = records.types(behaviour)
        fitting = [word for word in load_catalog().behaviours.values() if types.issuperset(map(expand, word.rdf_types))]
        if not fitting:
            raise Incomplete(f"{behaviour} is not a behaviour that this installation knows")
        word = max(fitting, key=lambda candidate: len(candidate.rdf_types))
        time = self.time(iri)
        if not isinstance(time, During):
            raise Incomplete(f"{iri} has no start and end")
        nodes = records.iris(records.all(behaviour, "rbw:coordination-node"))
        node = nodes[0] if len(nodes) == 1 else None
        arguments, emits = self._arguments(iri, word.slots), tuple(self._emissions(iri))
        together = records.one(iri, TOGETHER) if records.all(iri, TOGETHER) else None
        return BehaviourClause(iri, word.name, arguments, Iri(time.start), Iri(time.end), node, emits, together)

    def _emissions(self, iri: Iri) -> Iterator[tuple[str, Iri]]:
        for emission in self.records.iris(items_of(self.records, iri, "rbw:emission-list")):
            yield self.records.text(emission, "rbw:moment"), self.records.one(emission, "rbw:event")

    def _arguments(self, iri: Iri, slots: Iterable[Slot]) -> Mapping[str, Iri | str]:
        return read_arguments(self.records, iri, slots)

    def time(self, iri: Iri) -> TimeConstraint:
        """Return the time constraint that a node describes."""
        before, after = (self.records.all(iri, f"time:{side}-event") for side in ("before", "after"))
        horizon = self.records.literal(iri, "time:horizon-seconds")
        seconds = float(horizon) if isinstance(horizon, int | float) else None
        some_time, which = self.records.is_a(iri, SOME_TIME), self.records.text(iri, OCCURRENCE)
        if which not in ("", *OCCURRENCES) or (which and before and after):
            raise Incomplete(f"{iri} selects occurrences '{which}' of an event")
        if before and after:
            start, end = self.records.one(iri, "time:after-event"), self.records.one(iri, "time:before-event")
            return During(start, end, some_time=some_time)
        if before:
            return Before(self.records.one(iri, "time:before-event"), seconds, some_time=some_time, which=which)
        return After(self.records.one(iri, "time:after-event"), seconds, some_time=some_time, which=which)

    def _seconds(self, iri: Iri) -> Iri | None:
        """Return the variable whose value is a clause's horizon, if any."""
        if not self.records.all(iri, HORIZON_VARIABLE):
            return None
        if self.records.all(iri, "time:horizon-seconds") or not isinstance(self.time(iri), Before | After):
            raise Incomplete(f"{iri} has a horizon that is not exactly one number or variable")
        return self.records.one(iri, HORIZON_VARIABLE)


def _checked(clauses: tuple[Clause, ...]) -> tuple[Clause, ...]:
    """Return the clauses. Raises ``Incomplete`` if a behaviour's ``together`` is not the last behaviour before it."""
    before: tuple[int, Iri] | None = None
    for clause, number in zip(clauses, part_numbers(clauses), strict=True):
        if isinstance(clause, BehaviourClause):
            if clause.together is not None and before != (number, clause.together):
                raise Incomplete(f"{clause.iri} is executed together with another behaviour than that before it")
            before = number, clause.iri
    return clauses


def names_in_events(events: Iterable[DefinedEvent]) -> Iterator[Iri]:
    """Yield the references in the definitions of events."""
    for event in events:
        yield from [] if event.variable is None else [event.variable]
        arguments = (one for condition in event.conditions for one in condition.arguments.values())
        yield from (argument for argument in arguments if isinstance(argument, Iri))
        yield from (element for condition in event.conditions for element in elements_named(condition.named))


def named_elements(model: AcceptanceModel, variant: Variant) -> tuple[Iri, ...]:
    """Return the elements that clauses and events name in a variant and its template, in order."""
    template = variant.template
    names = (*used_names((*template.clauses, *variant.clauses)), *names_in_events(template.events))
    return tuple(dict.fromkeys(name for name in names if name in model.kinds))


def used_names(clauses: Iterable[Clause]) -> Iterator[Iri]:
    """Yield the references in the arguments of clauses, but not the variables of quantifiers."""
    for clause in clauses:
        match clause:
            case Fluent() | TextFluent() | BehaviourClause():
                conditions = () if isinstance(clause, BehaviourClause) else clause.conditions
                values = (*clause.arguments.values(), *(one for each in conditions for one in each.arguments.values()))
                yield from (argument for argument in values if isinstance(argument, Iri))
                own = clause.named if isinstance(clause, Fluent) else None
                for named in (own, *(condition.named for condition in conditions)):
                    yield from elements_named(named)
            case Junction():
                yield from used_names(clause.operands)
            case ForAll() | Exists():
                yield clause.in_set
                yield from (name for name in used_names(clause.clauses) if name != clause.variable)
            case TextClause() | EventClause():
                pass
