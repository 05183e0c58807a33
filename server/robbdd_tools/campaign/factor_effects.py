"""The effect of each level of a factor on the pass rate, and factors that are confounded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from robbdd_tools.campaign.rates import Interval, rate_interval, separate_interval

LEAST = 0.1
"""Associations of two factors below this Cramér's V are not reported, as samples have them by chance."""


@dataclass(frozen=True, slots=True)
class LevelEffect:
    """The executions with one level of a factor against all others.

    ``holding`` of ``total`` executions hold, and ``interval`` is the interval of this pass rate. ``difference`` is this
    rate minus the pass rate of all other levels together, and ``change`` is the interval of the difference.
    """

    factor: str
    level: str
    holding: int
    total: int
    interval: Interval
    difference: float
    change: Interval


@dataclass(frozen=True, slots=True)
class Confounding:
    """Two factors whose levels do not occur in all combinations, or not equally often.

    - ``strength``: Cramér's V, from 0 (independent) to 1 (a level of one determines that of the other).
    - ``nested``: whether each level of the first factor occurs with only one level of the second.
    - ``inseparable``: whether each factor is nested in the other, so that their effects cannot be separated.
    """

    factors: tuple[str, str]
    strength: float
    nested: bool
    inseparable: bool


def level_effects(name: str, levels: Sequence[str], of: Sequence[int], holds: Sequence[bool]) -> list[LevelEffect]:
    """Return the effects of the ``levels`` of a factor. Raises ``StatisticsNotInstalled``.

    ``of`` has the number of the level of each execution; ``holds`` is true for each execution that holds.
    """
    totals, holding = Counter(of), Counter(level for level, one in zip(of, holds, strict=True) if one)
    every, passed = len(of), sum(holds)
    found: list[LevelEffect] = []
    for number, level in enumerate(levels):
        own, rest = (holding[number], totals[number]), (passed - holding[number], every - totals[number])
        difference = (own[0] / own[1] - rest[0] / rest[1]) if own[1] and rest[1] else 0.0
        change = separate_interval(rest, own)
        found.append(LevelEffect(name, level, *own, rate_interval(*own), difference, change))
    return found


def confounded(names: Sequence[str], of: Sequence[Sequence[int]]) -> Iterator[Confounding]:
    """Yield the pairs of factors that are not balanced. ``of`` has the level of each execution for each factor.

    If one factor is nested in the other, the nested factor is the first of the pair.
    """
    for (one, first), (other, second) in combinations(zip(names, of, strict=True), 2):
        strength = _association(first, second)
        if strength >= LEAST:
            pairs = len(set(zip(first, second, strict=True)))
            nested, nests = pairs == len(set(first)), pairs == len(set(second))
            pair = (other, one) if nests and not nested else (one, other)
            yield Confounding(pair, strength, nested or nests, nested and nests)


def _association(first: Sequence[int], second: Sequence[int]) -> float:
    """Return Cramér's V (1946) of two classifications of the same executions, without correction for chance."""
    rows, columns, cells = Counter(first), Counter(second), Counter(zip(first, second, strict=True))
    smaller = min(len(rows), len(columns)) - 1
    if smaller < 1:
        return 0.0
    share = sum(cell**2 / (rows[row] * columns[column]) for (row, column), cell in cells.items())
    return (max(0.0, share - 1.0) / smaller) ** 0.5
