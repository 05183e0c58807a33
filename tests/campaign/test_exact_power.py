"""Powers of exact tests, against tests of every possible outcome by SciPy and statsmodels."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import pytest

from robbdd_tools.campaign.exact_power import executions_to_show, paired_power, pairs_to_show, separate_power
from robbdd_tools.campaign.rates import executions_needed, pairs_needed

STATS: Any = import_module("scipy.stats")
TABLES: Any = import_module("statsmodels.stats.contingency_tables")


@pytest.mark.parametrize("pairs", [1, 5, 6, 11])
@pytest.mark.parametrize(("discordance", "difference"), [(1.0, -1.0), (0.9, -0.9), (0.6, 0.4), (0.3, 0.0)])
def test_the_power_of_pairs_is_that_of_all_outcomes(pairs: int, discordance: float, difference: float) -> None:
    gained, lost = (discordance + difference) / 2, (discordance - difference) / 2
    outcomes = STATS.multinomial(pairs, [gained, lost, 1 - gained - lost])
    expected = sum(
        outcomes.pmf([won, gone, pairs - won - gone])
        for won in range(pairs + 1)
        for gone in range(pairs + 1 - won)
        if TABLES.mcnemar([[0, won], [gone, 0]], exact=True).pvalue <= 0.05
    )
    assert paired_power(pairs, discordance, difference) == pytest.approx(expected)


@pytest.mark.parametrize("count", [1, 3, 4, 9])
@pytest.mark.parametrize(("rate", "other"), [(1.0, 0.0), (0.9, 0.3), (0.5, 0.5)])
def test_the_power_of_two_runs_is_that_of_all_outcomes(count: int, rate: float, other: float) -> None:
    expected = sum(
        STATS.binom.pmf(one, count, rate) * STATS.binom.pmf(two, count, other)
        for one in range(count + 1)
        for two in range(count + 1)
        if STATS.fisher_exact([[one, count - one], [two, count - two]]).pvalue <= 0.05
    )
    assert separate_power(count, rate, other) == pytest.approx(expected)


def test_few_executions_are_enough_for_the_exact_tests() -> None:
    """Fewer than 6 flips, or 4 executions of each run, never reject at 5 %."""
    assert (pairs_to_show(1.0, -1.0), executions_to_show(1.0, -1.0)) == (6, 4)
    assert paired_power(pairs_to_show(0.9, -0.9), 0.9, -0.9) >= 0.8
    assert separate_power(executions_to_show(0.9, -0.5), 0.9, 0.4) >= 0.8


def test_many_executions_are_planned_by_the_formulas() -> None:
    assert pairs_to_show(0.15, -0.05) == pairs_needed(0.15, -0.05)
    assert executions_to_show(0.9, -0.05) == executions_needed(0.9, -0.05)
