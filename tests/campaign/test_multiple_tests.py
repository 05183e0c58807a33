"""The level of several tests together is kept, and tests that cannot reject cost nothing."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from typing import Any

import pytest

from campaign.executed import executions
from robbdd_tools.campaign.multiple_tests import Test, corrected
from robbdd_tools.campaign.rates import paired_probability, pairs_needed
from robbdd_tools.campaign.run_comparison import Change, ComparisonOptions, compare_results


@pytest.mark.parametrize("values", [[0.01, 0.04, 0.03], [0.5], [0.2, 0.2, 0.001, 0.9], [0.0, 1.0, 0.0499]])
def test_without_exact_tests_it_is_holms_method(values: list[float]) -> None:
    library: Any = import_module("statsmodels.stats.multitest")
    expected = library.multipletests(values, method="holm")[1]
    assert corrected([Test(value) for value in values], 0.05) == pytest.approx(list(expected))


def test_tests_that_cannot_reject_are_not_counted() -> None:
    hopeless = [Test(1.0, 1.0)] * 9
    assert corrected([Test(0.02, 0.001), *hopeless], 0.05) == [0.02, *[1.0] * 9]
    # The second could reject alone, but not after a correction for both.
    assert corrected([Test(0.02, 0.001), Test(0.04, 0.04)], 0.05) == [0.02, 1.0]
    assert corrected([Test(0.02, 0.001), Test(0.04, 0.025)], 0.05) == [0.04, 0.04]


def test_tests_of_the_same_data_are_one_test() -> None:
    same = Test(0.03, 0.001, "same")
    assert corrected([same, same], 0.05) == [0.03, 0.03]
    assert corrected([same, Test(0.03, 0.001, "other")], 0.05) == [0.06, 0.06]


def drawn(chance: random.Random, count: int, flips: float, drop: float) -> tuple[list[float], list[float]]:
    """Margins of pairs. A share of them flips, more for the worse than for the better by ``drop``; 90 % hold before."""
    lost, gained = (flips + drop) / 2, (flips - drop) / 2
    before: list[float] = []
    after: list[float] = []
    for _ in range(count):
        held = chance.random() < 0.9
        flipped = chance.random() < (lost / 0.9 if held else gained / 0.1)
        before.append(0.1 if held else -0.1)
        after.append(0.1 if held != flipped else -0.1)
    return before, after


def found_worse(pairs: tuple[Sequence[float], Sequence[float]], *, by_margin: bool = False) -> bool:
    """Whether a comparison of runs with ten clauses, of which one flips, calls that clause worse."""
    others = {f"c{number}": [0.1] * len(pairs[0]) for number in range(9)}
    before, after = (executions({"tested": side, **others}) for side in pairs)
    found = compare_results(before, after, ComparisonOptions(by_margin=by_margin))
    return next(one.change for one in found.effects if one.name == "tested") is Change.WORSE


@cache
def power_of_mcnemar(count: int, flips: float, drop: float) -> float:
    """The exact power of McNemar's exact test at 5 %, by adding the probabilities of all numbers of flips."""
    binom: Any = import_module("scipy.stats").binom
    total = 0.0
    for flipped in range(count + 1):
        share = float(binom.pmf(flipped, count, flips))
        if share > 1e-10:
            rejected = [lost for lost in range(flipped // 2 + 1, flipped + 1) if _rejects(flipped - lost, lost)]
            total += share * float(sum(binom.pmf(rejected, flipped, (flips + drop) / (2 * flips))))
    return total


def _rejects(gained: int, lost: int) -> bool:
    return paired_probability(gained, lost) <= 0.05


@pytest.mark.parametrize("flips", [0.06, 0.08, 0.1, 0.15])
def test_the_planned_number_of_pairs_is_within_a_tenth_of_what_the_exact_test_needs(flips: float) -> None:
    planned = pairs_needed(flips, -0.05)
    assert power_of_mcnemar(planned, flips, 0.05) > 0.75
    assert power_of_mcnemar(round(1.1 * planned), flips, 0.05) >= 0.8


@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=pytest.mark.nightly)])
def test_ten_clauses_need_no_more_executions_than_mcnemars_test(count: int) -> None:
    """A drop of 5 points from 90 %, with 8 % flips: the power of a whole comparison is that of the test alone."""
    chance, pairs = random.Random(count), round(1.1 * pairs_needed(0.08, -0.05))
    shown = sum(found_worse(drawn(chance, pairs, 0.08, 0.05)) for _ in range(count))
    print(
        f"{shown} of {count} comparisons of {pairs} pairs show the drop; McNemar alone: "
        f"{power_of_mcnemar(pairs, 0.08, 0.05):.3f}"
    )
    assert shown / count >= 0.8 - 3 * (0.8 * 0.2 / count) ** 0.5


def margins_drawn(chance: random.Random, count: int, noise: float) -> tuple[list[float], list[float]]:
    """Margins in mm of which 90 % are above 0 before, and 85 % after a shift; ``noise`` differs within a pair."""
    shift = 1.2816 - 1.0364  # quantiles of the normal distribution: 90 % and 85 %
    shared = (1 - noise**2) ** 0.5
    pairs = [(chance.gauss(0, 1), chance.gauss(0, 1), chance.gauss(0, 1)) for _ in range(count)]
    before = [1.2816 + shared * common + noise * one for common, one, _ in pairs]
    after = [1.2816 - shift + shared * common + noise * other for common, _, other in pairs]
    return before, after


@pytest.mark.parametrize("count", [40, pytest.param(400, marks=pytest.mark.nightly)])
def test_margins_need_a_fraction_of_the_executions(count: int) -> None:
    """Margins in pairs that share half of their variance show the drop with a third of the executions of pass rates."""
    chance, noise = random.Random(1), 0.5**0.5
    drawn_pairs = margins_drawn(chance, 20_000, noise)
    flips = sum((old > 0) != (new > 0) for old, new in zip(*drawn_pairs, strict=True)) / 20_000
    planned = pairs_needed(flips, -0.05)
    few = planned // 3
    shown = sum(found_worse(margins_drawn(chance, few, noise), by_margin=True) for _ in range(count))
    print(f"{100 * flips:.1f} % of pairs flip: {planned} pairs by pass rates; {shown} of {count} with {few} by margins")
    assert shown / count >= 0.8 - 3 * (0.8 * 0.2 / count) ** 0.5
