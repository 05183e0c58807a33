"""Pass rates of a study by the levels of its factors and of its scenarios' variables."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.campaign.factor_rates import LevelRate
from robbdd_tools.campaign.value_bins import bins_of, in_order
from robbdd_tools.run.report import value_words, variable_word

if TYPE_CHECKING:
    from robbdd_tools.campaign.value_bins import Bins
    from robbdd_tools.run.study_reader import CombinationCount


def study_rates(counts: Iterable[CombinationCount]) -> list[list[LevelRate]]:
    """Return the rate of all executions, then the rates of each factor that has several levels.

    Many numeric values of a variable are grouped by ``value_bins``.
    """
    counts = list(counts)
    bins = bins_of(count.levels for count in counts)
    overall = LevelRate("all executions")
    factors: dict[str, dict[str, LevelRate]] = {}
    for count in counts:
        total = count.holds + count.violated + count.unknown
        found = [overall]
        for factor, level, words in _levels(count, bins):
            found.append(factors.setdefault(factor, {}).setdefault(level, LevelRate(words)))
        for rate in found:
            rate.total += total
            rate.holding += count.holds
    ordered = [
        [levels[level] for level in in_order(levels, bins.get(name.removeprefix("variable ")))]
        for name, levels in factors.items()
    ]
    return [[overall], *(levels for levels in ordered if len(levels) > 1)]


def _levels(count: CombinationCount, bins: Mapping[str, Bins]) -> Iterator[tuple[str, str, str]]:
    yield "variant", count.variant, value_words("variant", count.name.rpartition(" -- ")[0])
    for name, value in count.levels.items():
        if name in bins:
            part = bins[name].word(value)
            yield f"variable {name}", part, f"{variable_word(name)} {part}"
            continue
        yield f"variable {name}", json.dumps(value, sort_keys=True), value_words(name, value)
