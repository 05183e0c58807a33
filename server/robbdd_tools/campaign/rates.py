"""Pass rates, their differences, and the confidence intervals of both."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError

if TYPE_CHECKING:
    from types import ModuleType

LEVEL = 0.95
"""Default confidence level of an interval."""
_EDGE = 1e-12
"""Distance that is kept from a change at which the statistic is not defined."""
_remembered = lru_cache(maxsize=10_000)
"""Of a function of counts: a study's tables and a comparison's clauses ask for the same ones again and again."""


class StatisticsNotInstalled(RobbddError):
    """SciPy is not installed."""

    def __init__(self) -> None:
        super().__init__("SciPy is not installed: pip install 'robbdd-tools[statistics]'")


@dataclass(frozen=True, slots=True)
class Interval:
    """A confidence interval from ``low`` to ``high``."""

    low: float
    high: float

    def hull(self, other: Interval) -> Interval:
        """Return the smallest interval that contains both."""
        return Interval(min(self.low, other.low), max(self.high, other.high))


def statistics() -> ModuleType:
    """Return ``scipy.stats``. Raises ``StatisticsNotInstalled``."""
    return _module("scipy.stats")


def _module(name: str) -> ModuleType:
    try:
        return import_module(name)
    except ImportError as error:
        raise StatisticsNotInstalled from error


@_remembered
def rate_interval(holding: int, total: int, level: float = LEVEL, *, exact: bool = False) -> Interval:
    """Return the interval of a pass rate: Wilson's (1927), or with ``exact`` that of Clopper and Pearson (1934).

    Without executions it is 0 to 1.
    """
    if total == 0:
        return Interval(0.0, 1.0)
    found = statistics().binomtest(holding, total).proportion_ci(level, "exact" if exact else "wilson")
    return Interval(float(found.low), float(found.high))


@_remembered
def paired_interval(gained: int, lost: int, pairs: int, level: float = LEVEL) -> Interval:
    """Return the interval of the difference of two pass rates of the same ``pairs`` of executions.

    ``gained`` pairs hold only in the second run, ``lost`` pairs only in the first one. The interval consists of the
    changes that the score test of Tango (1998, Statistics in Medicine 17) does not reject.
    """
    if pairs == 0:
        return Interval(-1.0, 1.0)
    reach, middle = _quantile(level), (gained - lost) / pairs

    def beyond(target: float) -> Callable[[float], float]:
        return lambda change: _score(change, gained, lost, pairs) - target

    low = (
        middle
        if middle == -1.0
        else float(_module("scipy.optimize").brentq(beyond(reach), -1.0 + _EDGE, middle + _EDGE))
    )
    high = (
        middle
        if middle == 1.0
        else float(_module("scipy.optimize").brentq(beyond(-reach), middle - _EDGE, 1.0 - _EDGE))
    )
    return Interval(low, high)


def _score(change: float, gained: int, lost: int, pairs: int) -> float:
    """Return Tango's statistic for a true change: its distance from the observed one in standard errors."""
    # If this change is the true one, the most likely share of losses solves 2n x² + linear x + constant = 0.
    linear = (2 * pairs - gained + lost) * change - gained - lost
    constant = -lost * change * (1.0 - change)
    losses = (math.sqrt(max(0.0, linear**2 - 8 * pairs * constant)) - linear) / (4 * pairs)
    variance = pairs * (2.0 * losses + change * (1.0 - change))
    return (gained - lost - pairs * change) / math.sqrt(max(variance, _EDGE))


@_remembered
def paired_probability(gained: int, lost: int) -> float:
    """Return the p-value of McNemar's exact test that gains and losses are equally probable; 1 without flips."""
    if gained + lost == 0:
        return 1.0
    return float(statistics().binomtest(gained, gained + lost).pvalue)


def separate_interval(before: tuple[int, int], after: tuple[int, int], level: float = LEVEL) -> Interval:
    """Return the interval of the difference of the pass rates of two independent runs: Newcombe (1998), method 10.

    Each run is given as the number of executions that hold, and of all executions.
    """
    if before[1] == 0 or after[1] == 0:
        return Interval(-1.0, 1.0)
    first, second = rate_interval(*before, level), rate_interval(*after, level)
    old, new = before[0] / before[1], after[0] / after[1]
    low = math.hypot(new - second.low, first.high - old)
    high = math.hypot(second.high - new, old - first.low)
    return Interval(new - old - low, new - old + high)


@_remembered
def separate_probability(before: tuple[int, int], after: tuple[int, int]) -> float:
    """Return the p-value of Fisher's exact test that two independent runs have the same pass rate."""
    table = [[count, total - count] for count, total in (before, after)]
    return float(statistics().fisher_exact(table).pvalue)


def executions_for_width(rate: float, width: float, level: float = LEVEL) -> int:
    """Return how many executions make Wilson's interval of a pass rate at most ``width`` wide, if ``rate`` is observed.

    Raises ``ValueError`` for numbers that are no shares.
    """
    if not 0.0 <= rate <= 1.0 or not 0.0 < width < 1.0:
        raise ValueError("the pass rate has to be from 0 to 1, and the width between 0 and 1")
    reach, spread = _quantile(level) ** 2, rate * (1.0 - rate)
    # width² (n + z²)² = 4 z² (rate (1 - rate) n + z² / 4), solved for n.
    linear = reach * (width**2 - 2.0 * spread)
    constant = reach**2 * (width**2 - 1.0)
    return max(1, math.ceil((math.sqrt(linear**2 - width**2 * constant) - linear) / width**2 - _EDGE))


def pairs_needed(discordance: float, difference: float, power: float = 0.8, level: float = LEVEL) -> int:
    """Return how many pairs of executions McNemar's test needs to show a difference of pass rates (Connor 1987).

    ``discordance`` is the share of pairs that flip in either direction. Raises ``ValueError`` unless the size of
    ``difference`` is above 0 and at most ``discordance``, which is at most 1.
    """
    drop = abs(difference)
    if not 0.0 < drop <= discordance <= 1.0:
        raise ValueError("the difference has to be above 0 and not above the share of pairs that flip")
    spread = _quantile(level) * math.sqrt(discordance)
    spread += float(statistics().norm.ppf(power)) * math.sqrt(discordance - drop**2)
    return math.ceil((spread / drop) ** 2)


def executions_needed(rate: float, difference: float, power: float = 0.8, level: float = LEVEL) -> int:
    """Return how many executions each of two independent runs needs to show that a pass rate moved by ``difference``.

    Normal approximation for two proportions (Fleiss, Levin and Paik 2003, equation 4.14, without correction).
    Raises ``ValueError`` unless both rates are from 0 to 1 and differ.
    """
    other = rate + difference
    if difference == 0.0 or not 0.0 <= rate <= 1.0 or not 0.0 <= other <= 1.0:
        raise ValueError("both pass rates have to be from 0 to 1, and to differ")
    middle = (rate + other) / 2
    spread = _quantile(level) * math.sqrt(2 * middle * (1 - middle))
    spread += float(statistics().norm.ppf(power)) * math.sqrt(rate * (1 - rate) + other * (1 - other))
    return math.ceil((spread / difference) ** 2)


def _quantile(level: float) -> float:
    """Return the quantile of the normal distribution at the bound of a two-sided interval."""
    return float(statistics().norm.ppf(0.5 + level / 2))
