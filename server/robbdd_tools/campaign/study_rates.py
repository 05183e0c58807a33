"""Pass rates of a study by the levels of its factors and of its scenarios' variables."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.campaign.factor_rates import LevelRate
from robbdd_tools.run.report import value_words

if TYPE_CHECKING:
    from robbdd_tools.run.study_store import CombinationCount


def study_rates(counts: Iterable[CombinationCount]) -> list[list[LevelRate]]:
    """Return the rates of each factor that has several levels. The first entry is the rate of all executions."""
    overall = LevelRate("all executions")
    factors: dict[str, dict[str, LevelRate]] = {}
    for count in counts:
        total = count.holds + count.violated + count.unknown
        found = [overall]
        for factor, level, words in _levels(count):
            found.append(factors.setdefault(factor, {}).setdefault(level, LevelRate(words)))
        for rate in found:
            rate.total += total
            rate.holding += count.holds
    return [[overall], *(list(levels.values()) for levels in factors.values() if len(levels) > 1)]


def _levels(count: CombinationCount) -> Iterator[tuple[str, str, str]]:
    yield "variant", count.variant, value_words("variant", count.name.rpartition(" -- ")[0])
    for name, value in count.levels.items():
        yield f"variable {name}", json.dumps(value, sort_keys=True), value_words(name, value)
