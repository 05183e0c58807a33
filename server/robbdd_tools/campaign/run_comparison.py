"""Decide whether one run is worse than another one, clause by clause."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from robbdd_tools.campaign.effects import MarginEffect, Rate, RateEffect, margin_effect, rate, rate_effect
from robbdd_tools.campaign.gate import Gate
from robbdd_tools.campaign.matched_executions import MatchedClause, MatchedRuns, match
from robbdd_tools.campaign.multiple_tests import Test, corrected
from robbdd_tools.campaign.rates import LEVEL, Interval
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.workbench.execution_rows import ExecutionResult


class Change(StrEnum):
    """The change of a clause that the executions show."""

    WORSE = "worse"
    BETTER = "better"
    NONE = "no difference shown"
    UNCLEAR = "cannot tell"


class Decision(StrEnum):
    """The change of all clauses together that the executions show."""

    IDENTICAL = "identical"
    ACCEPTED = "within the gate"
    WORSE = "worse"
    UNCLEAR = "cannot tell"


@dataclass(frozen=True, slots=True)
class ClauseEffect:
    """A clause in both runs.

    - ``rates``: the change of its pass rate. ``margins``: that of its mean margin, if both runs measured it.
    - ``change``: what is shown at the confidence level, corrected for the number of clauses.
    - ``identical``: whether all executions are the same, with the same known verdicts and margins.
    - ``accepted``: whether they are identical, or the gate is shown to be kept.
    """

    iri: str
    name: str
    role: str
    before: Rate
    after: Rate
    rates: RateEffect
    margins: MarginEffect | None
    change: Change
    identical: bool
    accepted: bool


@dataclass(frozen=True, slots=True)
class RunComparison:
    """Two runs compared. ``effects`` begins with the row of all clauses together."""

    matched: MatchedRuns
    level: float
    effects: tuple[ClauseEffect, ...]
    decision: Decision


@dataclass(frozen=True, slots=True)
class ComparisonOptions:
    """How runs are compared.

    - ``gate``: the accepted changes for the worse.
    - ``level``: the confidence level of intervals; 1 − ``level`` is the largest probability of any false *worse* or
      *better* among all clauses.
    - ``by_margin``: mean margins decide, too, not only pass rates.
    """

    gate: Gate = field(default_factory=Gate)
    level: float = LEVEL
    by_margin: bool = False


def compare_results(
    before: Iterable[ExecutionResult], after: Iterable[ExecutionResult], options: ComparisonOptions | None = None
) -> RunComparison:
    """Compare the executions that two runs have in common. Raises ``NothingShared`` and ``StatisticsNotInstalled``.

    Executions with the same seed in both runs are compared in pairs: McNemar's exact test for pass rates, the paired
    t-test for margins. Otherwise the runs are independent samples: Fisher's exact test, Welch's t-test. The p-values
    are corrected for their number (``multiple_tests``).
    """
    chosen = options or ComparisonOptions()
    matched = match(before, after)
    found = [_measured(clause, chosen.level, paired=matched.paired) for clause in matched.clauses]
    alpha = 1.0 - chosen.level
    worse = corrected([value for one in found for value in one.worse(by_margin=chosen.by_margin)], alpha)
    better = corrected([value for one in found for value in one.better(by_margin=chosen.by_margin)], alpha)
    effects: list[ClauseEffect] = []
    used = 0
    for one in found:
        count = len(one.worse(by_margin=chosen.by_margin))
        own = slice(used, used + count)
        used += count
        effects.append(_effect(one, min(worse[own]), min(better[own]), matched, chosen))
    return RunComparison(matched, chosen.level, tuple(effects), _decision(effects, matched))


@dataclass(frozen=True, slots=True)
class _Measured:
    clause: MatchedClause
    rates: RateEffect
    margins: MarginEffect | None

    def worse(self, *, by_margin: bool) -> list[Test]:
        rates = Test(self.rates.worse, self.rates.least_worse, self._verdicts)
        return [rates, *([self._margin(-1)] if by_margin else [])]

    def better(self, *, by_margin: bool) -> list[Test]:
        rates = Test(self.rates.better, self.rates.least_better, self._verdicts)
        return [rates, *([self._margin(1)] if by_margin else [])]

    @property
    def _verdicts(self) -> tuple[tuple[Outcome, ...], ...]:
        """The verdicts of both runs. If one clause decides alone, the row of all clauses has the same ones."""
        return tuple(tuple(one.verdict for one in side) for side in (self.clause.before, self.clause.after))

    def _margin(self, direction: int) -> Test:
        """Return the test of whether a margin moved in a direction. It shows nothing if margins are missing."""
        if self.margins is None or self.margins.missing or self.margins.interval == Interval(0.0, 0.0):
            return Test(1.0, 1.0)
        return Test(1.0 if self.margins.difference * direction <= 0 else self.margins.probability)


def _measured(clause: MatchedClause, level: float, *, paired: bool) -> _Measured:
    return _Measured(clause, rate_effect(clause, level, paired=paired), margin_effect(clause, level, paired=paired))


def _effect(
    one: _Measured, worse: float, better: float, matched: MatchedRuns, options: ComparisonOptions
) -> ClauseEffect:
    same = _identical(one.clause, matched)
    alpha = 1.0 - options.level
    accepted = same or _within(one, options.gate)
    if worse <= alpha:
        change = Change.WORSE
    elif better <= alpha:
        change = Change.BETTER
    else:
        change = Change.NONE if accepted else Change.UNCLEAR
    before, after = rate(one.clause.before), rate(one.clause.after)
    clause = one.clause
    return ClauseEffect(
        clause.iri, clause.name, clause.role, before, after, one.rates, one.margins, change, same, accepted
    )


def _identical(clause: MatchedClause, matched: MatchedRuns) -> bool:
    """Whether both runs have the same executions with the same seeds, known verdicts and margins."""
    return matched.paired and clause.before == clause.after and rate(clause.before).unknown == 0


def _within(one: _Measured, gate: Gate) -> bool:
    """Whether the change is shown to be within the gate's limit; false if the gate states no limit for the clause."""
    share = gate.limit(one.clause.name)
    kept: list[bool] = [] if share is None else [one.rates.interval.low >= -share]
    size = gate.limit(one.clause.name, one.clause.unit) if one.clause.unit else None
    if size is not None:
        kept.append(one.margins is not None and not one.margins.missing and one.margins.interval.low >= -size)
    return bool(kept) and all(kept)


def _decision(effects: Sequence[ClauseEffect], matched: MatchedRuns) -> Decision:
    if any(one.change is Change.WORSE and not one.accepted for one in effects):
        return Decision.WORSE
    # A clause that is no longer judged may be worse.
    if matched.removed or not all(one.accepted for one in effects):
        return Decision.UNCLEAR
    return Decision.IDENTICAL if all(one.identical for one in effects) else Decision.ACCEPTED
