"""The pass rates of a run with many scenarios, as lines of its report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.printable import printable
from robbdd_tools.campaign.factor_rates import LevelRate, factor_rates
from robbdd_tools.monitor.verdict import Outcome

if TYPE_CHECKING:
    from robbdd_tools.run.results import ScenarioResult

MANY = 50
"""A run of more scenarios prints rates and failures instead of every clause."""
MAX_LEVELS = 10
"""Maximum number of levels that are listed for one factor."""


def rate_lines(scenarios: Sequence[ScenarioResult], total: int) -> list[str]:
    """Return the pass rate of all scenarios, then the pass rates of each factor with several levels.

    If ``scenarios`` are only those of ``total`` scenarios that have finished, the first line says so.
    If a factor has more than ``MAX_LEVELS`` levels, only those with the lowest rates are listed.
    """
    if not scenarios:
        return []
    held = sum(one.verdict is Outcome.HOLDS for one in scenarios)
    some = f"{len(scenarios):,} of {total:,} scenarios, the others have not finished"
    words = some if len(scenarios) < total else "all scenarios"
    lines = [level_line(LevelRate(words, held, len(scenarios)))]
    for levels in factor_rates(scenarios):
        lines += level_lines(levels)
    return lines


def level_lines(levels: Sequence[LevelRate]) -> list[str]:
    """Return the rates of one factor's levels; if there are more than ``MAX_LEVELS`` levels, only the lowest rates."""
    shown = levels if len(levels) <= MAX_LEVELS else sorted(levels, key=lambda one: one.share)[:MAX_LEVELS]
    lines = [f"  {level_line(level)}" for level in shown]
    if len(shown) < len(levels):
        lines.append(f"  … and {len(levels) - len(shown)} more levels with rates that are not lower")
    return lines


def level_line(level: LevelRate) -> str:
    """Return the rate of one level as a line."""
    found = level.interval()
    interval = "" if found is None else f"; 95 % interval {100 * found.low:.1f} % to {100 * found.high:.1f} %"
    share = f"{100 * level.share:.1f} %"
    return f"{printable(level.words)}: {level.holding} of {level.total} hold ({share}{interval})"
