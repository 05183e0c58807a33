"""Pass rates of a run by the levels of its factors: stories' variants, executions and variables."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robbdd_tools.campaign.rates import Interval, StatisticsNotInstalled, rate_interval
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.report import value_words

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.run.results import ScenarioResult


@dataclass(slots=True)
class LevelRate:
    """The scenarios with one level of a factor.

    ``words`` names factor and level. ``holding`` does not count unknown scenarios.
    """

    words: str
    holding: int = 0
    total: int = 0

    @property
    def share(self) -> float:
        """The pass rate."""
        return self.holding / self.total

    def interval(self) -> Interval | None:
        """Return Wilson's 95 % interval of the pass rate; ``None`` if SciPy is not installed."""
        try:
            return rate_interval(self.holding, self.total)
        except StatisticsNotInstalled:
            return None


def factor_rates(scenarios: Iterable[ScenarioResult]) -> list[list[LevelRate]]:
    """Return the rates of each factor that has several levels, in the order of the scenarios.

    Scenarios without a variable do not count in the levels of that variable.
    """
    factors: dict[str, dict[str, LevelRate]] = {}
    for scenario in scenarios:
        for factor, level, words in _levels(scenario.spec):
            # Different IRIs may have the same words, so the level is the key.
            found = factors.setdefault(factor, {}).setdefault(level, LevelRate(words))
            found.total += 1
            found.holding += scenario.verdict is Outcome.HOLDS
    return [list(levels.values()) for levels in factors.values() if len(levels) > 1]


def _levels(spec: ScenarioSpec) -> Iterator[tuple[str, str, str]]:
    yield "variant", spec.variant, value_words("variant", spec.name.rpartition(" -- ")[0])
    if spec.execution is not None:
        yield "execution", spec.execution.iri, value_words("execution", spec.execution.name)
    for name, value in spec.values.items():
        yield f"variable {name}", _key(value), value_words(name, value)


def _key(value: Any) -> str:
    return json.dumps(value, sort_keys=True)
