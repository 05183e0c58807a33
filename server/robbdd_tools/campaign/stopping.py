"""Rules that end a study early. They decide from the executions of whole stages."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from robbdd_tools.campaign.rates import LEVEL, rate_interval

ERROR = 1.0 - LEVEL
"""The probability of a wrong decision on a required pass rate, in either direction."""


class Ruling(Enum):
    """The decision of a rule."""

    SHOWN = "shown"
    REFUTED = "refuted"
    PRECISE = "precise"


@dataclass(frozen=True, slots=True)
class UntilWidth:
    """Stop as soon as Wilson's 95 % interval of the pass rate is at most ``width`` wide (0 to 1)."""

    width: float

    def ruling(self, holding: int, total: int) -> Ruling | None:
        """Return the decision from the executions so far; ``None`` if more executions are needed."""
        if total == 0:
            return None
        found = rate_interval(holding, total)
        return Ruling.PRECISE if found.high - found.low <= self.width else None

    def words(self, ruling: Ruling | None) -> str:
        """Return the decision in words."""
        if ruling is None:
            return f"the interval is still wider than {100 * self.width:g} points"
        return f"stopped early: the interval is at most {100 * self.width:g} points wide"


@dataclass(frozen=True, slots=True)
class RatioTest:
    """Wald's sequential probability-ratio test (1945) of a pass rate of ``required`` against ``refused``.

    If the true rate is at most ``refused``, the test decides for ``required`` with a probability of at most ``ERROR``.
    If it is at least ``required``, the test decides for ``refused`` with the same probability at most. Both bounds are
    approximate, as Wald neglects the excess over the bounds. Between the two rates, the test may decide either way.
    """

    required: float
    refused: float

    def ruling(self, holding: int, total: int) -> Ruling | None:
        """Return the decision from the executions so far; ``None`` if more executions are needed."""
        ratio = holding * math.log(self.required / self.refused)
        ratio += (total - holding) * math.log((1.0 - self.required) / (1.0 - self.refused))
        bound = math.log((1.0 - ERROR) / ERROR)
        if ratio >= bound:
            return Ruling.SHOWN
        return Ruling.REFUTED if ratio <= -bound else None

    def words(self, ruling: Ruling | None) -> str:
        """Return the decision in words."""
        rates = f"a pass rate of {100 * self.required:g} % against {100 * self.refused:g} %"
        decided = {Ruling.SHOWN: "is shown", Ruling.REFUTED: "is refuted"}
        if ruling is None:
            return f"sequential test: {rates} is neither shown nor refuted"
        return f"sequential test: {rates} {decided[ruling]} (errors at most {100 * ERROR:.0f} %)"


StopRule = UntilWidth | RatioTest
