"""The effect of a change on one clause: how its pass rate and its margin differ, with intervals and p-values."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import comb
from statistics import fmean
from typing import TYPE_CHECKING

from robbdd_tools.campaign.rates import (
    Interval,
    paired_interval,
    paired_probability,
    separate_interval,
    separate_probability,
    statistics,
)
from robbdd_tools.monitor.verdict import Outcome

if TYPE_CHECKING:
    from robbdd_tools.campaign.matched_executions import Judged, MatchedClause


@dataclass(frozen=True, slots=True)
class Rate:
    """How many of ``total`` executions hold, and how many are unknown."""

    holding: int
    unknown: int
    total: int


@dataclass(frozen=True, slots=True)
class RateEffect:
    """The change of a pass rate: the share of executions that hold after, minus that before.

    - ``difference``: without the unknown executions; ``None`` if all are unknown.
    - ``interval``: contains the true change whatever the unknown executions would have been.
    - ``gained``, ``lost``: executions that hold only after, or only before; known verdicts of the same scenarios.
    - ``worse``, ``better``: p-values of the tests against no change, with the unknown executions counted as speaks
      against that result.
    - ``least_worse``, ``least_better``: the smallest p-values that these tests could have with as many flips, or with
      as many executions that hold.
    """

    difference: float | None
    interval: Interval
    gained: int
    lost: int
    worse: float
    better: float
    least_worse: float
    least_better: float


@dataclass(frozen=True, slots=True)
class MarginEffect:
    """The change of the mean margin in ``unit`` (SI) over ``executions`` whose margins are known on both sides.

    ``missing`` executions have a margin on one side or on none. ``probability`` is the p-value of the t-test against
    no change: of the differences if the executions are paired, else Welch's.
    """

    unit: str
    executions: int
    missing: int
    difference: float
    interval: Interval
    probability: float


def rate(judged: Sequence[Judged]) -> Rate:
    """Count the verdicts of one run on a clause."""
    counts = Counter(one.verdict for one in judged)
    return Rate(counts[Outcome.HOLDS], counts[Outcome.UNKNOWN], len(judged))


def rate_effect(clause: MatchedClause, level: float, *, paired: bool) -> RateEffect:
    """Return the change of the pass rate of a clause, with an interval of the confidence ``level``."""
    pairs = list(zip(clause.before, clause.after, strict=True))
    # Count each unknown verdict once in favour of the change, and once against it.
    least = [(_holds(old, unknown=True), _holds(new, unknown=False)) for old, new in pairs]
    most = [(_holds(old, unknown=False), _holds(new, unknown=True)) for old, new in pairs]
    interval = _interval(least, level, paired=paired).hull(_interval(most, level, paired=paired))
    known = [
        (_holds(old, unknown=False), _holds(new, unknown=False))
        for old, new in pairs
        if Outcome.UNKNOWN not in (old.verdict, new.verdict)
    ]
    gained, lost = _flips(known)
    return RateEffect(
        (gained - lost) / len(known) if known else None,
        interval,
        gained,
        lost,
        _probability(most, paired=paired) if _change(most) < 0 else 1.0,
        _probability(least, paired=paired) if _change(least) > 0 else 1.0,
        _least_probability(most, paired=paired),
        _least_probability(least, paired=paired),
    )


def margin_effect(clause: MatchedClause, level: float, *, paired: bool) -> MarginEffect | None:
    """Return the change of the mean margin; ``None`` if fewer than two executions have margins in both runs.

    Margins that all move by the same amount have no spread. They show something only if there are so many of them that
    chance would not give them the same direction; it is ``None`` otherwise.
    """
    pairs = [
        (old.margin, new.margin)
        for old, new in zip(clause.before, clause.after, strict=True)
        if old.margin is not None and new.margin is not None
    ]
    if len(pairs) < 2:
        return None
    before, after = [old for old, _ in pairs], [new for _, new in pairs]
    difference = fmean(after) - fmean(before)
    tested = _margin_test(before, after, level, paired=paired)
    if tested is None:
        return None
    interval, probability = tested
    missing = len(clause.before) - len(pairs)
    return MarginEffect(clause.unit, len(pairs), missing, difference, interval, probability)


def _holds(judged: Judged, *, unknown: bool) -> bool:
    return unknown if judged.verdict is Outcome.UNKNOWN else judged.verdict is Outcome.HOLDS


def _flips(pairs: Sequence[tuple[bool, bool]]) -> tuple[int, int]:
    return sum(new and not old for old, new in pairs), sum(old and not new for old, new in pairs)


def _change(pairs: Sequence[tuple[bool, bool]]) -> int:
    gained, lost = _flips(pairs)
    return gained - lost


def _sides(pairs: Sequence[tuple[bool, bool]]) -> tuple[tuple[int, int], tuple[int, int]]:
    return (sum(old for old, _ in pairs), len(pairs)), (sum(new for _, new in pairs), len(pairs))


def _interval(pairs: Sequence[tuple[bool, bool]], level: float, *, paired: bool) -> Interval:
    if paired:
        return paired_interval(*_flips(pairs), len(pairs), level)
    return separate_interval(*_sides(pairs), level)


def _probability(pairs: Sequence[tuple[bool, bool]], *, paired: bool) -> float:
    return paired_probability(*_flips(pairs)) if paired else separate_probability(*_sides(pairs))


def _least_probability(pairs: Sequence[tuple[bool, bool]], *, paired: bool) -> float:
    """Return the smallest p-value with as many flips or, for independent runs, with as many executions that hold."""
    if paired:
        return paired_probability(0, sum(_flips(pairs)))
    (first, total), (second, _) = _sides(pairs)
    holding = first + second
    extremes = {min(holding, total), max(0, holding - total)}
    return min(separate_probability((one, total), (holding - one, total)) for one in extremes)


def _margin_test(
    before: Sequence[float], after: Sequence[float], level: float, *, paired: bool
) -> tuple[Interval, float] | None:
    differences = [new - old for old, new in zip(before, after, strict=True)]
    spread = differences if paired else [*(old - before[0] for old in before), *(new - after[0] for new in after)]
    if len(set(spread)) == 1:
        # There is no spread to estimate. The permutation test needs no spread: all signs, or all sides, are equal.
        moved, count = differences[0], len(differences)
        chance = 0.5 ** (count - 1) if paired else 2.0 / comb(2 * count, count)
        if chance > 1.0 - level and (moved != 0.0 or not paired):
            return None
        return Interval(moved, moved), 1.0 if moved == 0.0 else chance
    stats = statistics()
    with warnings.catch_warnings():
        # SciPy warns of samples whose values are all equal, whose spread is rounding.
        warnings.simplefilter("ignore", RuntimeWarning)
        test = stats.ttest_1samp(differences, 0.0) if paired else stats.ttest_ind(after, before, equal_var=False)
    found = test.confidence_interval(level)
    return Interval(float(found.low), float(found.high)), float(test.pvalue)
