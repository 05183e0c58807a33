"""Choose the predicate of a sentence by the kinds of its elements, if several predicates have its words."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import dimension_of
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.phrases_in_text import accepts, predicates_in_sentence
from robbdd_tools.protocol.clauses import BehaviourCall, EventOccurrence, Fluent, Junction

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robbdd_tools.catalog.api import Slot
    from robbdd_tools.protocol.clauses import Clause, Filler, Statement
    from robbdd_tools.protocol.specs import SceneSpec


def with_fitting_predicates(statement: Statement | None, scene: SceneSpec) -> Statement | None:
    """Return a statement whose fluents have the predicates that take the elements of a scene.

    A fluent stays as it is if its own predicate takes its elements, or if no predicate with its words does.
    """
    if statement is None or isinstance(statement, BehaviourCall | EventOccurrence):
        return statement
    kinds = {
        **dict.fromkeys(scene.objects, "object"),
        **dict.fromkeys(scene.workspaces, "workspace"),
        **dict.fromkeys(scene.agents, "agent"),
    }
    return _fitting(statement, kinds)


def _fitting(clause: Clause, kinds: Mapping[str, str]) -> Clause:
    if isinstance(clause, Junction):
        return replace(clause, operands=tuple(_fitting(operand, kinds) for operand in clause.operands))
    if not isinstance(clause, Fluent):
        return clause
    for predicate, named in predicates_in_sentence(clause.predicate):
        arguments = {slot: clause.arguments[own] for slot, own in named.items()}
        if all(_fits(slot, arguments[slot.name], kinds) for slot in predicate.slots):
            return replace(clause, predicate=predicate, arguments=arguments)
    return clause


def _fits(slot: Slot, filler: Filler, kinds: Mapping[str, str]) -> bool:
    if slot.kind is Kind.QUANTITY:
        return isinstance(filler, str) and dimension_of(filler) == slot.dimension
    elements = (filler,) if isinstance(filler, str) else filler if isinstance(filler, tuple) else filler.elements
    return all(accepts(slot.kind, kinds.get(element, "")) for element in elements)
