"""Read named predicates. Such a predicate is a phrase with parameters, which other predicates define."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import Fluent, Iri
from robbdd_tools.graph.rdf.records import Incomplete, Records
from robbdd_tools.graph.rdf.vocabulary import NAMED_USE, STATES
from robbdd_tools.monitor.compound import compound_predicate, elements_in, required
from robbdd_tools.monitor.predicate_definitions import Combination, Definition, Element, Operand, Passed

if TYPE_CHECKING:
    from rdflib.term import Node

    from robbdd_tools.catalog.api import Predicate, Slot

_LITERALS = (Kind.QUANTITY, Kind.VALUE)
"""Kinds of slots that a literal may fill instead of a variable."""
PLACEHOLDER = re.compile(r"<[^<>]*>")


def read_use(records: Records, iri: Iri, inside: tuple[Iri, ...] = ()) -> tuple[Predicate, Mapping[str, Iri | str]]:
    """Return the named predicate of a clause or of a condition, and the values of its parameters.

    ``inside`` are the predicates whose definitions contain the clause or condition. Raises ``Incomplete``.
    """
    named = read_named(records, records.one(iri, "rbw:named-predicate"), inside)
    values = [read_value(records, node) for node in records.list_of(iri, "rbw:argument-list")]
    if len(values) != len(named.slots):
        raise Incomplete(f"{iri} has {len(values)} values for the {len(named.slots)} parameters of {named.name}")
    return named, {slot.name: value for slot, value in zip(named.slots, values, strict=True)}


def read_named(records: Records, iri: Iri, inside: tuple[Iri, ...] = ()) -> Predicate:
    """Return a named predicate. Its elements have their IRIs, and its name is its IRI.

    ``inside`` are the predicates whose definitions contain it. Raises ``Incomplete``.
    """
    if iri in inside:
        raise Incomplete(f"the definition of {iri} contains itself")
    parameters = records.iris(records.list_of(iri, "rbw:parameters"))
    slots = dict(zip(parameters, slot_names(parameters), strict=True))
    phrase = records.text(iri, "rbw:phrase")
    if len(PLACEHOLDER.findall(phrase)) != len(slots):
        raise Incomplete(f"the phrase of {iri} does not have one place for each parameter")
    names = iter(slots.values())
    plain = phrase.replace("{", "(").replace("}", ")")
    sentence = PLACEHOLDER.sub(lambda _: f'"{{{next(names)}}}"', plain)
    body = _definition(records, records.one(iri, "rbw:defined-as"), slots, (*inside, iri), ())
    return compound_predicate(iri, sentence, tuple(slots.values()), body)


def slot_names(parameters: Sequence[str]) -> list[str]:
    """Return a unique identifier for each parameter: the last word of its IRI, if possible."""
    found: list[str] = []
    for number, parameter in enumerate(parameters, start=1):
        name = re.sub(r"\W", "_", re.split(r"[./#:]", parameter)[-1])
        found.append(name if name.isidentifier() and name not in found else f"value_{number}")
    return found


def read_arguments(records: Records, iri: Iri, slots: Iterable[Slot]) -> Mapping[str, Iri | str]:
    """Return the terms that fill the slots of a catalog phrase. Raises ``Incomplete``."""
    return {
        slot.name: records.text(iri, slot.property)
        if slot.kind is Kind.NAME or (slot.kind in _LITERALS and _has_literal(records, iri, slot.property))
        else records.one(iri, slot.property)
        for slot in slots
    }


def required_parts(clause: Fluent) -> Iterator[Fluent]:
    """Yield, for a clause with a named predicate, a clause for each catalog predicate that this predicate requires."""
    for predicate, fillers in () if clause.named is None else required(clause.named, clause.arguments):
        arguments = {name: Iri(filler) if isinstance(filler, Element) else filler for name, filler in fillers.items()}
        yield replace(clause, predicate=predicate.name, arguments=arguments, named=None)


def elements_named(predicate: Predicate | None) -> Iterator[Iri]:
    """Yield the elements that the definition of a named predicate names."""
    return (Iri(element) for element in (() if predicate is None else elements_in(predicate)))


def _definition(
    records: Records, iri: Iri, slots: Mapping[Iri, str], inside: tuple[Iri, ...], above: tuple[Iri, ...]
) -> Definition:
    if iri in above:
        raise Incomplete(f"{iri} contains itself")
    for operator, kind in _OPERATORS.items():
        if records.is_a(iri, kind):
            operands = tuple(
                _definition(records, one, slots, inside, (*above, iri))
                for one in records.iris(records.list_of(iri, "rbw:operands"))
            )
            if not operands or (operator == "not" and len(operands) != 1):
                raise Incomplete(f"{iri} has {len(operands)} operands")
            return Combination(operator, operands)
    if records.is_a(iri, NAMED_USE):
        named, arguments = read_use(records, iri, inside)
        return Operand(named, _fillers(arguments, slots))
    for word in load_catalog().predicates.values():
        if records.is_a(iri, word.rdf_type):
            if word.duration is not None:
                raise Incomplete(f"{iri} is about a duration, which has no truth at an instant")
            return Operand(word, _fillers(read_arguments(records, iri, word.slots), slots))
    raise Incomplete(f"{iri} has no predicate that this installation knows")


_OPERATORS: Mapping[Literal["and", "or", "not"], str] = {
    "and": STATES["and"],
    "or": STATES["or"],
    "not": STATES["not"],
}


def _fillers(arguments: Mapping[str, Iri | str], slots: Mapping[Iri, str]) -> dict[str, Passed | str]:
    found: dict[str, Passed | str] = {}
    for name, value in arguments.items():
        if isinstance(value, Iri):
            found[name] = Passed(slots[value]) if value in slots else Element(value)
        else:
            found[name] = value
    return found


def _has_literal(records: Records, iri: Iri, term: str) -> bool:
    return len(records.iris(records.all(iri, term))) < len(records.all(iri, term))


def read_value(records: Records, node: Node) -> Iri | str:
    """Return a variable, an element, or a literal as text."""
    value = records.value(node)
    return value if isinstance(value, Iri) else str(value)
