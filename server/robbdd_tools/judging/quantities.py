"""Find the fluents of a clause that need a quantity measured on demand, and the elements in them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import TYPE_CHECKING

from robbdd_tools.monitor.compound import CompoundEvaluator, leaves
from robbdd_tools.protocol.clauses import AnyOf, Clause, Filler, Fluent, fluents_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate


def fluents_with_quantity(clause: Clause, quantity: str) -> Iterator[tuple[Fluent, Mapping[str, str]]]:
    """Yield the fluents that need a quantity, once for each assignment of single elements to their slots.

    These are the slots of the predicate or of the condition.
    """
    for fluent in fluents_of(clause):
        for stated in (fluent, *(() if fluent.condition is None else fluent.condition.parts)):
            if quantity in stated.predicate.quantities:
                slots = tuple(stated.arguments)
                for chosen in product(*(_elements(stated.arguments[slot]) for slot in slots)):
                    own = dict(zip(slots, chosen, strict=True))
                    yield from ((fluent, one) for one in _of_predicates(stated.predicate, own, quantity))


def _of_predicates(predicate: Predicate, arguments: Mapping[str, str], quantity: str) -> Iterator[Mapping[str, str]]:
    """Yield the arguments of a predicate, or of the predicates in its definition, that need a quantity."""
    if not isinstance(predicate.evaluate, CompoundEvaluator):
        yield arguments
        return
    for one, own in leaves(predicate.evaluate.definition, arguments):
        if quantity in one.quantities:
            yield {slot: value for slot, value in own.items() if isinstance(value, str)}


def _elements(filler: Filler) -> tuple[str, ...]:
    listed = filler.elements if isinstance(filler, AnyOf) else filler
    return (listed,) if isinstance(listed, str) else listed
