"""Combinations and permutations: their number, all of them in order, and the one with a given rank.

A selection has ``length`` elements. The order of elements matters in permutations, but not in combinations. Both may
repeat elements. They are ordered as by ``itertools``. All numbers of scenarios are computed with this module.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, combinations_with_replacement, permutations, product
from math import comb, perm
from typing import TypeVar

PERMUTATIONS = "permutations"
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class SelectionRule:
    """The rule by which elements are selected. ``kind`` is ``combinations`` or ``permutations``."""

    kind: str
    length: int
    repeated: bool

    def count(self, available: int) -> int:
        """Return the number of selections from ``available`` elements."""
        if self.kind == PERMUTATIONS:
            return available**self.length if self.repeated else perm(available, self.length)
        if not self.repeated:
            return comb(available, self.length)
        return comb(available + self.length - 1, self.length) if available else int(self.length == 0)

    def sets(self, source: Sequence[T]) -> Iterator[tuple[T, ...]]:
        """Yield the selections in order."""
        if self.kind == PERMUTATIONS:
            return product(source, repeat=self.length) if self.repeated else permutations(source, self.length)
        choose = combinations_with_replacement if self.repeated else combinations
        return choose(source, self.length)

    def at(self, source: Sequence[T], rank: int) -> tuple[T, ...]:
        """Return the selection with the index ``rank`` (from 0) without computing the ones before it."""
        free = list(source)
        picked: list[T] = []
        for left in range(self.length - 1, -1, -1):
            rest = SelectionRule(self.kind, left, self.repeated)
            if self.kind == PERMUTATIONS:
                place, rank = divmod(rank, rest.count(len(free) - (not self.repeated)))
            else:
                place = 0
                while rank >= (block := rest.count(len(free) - place - (not self.repeated))):
                    rank -= block
                    place += 1
                del free[:place]
                place = 0
            picked.append(free[place] if self.repeated else free.pop(place))
        return tuple(picked)
