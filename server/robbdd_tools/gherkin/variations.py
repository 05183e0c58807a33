"""Expand a variation into the values of its scenarios, one scenario at a time and in written order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import prod

from robbdd_tools.graph.acceptance_model import Cell, Iri, Product, Selection, Table

Binding = Mapping[Iri, Cell]
"""Maps each variable to its value in one scenario."""


def bindings(variation: Product | Table) -> Iterator[Binding]:
    """Yield the values of each scenario. In a product, the last variable varies fastest."""
    if isinstance(variation, Table):
        rows: Iterable[tuple[Cell, ...]] = variation.rows
    else:
        rows = _product(variation.choices)
    for row in rows:
        yield dict(zip(variation.variables, row, strict=True))


def count(variation: Product | Table) -> int:
    """Return the number of scenarios without generating them."""
    if isinstance(variation, Table):
        return len(variation.rows)
    return prod(size_of(choices) for choices in variation.choices)


def at(variation: Product | Table, index: int) -> Binding:
    """Return the values of the scenario at an index (from 0) without generating the others. Raises ``IndexError``."""
    if not 0 <= index < count(variation):
        raise IndexError(index)
    if isinstance(variation, Table):
        return dict(zip(variation.variables, variation.rows[index], strict=True))
    cells: list[Cell] = []
    for choices in reversed(variation.choices):
        index, digit = divmod(index, size_of(choices))
        cells.append(choices.rule.at(choices.source, digit) if isinstance(choices, Selection) else choices[digit])
    return dict(zip(variation.variables, reversed(cells), strict=True))


def _product(choices: tuple[tuple[Cell, ...] | Selection, ...]) -> Iterator[tuple[Cell, ...]]:
    """Yield the same as ``itertools.product``, which would first expand every selection in memory."""
    if not choices:
        yield ()
        return
    for cell in cells_of(choices[0]):
        for rest in _product(choices[1:]):
            yield (cell, *rest)


def cells_of(choices: tuple[Cell, ...] | Selection) -> Iterable[Cell]:
    """Return the values of a variable of a product in order."""
    return choices.rule.sets(choices.source) if isinstance(choices, Selection) else choices


def size_of(choices: tuple[Cell, ...] | Selection) -> int:
    """Return the number of values of a variable of a product."""
    return choices.rule.count(len(choices.source)) if isinstance(choices, Selection) else len(choices)
