"""A predicate that is defined by others: their strong Kleene *and*, *or* and *not* at each sample.

A time constraint applies to the whole definition: *throughout (a or b)* holds if a or b holds at each sample; neither
of them needs to hold throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.base.quantity_units import units_of
from robbdd_tools.catalog.api import Kind, Predicate, Slot
from robbdd_tools.monitor.predicate_definitions import (
    Combination,
    Defined,
    Definition,
    Element,
    Operand,
    Passed,
    dimension_of,
    unit_of,
)

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray
    from robbdd_tools.monitor.compound_samples import Samples

Filled = TypeVar("Filled")
SETS = (Kind.OBJECT_SET, Kind.WORKSPACE_SET)


@dataclass(frozen=True, slots=True)
class CompoundEvaluator(Defined):
    """Evaluates a definition."""

    def __call__(self, evidence: Evidence, arguments: Arguments) -> FloatArray:
        """Return the margin at each sample, shape (n,), in the unit of ``unit``; NaN where the truth is unknown.

        Margins in several units cannot be compared. In this case, the margin is 1 where the definition is true, and -1
        where it is false.
        """
        # Editors also read definitions, and do not load numpy.
        from robbdd_tools.monitor.compound_samples import plain_margins

        return plain_margins(self.samples(evidence, arguments), self.unit(evidence, arguments))

    def samples(self, evidence: Evidence, arguments: Arguments) -> Samples:
        """Return the truth at each sample, with the predicate that decides it."""
        from robbdd_tools.monitor.compound_samples import samples_of

        return samples_of(self.definition, evidence, arguments)

    def unit(self, evidence: Evidence, arguments: Arguments) -> str:
        """Return the unit of all margins; empty if they have several units or none."""
        found = {unit_of(one, evidence, own) for one, own in leaves(self.definition, arguments)}
        dimensions = {dimension_of(unit) for unit in found}
        if len(dimensions) != 1:
            return ""
        return found.pop() if len(found) == 1 else units_of(dimensions.pop())[0]


@dataclass(frozen=True, slots=True)
class CompoundUnit:
    """Chooses the unit of a definition's margins. Choosers of equal definitions are equal."""

    evaluator: CompoundEvaluator

    def __call__(self, evidence: Evidence, arguments: Arguments) -> str:
        """Return the unit, as ``CompoundEvaluator.unit`` does."""
        return self.evaluator.unit(evidence, arguments)


def definition_of(predicate: Predicate) -> Definition | None:
    """Return the definition of a named predicate; ``None`` for a predicate of the catalog."""
    return predicate.evaluate.definition if isinstance(predicate.evaluate, CompoundEvaluator) else None


def renamed(predicate: Predicate, name: Callable[[str], str]) -> Predicate:
    """Return a named predicate whose elements have other names; a predicate of the catalog is unchanged."""

    def within(definition: Definition) -> Definition:
        if isinstance(definition, Combination):
            return replace(definition, operands=tuple(map(within, definition.operands)))
        fillers = {
            slot: name(filler) if isinstance(filler, Element) else filler for slot, filler in definition.fillers.items()
        }
        return Operand(renamed(definition.predicate, name), fillers)

    definition = definition_of(predicate)
    if definition is None:
        return predicate
    evaluator = CompoundEvaluator(within(definition))
    return replace(predicate, name=name(predicate.name), evaluate=evaluator, unit_for=CompoundUnit(evaluator))


def elements_in(predicate: Predicate) -> Iterator[Element]:
    """Yield the elements that the definition of a predicate names."""
    definition = definition_of(predicate)
    for operand in () if definition is None else operands_of(definition):
        yield from (filler for filler in operand.fillers.values() if isinstance(filler, Element))
        yield from elements_in(operand.predicate)


