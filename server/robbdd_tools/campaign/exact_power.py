"""Power of the exact tests of a comparison, for numbers of executions that are too small for normal approximations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.campaign.rates import LEVEL, executions_needed, pairs_needed, statistics

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

_TIE = 1.0 + 1e-7
"""Outcomes whose probabilities differ by less than this factor are equally probable, as in SciPy's test."""
FEW = 100
"""From this number of executions on, the formulas are used alone."""


def pairs_to_show(discordance: float, difference: float, power: float = 0.8, level: float = LEVEL) -> int:
    """Return how many pairs a comparison needs to show a difference, as ``pairs_needed``, exact if they are few."""
    count = pairs_needed(discordance, difference, power, level)
    while count < FEW and paired_power(count, discordance, difference, level) < power:
        count += 1
    return count


def executions_to_show(rate: float, difference: float, power: float = 0.8, level: float = LEVEL) -> int:
    """Return how many executions each of two runs needs, as ``executions_needed``, exact if they are few."""
    count = executions_needed(rate, difference, power, level)
    while count < FEW and separate_power(count, rate, rate + difference, level) < power:
        count += 1
    return count


def paired_power(pairs: int, discordance: float, difference: float, level: float = LEVEL) -> float:
    """Return the probability that McNemar's exact test of ``pairs`` rejects.

    ``discordance`` is the share of pairs that flip, ``difference`` that of gains minus that of losses.
    """
    import numpy as np

    binom: Any = statistics().binom
    flips = np.arange(1, pairs + 1)
    # The most flips in one direction for which the test of so many flips rejects, -1 if it never does.
    quantile: Any = binom.ppf((1.0 - level) / 2.0, flips, 0.5)
    few = quantile - (2.0 * binom.cdf(quantile, flips, 0.5) > 1.0 - level)
    gains = (discordance + difference) / (2.0 * discordance)
    rejected = binom.cdf(few, flips, gains) + binom.sf(flips - few - 1, flips, gains)
    return float(np.sum(binom.pmf(flips, pairs, discordance) * rejected))


def separate_power(count: int, rate: float, other: float, level: float = LEVEL) -> float:
    """Return the probability that Fisher's exact test of two runs with ``count`` executions each rejects.

    ``rate`` and ``other`` are their true pass rates.
    """
    import numpy as np

    stats, held = statistics(), np.arange(count + 1)
    first_run, second_run = (stats.binom.pmf(held, count, true) for true in (rate, other))
    joint: Any = first_run[:, np.newaxis] * second_run
    total = 0.0
    for holding in range(2 * count + 1):
        first = np.arange(max(0, holding - count), min(holding, count) + 1)
        chances: FloatArray = stats.hypergeom.pmf(first, 2 * count, holding, count)
        values = np.array([chances[chances <= one * _TIE].sum() for one in chances])
        total += float(joint[first, holding - first][values <= 1.0 - level].sum())
    return total
