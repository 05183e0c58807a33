"""Find the fluents of a clause that need a quantity that is measured on demand, and the elements in them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product

from robbdd_tools.protocol.clauses import AnyOf, Clause, Filler, Fluent, fluents_of


def fluents_with_quantity(clause: Clause, quantity: str) -> Iterator[tuple[Fluent, Mapping[str, str]]]:
    """Yield the fluents that need a quantity, once for each assignment of single elements to their slots.

    These are the slots of the predicate or of the condition.
    """
    for fluent in fluents_of(clause):
        for stated in (fluent, *(() if fluent.condition is None else fluent.condition.parts)):
            if quantity in stated.predicate.quantities:
                slots = tuple(stated.arguments)
                for chosen in product(*(_elements(stated.arguments[slot]) for slot in slots)):
                    yield fluent, dict(zip(slots, chosen, strict=True))


def _elements(filler: Filler) -> tuple[str, ...]:
    listed = filler.elements if isinstance(filler, AnyOf) else filler
    return (listed,) if isinstance(listed, str) else listed
