"""Group the values of a variable with many numeric values, so that rates can be counted for each group."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

MOST_LEVELS = 10
"""A variable with more numeric values is grouped."""
PARTS = 4
"""The number of groups."""


@dataclass(frozen=True, slots=True)
class Bins:
    """Four equal parts of the values from ``low`` to ``high``. A bound between two parts belongs to the upper one."""

    low: float
    high: float

    def word(self, value: float) -> str:
        """Return the bounds of the part in which a value is."""
        width = (self.high - self.low) / PARTS
        part = min(int((value - self.low) / width), PARTS - 1)
        return f"{self.low + part * width:.4g} to {self.low + (part + 1) * width:.4g}"


def bins_of(levels: Iterable[Mapping[str, Any]]) -> dict[str, Bins]:
    """Return the groups of each factor or variable that has more than ``MOST_LEVELS`` values, all of them numbers."""
    numbers: dict[str, set[float]] = {}
    others: set[str] = set()
    for one in levels:
        for name, value in one.items():
            if isinstance(value, int | float) and not isinstance(value, bool):
                numbers.setdefault(name, set()).add(value)
            else:
                others.add(name)
    many = {name: found for name, found in numbers.items() if name not in others and len(found) > MOST_LEVELS}
    return {name: Bins(min(found), max(found)) for name, found in many.items()}


def in_order(words: Iterable[str], bins: Bins | None) -> list[str]:
    """Return the words of levels: those of groups by their bounds, others in their order."""
    return list(words) if bins is None else sorted(words, key=lambda word: float(word.partition(" ")[0]))
