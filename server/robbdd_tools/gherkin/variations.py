"""Expands a variation into the values of its scenarios, one at a time, in written order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations, combinations_with_replacement, permutations
from math import comb, perm, prod

from robbdd_tools.graph.model import Cell, Iri, Product, Selection, Table, Value

Binding = Mapping[Iri, Cell]
"""Variable → its value in one scenario."""


def bindings(variation: Product | Table) -> Iterator[Binding]:
    """Yield the values of each scenario; in a product the last variable varies fastest."""
    if isinstance(variation, Table):
        rows: Iterable[tuple[Cell, ...]] = variation.rows
    else:
        rows = _product(variation.choices)
    for row in rows:
        yield dict(zip(variation.variables, row, strict=True))


def count(variation: Product | Table) -> int:
    """Return the number of scenarios without making them."""
    if isinstance(variation, Table):
        return len(variation.rows)
    return prod(size_of(choices) for choices in variation.choices)


def at(variation: Product | Table, index: int) -> Binding:
    """Return the values of one scenario, counted from 0, without making the others; raises ``IndexError``."""
    if not 0 <= index < count(variation):
        raise IndexError(index)
    if isinstance(variation, Table):
        return dict(zip(variation.variables, variation.rows[index], strict=True))
    cells: list[Cell] = []
    for choices in reversed(variation.choices):
        index, digit = divmod(index, size_of(choices))
        cells.append(_select(choices, digit) if isinstance(choices, Selection) else choices[digit])
    return dict(zip(variation.variables, reversed(cells), strict=True))


def _product(choices: tuple[tuple[Cell, ...] | Selection, ...]) -> Iterator[tuple[Cell, ...]]:
    """As ``itertools.product``, which would first write every selection out in memory."""
    if not choices:
        yield ()
        return
    for cell in cells_of(choices[0]):
        for rest in _product(choices[1:]):
            yield (cell, *rest)


def cells_of(choices: tuple[Cell, ...] | Selection) -> Iterable[Cell]:
    """Return the values that a variable of a product gets, one after the other."""
    if not isinstance(choices, Selection):
        return choices
    if choices.kind == "permutations":
        return permutations(choices.source, choices.length)
    if choices.repeated:
        return combinations_with_replacement(choices.source, choices.length)
    return combinations(choices.source, choices.length)


def size_of(choices: tuple[Cell, ...] | Selection) -> int:
    """Return the number of values that a variable of a product gets."""
    if not isinstance(choices, Selection):
        return len(choices)
    available, length = len(choices.source), choices.length
    if choices.kind == "permutations":
        return perm(available, length)
    if choices.repeated:
        return comb(available + length - 1, length) if available else 0
    return comb(available, length)


def _select(selection: Selection, index: int) -> tuple[Value, ...]:
    """Return the selected set of a rank, counting as ``itertools`` does."""
    free = list(selection.source)
    picked: list[Value] = []
    for left in range(selection.length - 1, -1, -1):
        if selection.kind == "permutations":
            place, index = divmod(index, perm(len(free) - 1, left))
            picked.append(free.pop(place))
        else:
            while index >= (block := _continuations(len(free), left, selection.repeated)):
                index -= block
                free.pop(0)
            picked.append(free[0] if selection.repeated else free.pop(0))
    return tuple(picked)


def _continuations(available: int, left: int, repeated: bool) -> int:
    """Return how many combinations begin with the first of ``available`` elements and have ``left`` more."""
    return comb(available + left - 1, left) if repeated else comb(available - 1, left)
