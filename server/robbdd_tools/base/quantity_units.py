"""Units of quantities, with the dimensions that they measure and their sizes in SI units."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import isfinite, pi

UNITS = {
    "m": ("length", 1.0),
    "cm": ("length", 0.01),
    "mm": ("length", 0.001),
    "s": ("time", 1.0),
    "ms": ("time", 0.001),
    "rad": ("angle", 1.0),
    "deg": ("angle", pi / 180),
    "N": ("force", 1.0),
    "kg": ("mass", 1.0),
    "g": ("mass", 0.001),
    "m/s": ("speed", 1.0),
    "deg/s": ("angular speed", pi / 180),
    "%": ("ratio", 0.01),
}
"""Unit → its dimension, and its size in the SI unit. All units are UCUM codes (Unified Code for Units of Measure)."""
_QUANTITY = re.compile(r"([-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S+)")


class QuantityError(ValueError):
    """A text is not a quantity, or the quantity has another dimension. The message says what to write."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number with a unit of ``UNITS``."""

    value: float
    unit: str

    @property
    def factor(self) -> float:
        """The size of the unit in the SI unit."""
        return si_factor(self.unit)

    @property
    def si(self) -> float:
        """The number in the SI unit."""
        return self.value * self.factor


def si_factor(unit: str) -> float:
    """Return the size of a unit in the SI unit; 1 for any other unit."""
    return UNITS[unit][1] if unit in UNITS else 1.0


def is_quantity(text: str) -> bool:
    """Return whether a text is a number with a unit of ``UNITS``."""
    return split_quantity(text) is not None


def dimension_of(text: str) -> str:
    """Return the dimension of a quantity, such as ``length``; empty for any other text."""
    found = split_quantity(text)
    return "" if found is None else UNITS[found[1]][0]


def split_quantity(text: str) -> tuple[str, str] | None:
    """Return the number and the unit of a quantity as they are written; ``None`` for any other text."""
    match = _QUANTITY.fullmatch(text)
    return (match[1], match[2]) if match is not None and match[2] in UNITS else None


def units_of(dimension: str) -> tuple[str, ...]:
    """Return the units of a dimension."""
    return tuple(unit for unit, (measures, _) in UNITS.items() if measures == dimension)


def read_quantity(text: str, dimension: str) -> Quantity:
    """Return the quantity that a text states, such as ``0.25 m/s``. Raises ``QuantityError``."""
    match = _QUANTITY.fullmatch(text.strip())
    example = with_unit(dimension)
    if match is None or match[2] not in UNITS:
        raise QuantityError(f"'{text}' has no unit: {example}")
    measures = UNITS[match[2]][0]
    if measures != dimension:
        raise QuantityError(f"'{text}' is {_article(measures)}, not {_article(dimension)}: {example}")
    value = float(match[1])
    if not isfinite(value):
        raise QuantityError(f"the number in '{text}' is too large")
    return Quantity(value, match[2])


def read_limit(text: str, dimension: str) -> Quantity:
    """Return a limit that is never negative. Raises ``QuantityError``.

    With a negative limit, a predicate such as *is farther than* would be true always or never.
    """
    found = read_quantity(text, dimension)
    if found.value < 0:
        raise QuantityError(
            f"the limit '{text}' is negative, so its clause would always have the same verdict: remove the sign"
        )
    return found


def with_unit(dimension: str) -> str:
    """Return the instruction to write a quantity with a unit."""
    return f"write {_article(dimension)} with its unit, as in '5 {units_of(dimension)[0]}'"


def _article(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
