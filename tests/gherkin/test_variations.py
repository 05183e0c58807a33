"""Variations expand in written order, the last variable fastest, and are counted without expanding."""

from itertools import islice

import pytest

from robbdd_tools.gherkin.variations import bindings, count
from robbdd_tools.graph.acceptance_model import Cell, Iri, Product, Selection, Table

A, B = Iri("x:a"), Iri("x:b")
LETTERS = (Iri("x:p"), Iri("x:q"), Iri("x:r"))


def local(cell: Cell) -> str:
    return "".join(map(local, cell)) if isinstance(cell, tuple) else str(cell).removeprefix("x:")


def rows(variation: Product | Table) -> list[str]:
    return [" ".join(map(local, binding.values())) for binding in bindings(variation)]


def test_a_product_varies_the_last_variable_fastest() -> None:
    assert rows(Product((A, B), (LETTERS[:2], (1, 2)))) == ["p 1", "p 2", "q 1", "q 2"]


def test_a_table_has_its_rows() -> None:
    assert rows(Table((A, B), ((LETTERS[0], 1), (LETTERS[1], (1, 2))))) == ["p 1", "q 12"]


@pytest.mark.parametrize(
    ("kind", "repeated", "expected"),
    [
        ("combinations", False, ["pq", "pr", "qr"]),
        ("combinations", True, ["pp", "pq", "pr", "qq", "qr", "rr"]),
        ("permutations", False, ["pq", "pr", "qp", "qr", "rp", "rq"]),
        ("permutations", True, ["pp", "pq", "pr", "qp", "qq", "qr", "rp", "rq", "rr"]),
    ],
)
def test_selections_follow_the_written_order(kind: str, repeated: bool, expected: list[str]) -> None:
    variation = Product((A,), (Selection(kind, LETTERS, 2, repeated),))
    assert rows(variation) == expected
    assert count(variation) == len(expected)


def test_an_empty_set_gives_no_scenario() -> None:
    assert count(Product((A, B), (LETTERS, ()))) == 0
    assert rows(Product((A, B), (LETTERS, ()))) == []


def test_a_huge_variation_is_neither_counted_nor_begun_by_expanding_it() -> None:
    variation = Product((A, B), (Selection("permutations", tuple(range(40)), 20, False), (1, 2)))
    assert count(variation) > 10**29
    assert len(list(islice(bindings(variation), 3))) == 3
