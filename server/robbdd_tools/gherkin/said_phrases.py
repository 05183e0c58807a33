"""Find the catalog predicate whose phrase is the text of a ``pred("…")``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import dimension_of
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.phrases_in_text import accepts, predicates_in_text
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Iri, TextFluent
from robbdd_tools.protocol.clauses import AnyOf

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Predicate, Slot


def said_phrase(
    model: AcceptanceModel, clause: TextFluent, values: Mapping[Iri, Cell | AnyOf]
) -> tuple[Predicate, dict[str, Cell]] | None:
    """Return the predicate whose phrase is the text of a clause, and the values of its slots.

    If the phrases of several predicates have these words, the kinds of the values decide. The result is ``None`` if the
    text is not the phrase of a predicate, or if a value has another kind than its slot.
    """
    for predicate, placeholders in predicates_in_text(clause.template, clause.arguments):
        cells = _cells(model, predicate, {slot: clause.arguments[name] for slot, name in placeholders.items()}, values)
        if cells is not None:
            return predicate, cells
    return None


def _cells(
    model: AcceptanceModel, predicate: Predicate, terms: Mapping[str, Iri | str], values: Mapping[Iri, Cell | AnyOf]
) -> dict[str, Cell] | None:
    """Return the values of a predicate's slots; ``None`` if a value does not fit."""
    cells: dict[str, Cell] = {}
    for slot in predicate.slots:
        term = terms[slot.name]
        value = values.get(term, term) if isinstance(term, Iri) else term
        # The elements of an *any of* are words, so their kinds are not known.
        if isinstance(value, AnyOf) or not _fits(model, slot, value):
            return None
        cells[slot.name] = value
    return cells


def _fits(model: AcceptanceModel, slot: Slot, value: Cell) -> bool:
    match value:
        case Iri():
            elements = model.sets.get(value)
            return _fits(model, slot, elements) if elements else accepts(slot.kind, model.kinds.get(value, ""))
        case tuple():
            return bool(value) and all(_fits(model, slot, one) for one in value)
        case str():
            return slot.kind is Kind.QUANTITY and dimension_of(value) == slot.dimension
        case _:
            return False
