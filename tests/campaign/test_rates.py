"""Intervals, tests and numbers of executions agree with another library, with published values or with counting."""

from __future__ import annotations

from importlib import import_module
from itertools import product
from math import comb
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.campaign import rates
from robbdd_tools.campaign.rates import (
    executions_needed,
    paired_interval,
    paired_probability,
    pairs_needed,
    rate_interval,
    separate_interval,
    separate_probability,
)

contingency: Any = import_module("statsmodels.stats.contingency_tables")
proportion: Any = import_module("statsmodels.stats.proportion")
counts = st.integers(1, 60).flatmap(lambda total: st.tuples(st.integers(0, total), st.just(total)))


@given(counts, st.sampled_from([0.9, 0.95, 0.99]), st.booleans())
def test_the_interval_of_a_rate_is_that_of_an_independent_library(
    counted: tuple[int, int], level: float, exact: bool
) -> None:
    found = rate_interval(*counted, level, exact=exact)
    expected = proportion.proportion_confint(*counted, alpha=1 - level, method="beta" if exact else "wilson")
    assert (found.low, found.high) == pytest.approx(expected, abs=1e-9)


@given(counts, counts)
def test_the_interval_of_two_samples_is_that_of_an_independent_library(
    before: tuple[int, int], after: tuple[int, int]
) -> None:
    found = separate_interval(before, after)
    low, high = proportion.confint_proportions_2indep(*after, *before, method="newcomb", compare="diff")
    assert (found.low, found.high) == pytest.approx((low, high), abs=1e-9)


@given(st.integers(0, 40), st.integers(0, 40))
def test_flips_are_tested_as_in_an_independent_library(gained: int, lost: int) -> None:
    if gained + lost:
        expected = float(contingency.mcnemar([[0, gained], [lost, 0]], exact=True).pvalue)
        assert paired_probability(gained, lost) == pytest.approx(expected)
    else:
        assert paired_probability(0, 0) == 1.0


def test_fishers_test_of_a_lady_tasting_tea() -> None:
    # R. A. Fisher, The Design of Experiments, 1935: all eight cups right has probability 1/70 in one direction.
    assert separate_probability((4, 4), (0, 4)) == pytest.approx(2 / 70)


@pytest.mark.parametrize("rate", [(0.02, 0.02), (0.1, 0.05), (0.3, 0.3), (0.0, 0.1)])
def test_the_paired_interval_contains_the_true_change_as_often_as_it_says(rate: tuple[float, float]) -> None:
    pairs, (gain, loss) = 40, rate
    covered = 0.0
    for gained, lost in product(range(pairs + 1), repeat=2):
        if gained + lost <= pairs:
            ways = comb(pairs, gained) * comb(pairs - gained, lost)
            probability = ways * gain**gained * loss**lost * (1 - gain - loss) ** (pairs - gained - lost)
            interval = paired_interval(gained, lost, pairs)
            covered += probability * (interval.low <= gain - loss <= interval.high)
    assert covered >= 0.94


@given(st.integers(0, 40), st.integers(0, 40), st.integers(0, 100))
def test_the_paired_interval_leaves_out_no_change_where_mcnemars_score_does(gained: int, lost: int, rest: int) -> None:
    interval = paired_interval(gained, lost, gained + lost + rest) if gained + lost + rest else paired_interval(0, 0, 0)
    score = abs(gained - lost) / (gained + lost) ** 0.5 if gained + lost else 0.0
    assert (interval.low > 0.0 or interval.high < 0.0) == (score > 1.959964)


def test_without_executions_nothing_is_known() -> None:
    assert rate_interval(0, 0) == rates.Interval(0.0, 1.0)
    assert paired_interval(0, 0, 0) == separate_interval((0, 0), (1, 1)) == rates.Interval(-1.0, 1.0)


def test_the_number_of_pairs_is_that_of_the_formula() -> None:
    # Flips in 15 of 100 pairs, a drop of 5 points, power 80 %: (1.95996 √0.15 + 0.84162 √(0.15 − 0.0025))² / 0.0025.
    assert pairs_needed(0.15, -0.05) == 469
    assert pairs_needed(0.15, 0.05, power=0.9) > 469 > pairs_needed(0.3, 0.1)


def test_the_number_of_executions_of_two_runs_is_that_of_a_table() -> None:
    # Fleiss, Levin and Paik, Statistical Methods for Rates and Proportions, 3rd edition, section 4.3: 686 to show that
    # 90 % dropped to 85 % (without continuity correction, power 80 %).
    assert executions_needed(0.9, -0.05) == 686


@pytest.mark.parametrize(("discordance", "difference"), [(0.1, 0.0), (0.1, 0.2), (1.2, 0.1)])
def test_impossible_changes_need_no_number_of_pairs(discordance: float, difference: float) -> None:
    with pytest.raises(ValueError, match="share of pairs"):
        pairs_needed(discordance, difference)
    with pytest.raises(ValueError, match="pass rates"):
        executions_needed(1.0, 0.1)
