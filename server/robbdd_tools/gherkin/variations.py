"""Expands a variation into the values of its scenarios, one at a time, in written order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations, combinations_with_replacement, permutations
from math import comb, perm, prod

from robbdd_tools.graph.model import Cell, Iri, Product, Selection, Table

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
    return prod(_size(choices) for choices in variation.choices)


def _product(choices: tuple[tuple[Cell, ...] | Selection, ...]) -> Iterator[tuple[Cell, ...]]:
    """As ``itertools.product``, which would first write every selection out in memory."""
    if not choices:
        yield ()
        return
    for cell in _cells(choices[0]):
        for rest in _product(choices[1:]):
            yield (cell, *rest)


def _cells(choices: tuple[Cell, ...] | Selection) -> Iterable[Cell]:
    if not isinstance(choices, Selection):
        return choices
    if choices.kind == "permutations":
        return permutations(choices.source, choices.length)
    if choices.repeated:
        return combinations_with_replacement(choices.source, choices.length)
    return combinations(choices.source, choices.length)


def _size(choices: tuple[Cell, ...] | Selection) -> int:
    if not isinstance(choices, Selection):
        return len(choices)
    available, length = len(choices.source), choices.length
    if choices.kind == "permutations":
        return perm(available, length)
    if choices.repeated:
        return comb(available + length - 1, length) if available else 0
    return comb(available, length)
