"""The gate of a comparison: how much worse a clause may become, as written by users."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from robbdd_tools.base.exceptions import RobbddError

_TEXT = re.compile(
    r"(?:no clause|(?P<clause>\S+) not) worse than (?P<number>\d+(?:\.\d+)?|\.\d+) ?(?P<unit>points?|%|[A-Za-z/²°]+)",
)
_SCALES: Mapping[str, tuple[str, float]] = {
    "mm": ("m", 0.001),
    "cm": ("m", 0.01),
    "ms": ("s", 0.001),
    "deg": ("rad", math.pi / 180),
}
EXAMPLE = "'no clause worse than 2 points', 'at-goal not worse than 5 mm'"


class NotAGate(RobbddError):
    """The text states no accepted change."""


@dataclass(frozen=True, slots=True)
class Limit:
    """How much worse a clause may be: a share of executions (``unit`` empty), or a mean margin in an SI unit."""

    size: float
    unit: str = ""


@dataclass(frozen=True, slots=True)
class Gate:
    """The accepted changes: ``common`` ones for all clauses; those ``by_name`` of a clause take precedence."""

    common: tuple[Limit, ...] = ()
    by_name: Mapping[str, tuple[Limit, ...]] = field(default_factory=dict[str, tuple[Limit, ...]])

    def limit(self, name: str, unit: str = "") -> float | None:
        """Return the accepted change of a clause in a unit (empty: share of executions); ``None`` if none is stated."""
        own = (*self.by_name.get(name, ()), *self.common)
        return next((limit.size for limit in own if limit.unit == unit), None)


def parse_gate(texts: Iterable[str]) -> Gate:
    """Parse texts such as ``no clause worse than 2 points``. Raises ``NotAGate``.

    A point is one of a hundred executions. Other units are those of margins: ``mm``, ``m``, ``s``, ``m/s``, ``N``, ….
    """
    common: list[Limit] = []
    by_name: dict[str, tuple[Limit, ...]] = {}
    for text in texts:
        found = _TEXT.fullmatch(" ".join(text.split()))
        if found is None:
            raise NotAGate(f"'{text}' is not a gate: write {EXAMPLE}")
        limit = _limit(float(found["number"]), found["unit"])
        if found["clause"] is None:
            common.append(limit)
        else:
            by_name[found["clause"]] = (*by_name.get(found["clause"], ()), limit)
    return Gate(tuple(common), by_name)


def _limit(number: float, unit: str) -> Limit:
    if unit in ("point", "points", "%"):
        return Limit(number / 100)
    base, scale = _SCALES.get(unit, (unit, 1.0))
    return Limit(number * scale, base)
