"""Definitions of named predicates as data."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from robbdd_tools.base.quantity_units import UNITS

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, Predicate

_SLOT = re.compile(r"\"?\{(\w+)\}\"?")
LEAST = -2.2250738585072014e-308
"""If the margin of a predicate is 0, its negation has this margin: the predicate holds, so its negation does not."""


@dataclass(frozen=True, slots=True)
class Passed:
    """The parameter of a named predicate that fills a slot."""

    parameter: str


class Element(str):
    """The IRI of an element in a definition, until it is shortened; a plain ``str`` is a value."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Operand:
    """A predicate in the definition of another one. ``fillers`` maps its slots to parameters, elements and values."""

    predicate: Predicate
    fillers: Mapping[str, Passed | str]

    def arguments(self, given: Arguments) -> Arguments:
        """Return the arguments of the predicate, from the arguments ``given`` to the predicate that it defines."""
        return {
            slot: given[filler.parameter] if isinstance(filler, Passed) else filler
            for slot, filler in self.fillers.items()
        }


@dataclass(frozen=True, slots=True)
class Combination:
    """Definitions that are joined by ``and`` or ``or``, or one negated definition."""

    operator: Literal["and", "or", "not"]
    operands: tuple[Definition, ...]


Definition = Operand | Combination


@dataclass(frozen=True, slots=True)
class Defined:
    """An evaluator that consists of a definition."""

    definition: Definition


def dimension_of(unit: str) -> str:
    """Return the dimension that a unit measures, or the unit itself if it is unknown."""
    return UNITS[unit][0] if unit in UNITS else unit


def unit_of(predicate: Predicate, evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of a predicate's margin in a clause, or its usual unit if evidence for the choice is missing."""
    if predicate.unit_for is None:
        return predicate.unit
    try:
        return predicate.unit_for(evidence, arguments)
    except LookupError:
        return predicate.unit


def words_of(predicate: Predicate, arguments: Arguments) -> str:
    """Return a predicate with its arguments as words, as in a sentence of Gherkin."""

    def shown(match: re.Match[str]) -> str:
        filler = arguments.get(match[1], match[0])
        return filler if isinstance(filler, str) else "[" + ", ".join(filler) + "]"

    return _SLOT.sub(shown, predicate.sentence)
