"""Selection before generation: samples, covering arrays, the first few."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import combinations, islice, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robbdd_tools.gherkin.select import Selected, SelectionError, Wanted
from robbdd_tools.gherkin.variations import at, bindings, count
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    Cell,
    Iri,
    Product,
    SceneModel,
    Selection,
    Table,
    Template,
    Variant,
)

MODEL = AcceptanceModel((), {}, {}, {"x": "x:"})
TEMPLATE = Template(Iri("x:t"), (), Iri("x:a"), Iri("x:b"))


def variant(variation: Product | Table, name: str = "v") -> Variant:
    return Variant(Iri(f"x:{name}"), TEMPLATE, (), SceneModel((), (), (), {}, {}), variation)


def numbers(*sizes: int) -> Product:
    """A product whose variables a, b, c … count from 0."""
    names = tuple(Iri(f"x:{letter}") for letter in "abcdefgh"[: len(sizes)])
    return Product(names, tuple(tuple(range(size)) for size in sizes))


def selected(wanted: Wanted, *variations: Product | Table) -> list[tuple[Cell, ...]]:
    variants = [variant(variation, f"v{index}") for index, variation in enumerate(variations)]
    found = Selected(MODEL, variants, wanted)
    rows = [tuple(values.values()) for one in variants for _, values in found.scenarios(one)]
    assert found.total in (None, len(rows))
    return rows


def counting(size: int) -> tuple[Cell, ...] | Selection:
    return tuple(range(size))


CHOICES: st.SearchStrategy[tuple[Cell, ...] | Selection] = st.builds(counting, st.integers(1, 4)) | st.builds(
    Selection,
    st.sampled_from(["combinations", "permutations"]),
    st.integers(0, 4).map(lambda size: tuple(range(size))),
    st.integers(1, 3),
    st.booleans(),
)


@given(st.lists(CHOICES, min_size=1, max_size=3))
def test_a_scenario_is_found_by_its_number(choices: list[tuple[Cell, ...] | Selection]) -> None:
    variation = Product(tuple(Iri(f"x:{index}") for index in range(len(choices))), tuple(choices))
    assert [at(variation, index) for index in range(count(variation))] == list(bindings(variation))
    with pytest.raises(IndexError):
        at(variation, count(variation))


def test_the_first_are_counted_over_all_variants() -> None:
    assert selected(Wanted(first=5), numbers(3), numbers(2, 2)) == [(0,), (1,), (2,), (0, 0), (0, 1)]
    assert selected(Wanted(first=2, where="a=2 or b=1"), numbers(3), numbers(2, 2)) == [(2,), (0, 1)]


def test_scenarios_keep_the_numbers_that_they_have_among_all() -> None:
    one = variant(numbers(3, 3))
    assert [number for number, _ in Selected(MODEL, [one], Wanted(where="b=2")).scenarios(one)] == [3, 6, 9]
    assert [number for number, _ in Selected(MODEL, [one], Wanted(sample=9)).scenarios(one)] == list(range(1, 10))


@pytest.mark.parametrize("where", [None, "a>=0"])
def test_every_sample_is_equally_likely(where: str | None) -> None:
    drawn = Counter(
        frozenset(selected(Wanted(where=where, sample=2, seed=seed), numbers(2), numbers(1, 2))) for seed in range(1200)
    )
    assert len(drawn) == 6
    # 200 of each are expected; the standard deviation is 13.
    assert all(140 < times < 260 for times in drawn.values())


def test_a_sample_depends_on_its_seed_alone_and_never_exceeds_what_there_is() -> None:
    assert selected(Wanted(sample=5, seed=7), numbers(100)) == selected(Wanted(sample=5, seed=7), numbers(100))
    assert selected(Wanted(sample=5, seed=7), numbers(100)) != selected(Wanted(sample=5, seed=8), numbers(100))
    assert selected(Wanted(sample=50), numbers(3)) == [(0,), (1,), (2,)]
    assert selected(Wanted(sample=50, where="a<2"), numbers(3)) == [(0,), (1,)]


def test_a_sample_of_a_huge_variation_does_not_go_through_it() -> None:
    huge = Product((Iri("x:a"),), (Selection("permutations", tuple(range(40)), 20, False),))
    assert len(selected(Wanted(sample=100), huge, numbers(3))) == 100


def occurring(rows: Sequence[tuple[Cell, ...]], strength: int) -> set[object]:
    return {combined for row in rows for combined in combinations(enumerate(row), strength)}


@settings(max_examples=60)
@given(st.lists(st.integers(1, 4), min_size=1, max_size=4), st.sampled_from([2, 3]), st.integers(0, 3))
def test_every_combination_that_fits_is_covered(sizes: list[int], strength: int, limit: int) -> None:
    every = list(product(*map(range, sizes)))
    strength_there = min(strength, len(sizes))
    for where, fitting in (
        (None, every),
        (f"a<={limit} and not a=1", [row for row in every if row[0] <= limit and row[0] != 1]),
    ):
        for variation in (numbers(*sizes), Table(numbers(*sizes).variables, tuple(every))):
            found = selected(Wanted(where=where, strength=strength), variation)
            assert set(found) <= set(fitting)
            assert occurring(found, strength_there) == occurring(fitting, strength_there)


def test_a_covering_array_is_much_smaller_than_the_product_and_says_what_it_covers() -> None:
    one = variant(numbers(*[5] * 6))
    pairs, triples = (Selected(MODEL, [one], Wanted(strength=strength)) for strength in (2, 3))
    assert (pairs.covers[one.iri].covered, pairs.covers[one.iri].possible) == (15 * 25, 15 * 25)
    assert (triples.covers[one.iri].covered, triples.covers[one.iri].possible) == (20 * 125, 20 * 125)
    assert len(list(pairs.scenarios(one))) < 60
    assert len(list(triples.scenarios(one))) < 350


def test_combinations_of_a_variable_with_too_many_values_are_refused() -> None:
    huge = Product((Iri("x:a"), Iri("x:b")), (Selection("permutations", tuple(range(40)), 20, False), (1, 2)))
    with pytest.raises(SelectionError, match="variable 'a' has"):
        selected(Wanted(strength=2), huge)


def test_an_empty_variation_gives_nothing() -> None:
    for wanted in (Wanted(), Wanted(first=1), Wanted(sample=1), Wanted(strength=2), Wanted(where="a=1")):
        assert selected(wanted, numbers(0, 2)) == []


def test_generation_is_lazy() -> None:
    huge = variant(Product((Iri("x:a"),), (Selection("permutations", tuple(range(40)), 20, False),)))
    assert len(list(islice(Selected(MODEL, [huge], Wanted()).scenarios(huge), 3))) == 3


def test_a_sample_may_come_from_a_variant_far_behind() -> None:
    sizes = [numbers(1), numbers(0), numbers(1), numbers(60)]
    assert len(selected(Wanted(sample=40), *sizes)) == 40


def test_a_single_variable_is_covered_by_each_of_its_values() -> None:
    assert selected(Wanted(strength=1), numbers(3)) == [(0,), (1,), (2,)]
    found = selected(Wanted(strength=1), numbers(2, 3))
    assert ({row[0] for row in found}, {row[1] for row in found}, len(found)) == ({0, 1}, {0, 1, 2}, 3)