def required(
    predicate: Predicate, arguments: Mapping[str, Filled]
) -> Iterator[tuple[Predicate, dict[str, Filled | str]]]:
    """Yield the predicates of the catalog that must hold for a predicate to hold, with the fillers of their slots.

    Predicates inside *or* and *not* are left out.
    """

    def within(
        definition: Definition, given: Mapping[str, Filled | str]
    ) -> Iterator[tuple[Predicate, dict[str, Filled | str]]]:
        if isinstance(definition, Combination):
            for operand in definition.operands if definition.operator == "and" else ():
                yield from within(operand, given)
            return
        own: dict[str, Filled | str] = {
            slot: given[filler.parameter] if isinstance(filler, Passed) else filler
            for slot, filler in definition.fillers.items()
        }
        inner = definition_of(definition.predicate)
        if inner is None:
            yield definition.predicate, own
        else:
            yield from within(inner, own)

    definition = definition_of(predicate)
    if definition is not None:
        yield from within(definition, dict(arguments))


def leaves(definition: Definition, arguments: Arguments) -> Iterator[tuple[Predicate, Arguments]]:
    """Yield the predicates of the catalog in a definition with their arguments, in written order."""
    if isinstance(definition, Combination):
        for operand in definition.operands:
            yield from leaves(operand, arguments)
        return
    inner, own = definition.predicate.evaluate, definition.arguments(arguments)
    if isinstance(inner, CompoundEvaluator):
        yield from leaves(inner.definition, own)
    else:
        yield definition.predicate, own


def operands_of(definition: Definition) -> Iterator[Operand]:
    """Yield the predicates in a definition, in written order."""
    if isinstance(definition, Operand):
        yield definition
    else:
        for operand in definition.operands:
            yield from operands_of(operand)


def compound_predicate(name: str, sentence: str, parameters: tuple[str, ...], definition: Definition) -> Predicate:
    """Return a named predicate. ``sentence`` is its form in Gherkin, with a ``{slot}`` for each parameter."""
    operands = tuple(operands_of(definition))
    evaluator = CompoundEvaluator(definition)
    quantities = dict.fromkeys(quantity for one in operands for quantity in one.predicate.quantities)
    return Predicate(
        name,
        "",
        "",
        tuple(_slot(parameter, operands) for parameter in parameters),
        sentence,
        "",
        "",
        evaluator,
        tuple(quantities),
        unit_for=CompoundUnit(evaluator),
        set_up=any(one.predicate.set_up for one in operands),
    )


def _slot(parameter: str, operands: tuple[Operand, ...]) -> Slot:
    """Return the slot of a parameter: the most specific slot that it fills."""
    filled = [
        slot for one in operands for slot in one.predicate.slots if one.fillers.get(slot.name) == Passed(parameter)
    ]
    best = max(filled, key=lambda slot: (slot.kind in SETS, slot.kind is not Kind.ANY), default=None)
    return Slot(parameter, Kind.ANY, "") if best is None else replace(best, name=parameter, property="")


Change = Callable[[Predicate, "Arguments", int], Predicate]
"""Returns the replacement of a predicate with its arguments; the number is -1 in an odd number of negations, else 1."""


def changed(predicate: Predicate, arguments: Arguments, change: Change) -> Predicate:
    """Return a predicate in which ``change`` has replaced the predicates of the catalog that define it."""

    def within(definition: Definition, given: Arguments, sign: int) -> Definition:
        if isinstance(definition, Combination):
            inner = -sign if definition.operator == "not" else sign
            return replace(definition, operands=tuple(within(one, given, inner) for one in definition.operands))
        return replace(definition, predicate=renewed(definition.predicate, definition.arguments(given), sign))

    def renewed(one: Predicate, own: Arguments, sign: int) -> Predicate:
        if not isinstance(one.evaluate, CompoundEvaluator):
            return change(one, own, sign)
        evaluator = CompoundEvaluator(within(one.evaluate.definition, own, sign))
        return replace(one, evaluate=evaluator, unit_for=CompoundUnit(evaluator))

    return renewed(predicate, arguments, 1)
