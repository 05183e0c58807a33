"""The form of predicates in a manifest: a catalog name, or the definition of a named predicate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from robbdd_tools.catalog.api import Predicate
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.compound import compound_predicate, definition_of
from robbdd_tools.monitor.predicate_definitions import Combination, Definition, Operand, Passed


def plain_predicate(predicate: Predicate) -> str | dict[str, Any]:
    """Return the JSON form of a predicate."""
    definition = definition_of(predicate)
    if definition is None:
        return predicate.name
    parameters = [slot.name for slot in predicate.slots]
    means = _plain(definition)
    return {"named": predicate.name, "sentence": predicate.sentence, "parameters": parameters, "means": means}


def predicate_of(data: str | Mapping[str, Any]) -> Predicate:
    """Return the predicate whose JSON form is ``data``. Raises ``KeyError``, ``TypeError`` or ``ValueError``."""
    if isinstance(data, str):
        return load_catalog().predicates[data]
    parameters = tuple(map(str, data["parameters"]))
    return compound_predicate(str(data["named"]), str(data["sentence"]), parameters, _definition(data["means"]))


def _plain(definition: Definition) -> dict[str, Any]:
    if isinstance(definition, Combination):
        return {definition.operator: [_plain(operand) for operand in definition.operands]}
    fillers = {
        slot: {"parameter": filler.parameter} if isinstance(filler, Passed) else filler
        for slot, filler in definition.fillers.items()
    }
    return {"predicate": plain_predicate(definition.predicate), "fillers": fillers}


def _definition(data: Mapping[str, Any]) -> Definition:
    match data:
        case {"predicate": predicate, "fillers": fillers}:
            found: Mapping[str, Any] = fillers
            return Operand(predicate_of(predicate), {slot: _filler(filler) for slot, filler in found.items()})
        case {"and": operands}:
            return Combination("and", tuple(map(_definition, operands)))
        case {"or": operands}:
            return Combination("or", tuple(map(_definition, operands)))
        case {"not": operands}:
            return Combination("not", tuple(map(_definition, operands)))
        case _:
            raise ValueError(f"{data!r} does not define a predicate")


def _filler(data: Any) -> Passed | str:
    match data:
        case {"parameter": str(name)}:
            return Passed(name)
        case str():
            return data
        case _:
            raise ValueError(f"{data!r} does not fill a slot")
