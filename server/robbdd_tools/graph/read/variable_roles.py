"""Infer the kind of each variable from the clauses that use it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from robbdd_tools.catalog.api import Behaviour, Kind, Predicate
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import Iri
from robbdd_tools.graph.rdf.records import Records, items_of
from robbdd_tools.graph.rdf.vocabulary import EVENT_LIST, HORIZON_VARIABLE, expand

ELEMENT_OF_KIND = {
    Kind.OBJECT: "object",
    Kind.OBJECT_SET: "object",
    Kind.WORKSPACE: "workspace",
    Kind.WORKSPACE_SET: "workspace",
    Kind.AGENT: "agent",
    Kind.ANY: "element",
}
"""Kind of a slot → the kind of the element in its variable, or of each element in its set."""
HORIZON = "horizon"
"""Kind of a variable that is a number of seconds."""


@dataclass(slots=True)
class Roles:
    """The kinds of each variable and set, and the quantifiers in nesting order."""

    kinds: dict[str, dict[str, None]] = field(default_factory=dict[str, dict[str, None]])
    quantifiers: list[Iri] = field(default_factory=list[Iri])

    def add(self, variable: str, kinds: Iterable[str]) -> None:
        """Add kinds to the kinds of a variable."""
        self.kinds.setdefault(variable, {}).update(dict.fromkeys(kinds))


def assignment_class(kind: str) -> str:
    """Return the class (CURIE) of the derived assignments of values to variables of one kind."""
    return f"rbw:{kind.title().replace(' ', '')}Assignment"


def value_shape(dimension: str) -> str:
    """Return the name of the shape for values that are quantities of one dimension."""
    return f"{dimension.replace(' ', '-')}-value"


def clauses_below(records: Records, owners: Iterable[str]) -> Iterator[Iri]:
    """Yield all clauses of some owners once, including those inside groups and quantifiers. Outer clauses are first.

    Conditions count as clauses, and so do events that a template defines.
    """
    seen: set[str] = set()
    waiting = list(owners)
    while waiting:
        owner = waiting.pop(0)
        for event in records.iris(items_of(records, owner, EVENT_LIST)):
            yield event
            yield from records.iris(records.all(event, "rbw:occurs-when"))
        for term in ("bdd:has-clause", "rbw:operands"):
            heads = records.all(owner, term)
            for clause in records.iris((records.items(heads[0]) if heads else None) or ()):
                if clause not in seen:
                    seen.add(clause)
                    waiting.append(clause)
                    yield clause
                    yield from records.iris(records.all(clause, "rbw:whenever"))


def words_of(records: Records, clause: str) -> tuple[Predicate | Behaviour, ...]:
    """Return the catalog words that a clause uses."""
    types = records.types(clause)
    catalog = load_catalog()
    if expand("bdd:WhenBehaviour") in types:
        behaviours = records.iris(records.all(clause, "bhv:of-behaviour"))
        types = frozenset[str]().union(*(records.types(behaviour) for behaviour in behaviours))
        fitting = [word for word in catalog.behaviours.values() if types.issuperset(map(expand, word.rdf_types))]
        return tuple(sorted(fitting, key=lambda word: -len(word.rdf_types))[:1])
    return tuple(word for word in catalog.predicates.values() if expand(word.rdf_type) in types)


def _add_named(records: Records, use: Iri, roles: Roles, inside: tuple[Iri, ...] = ()) -> None:
    """Add kinds for the values of a named predicate: the kinds that its parameters have in the definition."""
    for predicate in records.iris(records.all(use, "rbw:named-predicate")):
        if predicate in inside:
            continue
        own = Roles()
        for state in states_below(records, records.iris(records.all(predicate, "rbw:defined-as"))):
            _add_named(records, state, own, (*inside, predicate))
            for word in words_of(records, state):
                for slot in word.slots:
                    if slot.kind in ELEMENT_OF_KIND or slot.dimension:
                        for parameter in records.iris(records.all(state, slot.property)):
                            own.add(parameter, [slot.dimension or ELEMENT_OF_KIND[slot.kind]])
        parameters = items_of(records, predicate, "rbw:parameters")
        for parameter, value in zip(parameters, items_of(records, use, "rbw:argument-list"), strict=False):
            for filler in records.iris([value]):
                roles.add(filler, own.kinds.get(str(parameter), {}))


def states_below(records: Records, states: Iterable[Iri]) -> Iterator[Iri]:
    """Yield each node in the definition of a predicate once, outer nodes first."""
    seen: dict[Iri, None] = {}
    waiting = list(states)
    while waiting:
        state = waiting.pop(0)
        if state not in seen:
            seen[state] = None
            waiting += records.iris(items_of(records, state, "rbw:operands"))
            yield state


def roles_in(records: Records, clauses: Iterable[Iri]) -> Roles:
    """Return the kinds of variables. The kinds of a quantified variable also apply to the elements of its set."""
    roles = Roles()
    for clause in clauses:
        _add_named(records, clause, roles)
        for word in words_of(records, clause):
            for slot in word.slots:
                if slot.kind in ELEMENT_OF_KIND or slot.dimension:
                    for variable in records.iris(records.all(clause, slot.property)):
                        roles.add(variable, [slot.dimension or ELEMENT_OF_KIND[slot.kind]])
        for variable in records.iris(records.all(clause, HORIZON_VARIABLE)):
            roles.add(variable, [HORIZON])
        if records.all(clause, "bdd:in-set"):
            roles.quantifiers.append(clause)
    for quantifier in reversed(roles.quantifiers):
        for variable in records.iris(records.all(quantifier, "bdd:ref-variable")):
            for set_ in records.iris(records.all(quantifier, "bdd:in-set")):
                roles.add(set_, roles.kinds.get(variable, {}))
    return roles
