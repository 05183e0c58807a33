"""Covering arrays: few scenarios that contain every combination of values of two or three variables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from itertools import combinations, product
from math import comb, prod
from typing import TYPE_CHECKING, Any

from robbdd_tools.gherkin.scenario_outline import variable_name
from robbdd_tools.gherkin.variations import cells_of, size_of
from robbdd_tools.graph.acceptance_model import Cell, Product, Table

if TYPE_CHECKING:
    from robbdd_tools.gherkin.where import Condition

MAX_COMBINATIONS = 100_000
"""Maximum number of combinations to cover in a product. Covering this many takes some minutes."""

Row = tuple[int, ...]
"""One scenario, as the index of the value of each variable."""
Combined = tuple[tuple[int, int], ...]
"""A combination to cover: a pair (variable, value) for each of its variables."""


class TooManyCombinations(Exception):
    """The combinations of values cannot be listed, because the variables have too many values."""


@dataclass(frozen=True, slots=True)
class Cover:
    """A covering array.

    ``indices`` are the indices of its scenarios (from 0, ascending). ``possible`` is the number of combinations that
    exist, and ``covered`` is the number of those that the scenarios contain.
    """

    indices: tuple[int, ...]
    covered: int
    possible: int


def cover(variation: Product | Table, strength: int, allowed: Condition | None = None) -> Cover:
    """Choose scenarios that together contain all combinations of values of ``strength`` variables.

    Only allowed scenarios, and combinations that occur in them, are considered. Raises ``TooManyCombinations``.
    """
    strength = min(strength, len(variation.variables))
    if isinstance(variation, Product):
        _refuse_too_many(variation, strength)
    space = _space(variation)
    chosen = _suggested(space, strength, allowed) if isinstance(variation, Product) and strength > 1 else []
    covered = {combined for row in chosen for combined in _combined(row, strength)}
    if isinstance(variation, Product) and allowed is None:
        possible = _combinations_of(list(map(len, space.columns)), strength)
    else:
        possible = len({combined for row in space.rows(allowed) for combined in _combined(row, strength)})
    most = comb(len(variation.variables), strength)
    # The suggested rows may leave gaps: fill them, first with the scenarios that fill most gaps.
    for least in range(most, 0, -1):
        if len(covered) == possible:
            break
        for row in space.rows(allowed):
            new = [combined for combined in _combined(row, strength) if combined not in covered]
            if len(new) >= least:
                covered.update(new)
                chosen.append(row)
    return Cover(tuple(sorted({space.index(row) for row in chosen})), len(covered), possible)


@dataclass(frozen=True, slots=True)
class _Space:
    """The scenarios of a variation as rows of indices. For a table, ``numbers`` maps each row to its index."""

    columns: tuple[tuple[Cell, ...], ...]
    numbers: dict[Row, int] | None

    def rows(self, allowed: Condition | None) -> Iterator[Row]:
        every = product(*(range(len(column)) for column in self.columns)) if self.numbers is None else self.numbers
        for row in every:
            if allowed is None or allowed(self.cells(row)):
                yield row

    def cells(self, row: Sequence[int]) -> tuple[Cell, ...]:
        return tuple(column[number] for column, number in zip(self.columns, row, strict=False))

    def index(self, row: Row) -> int:
        if self.numbers is not None:
            return self.numbers[row]
        index = 0
        for column, number in zip(self.columns, row, strict=True):
            index = index * len(column) + number
        return index


def _space(variation: Product | Table) -> _Space:
    if isinstance(variation, Product):
        return _Space(tuple(tuple(cells_of(choices)) for choices in variation.choices), None)
    places: list[dict[Cell, int]] = [{} for _ in variation.variables]
    numbers: dict[Row, int] = {}
    for index, cells in enumerate(variation.rows):
        row = tuple(place.setdefault(cell, len(place)) for place, cell in zip(places, cells, strict=True))
        numbers.setdefault(row, index)
    return _Space(tuple(tuple(place) for place in places), numbers)


def _refuse_too_many(variation: Product, strength: int) -> None:
    sizes = [size_of(choices) for choices in variation.choices]
    number = _combinations_of(sizes, strength)
    if max(number, *sizes, 0) > MAX_COMBINATIONS:
        largest = sizes.index(max(sizes))
        raise TooManyCombinations(
            f"covering the combinations of {strength} variables is possible for up to {MAX_COMBINATIONS} of them and "
            f"not for {number}: variable '{variable_name(variation.variables[largest])}' has {sizes[largest]} values"
        )


def _combinations_of(sizes: Sequence[int], strength: int) -> int:
    return sum(map(prod, combinations(sizes, strength))) if all(sizes) else 0


def _suggested(space: _Space, strength: int, allowed: Condition | None) -> list[Row]:
    if not all(space.columns):
        return []
    # covertable has no type information.
    make: Any = import_module("covertable").make
    columns = [list(range(len(column))) for column in space.columns]
    rows = (tuple(row) for row in make(columns, strength=strength))
    return [row for row in rows if allowed is None or allowed(space.cells(row))]


def _combined(row: Row, strength: int) -> Iterator[Combined]:
    return combinations(tuple(enumerate(row)), strength)
