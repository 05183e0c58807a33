"""Group the values of a variable with many numeric values, so that rates can be counted for each group."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from robbdd_tools.base.quantity_units import split_quantity

MOST_LEVELS = 10
"""The values of a variable are grouped if it has more numeric values than this."""
PARTS = 4
"""The number of groups."""


@dataclass(frozen=True, slots=True)
class Bins:
    """Four equal parts of the values from ``low`` to ``high``. A bound between two parts belongs to the upper one."""

    low: float
    high: float
    unit: str = ""

    def word(self, value: Any) -> str:
        """Return the bounds of the part that contains a value, in words."""
        value, _ = _number(value) or (self.low, "")
        width = (self.high - self.low) / PARTS
        part = min(int((value - self.low) / width), PARTS - 1)
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.low + part * width:.4g}{unit} to {self.low + (part + 1) * width:.4g}{unit}"


def _number(value: Any) -> tuple[float, str] | None:
    """Return a value as number and unit (empty for a plain number); ``None`` if it is neither number nor quantity."""
    if isinstance(value, str):
        found = split_quantity(value)
        return None if found is None else (float(found[0]), found[1])
    return (value, "") if isinstance(value, int | float) and not isinstance(value, bool) else None


def bins_of(levels: Iterable[Mapping[str, Any]]) -> dict[str, Bins]:
    """Return the groups of each factor or variable that has more than ``MOST_LEVELS`` values, all of them numbers."""
    found: dict[str, set[tuple[float, str] | None]] = {}
    for one in levels:
        for name, value in one.items():
            found.setdefault(name, set()).add(_number(value))
    bins: dict[str, Bins] = {}
    for name, entries in found.items():
        numbers = [entry for entry in entries if entry is not None]
        units = {unit for _, unit in numbers}
        if len(numbers) == len(entries) > MOST_LEVELS and len(units) == 1:
            values = [value for value, _ in numbers]
            bins[name] = Bins(min(values), max(values), units.pop())
    return bins


def in_order(words: Iterable[str], bins: Bins | None) -> list[str]:
    """Return the words of levels in order: groups by their bounds, others as given."""
    return list(words) if bins is None else sorted(words, key=lambda word: float(word.partition(" ")[0]))
