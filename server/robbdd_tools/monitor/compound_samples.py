"""The truth of a defined predicate at each sample, and the predicate that decides it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.quantity_units import si_factor
from robbdd_tools.monitor.predicate_definitions import LEAST, Combination, Defined, dimension_of, unit_of, words_of
from robbdd_tools.monitor.sample_verdicts import at_some_time, throughout, whenever
from robbdd_tools.monitor.unobserved import Unobserved
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray, Predicate
    from robbdd_tools.monitor.predicate_definitions import (
        LEAST,
        Combination,
        Defined,
        Definition,
        dimension_of,
        unit_of,
        words_of,
    )
    from robbdd_tools.monitor.time import NoWindow


@dataclass(frozen=True, slots=True)
class Leaf:
    """A catalog predicate in a definition: its words, its unit, and the reason if it is unknown at all samples."""

    words: str
    unit: str
    reason: str = ""
    cause: Cause = Cause.NO_RECORD


@dataclass(frozen=True, slots=True)
class Samples:
    """The truth at each of n samples.

    - ``truths``: 1 true, 0 unknown, -1 false, shape (n,).
    - ``margins``: the margin of the deciding predicate, in its SI unit, shape (n,). Its sign agrees with the truth; it
      is NaN where the truth is unknown.
    - ``deciding``: the number of the deciding predicate in ``leaves``, shape (n,).
    """

    truths: NDArray[np.int8]
    margins: FloatArray
    deciding: NDArray[np.intp]
    leaves: tuple[Leaf, ...]

    def leaf(self, row: int) -> Leaf:
        """Return the predicate that gives the definition its margin at a sample."""
        return self.leaves[int(self.deciding[row])]

    def dimensions(self) -> NDArray[np.intp]:
        """Return a number for the dimension of the deciding margin at each sample, shape (n,); -1 if it has no unit."""
        names = [dimension_of(leaf.unit) for leaf in self.leaves]
        numbers = [names.index(name) if name else -1 for name in names]
        return np.array(numbers, dtype=np.intp)[self.deciding]


@dataclass(slots=True)
class _Evaluation:
    evidence: Evidence
    leaves: list[Leaf] = field(default_factory=list[Leaf])

    def of(self, definition: Definition, arguments: Arguments) -> Samples:
        if isinstance(definition, Combination):
            found = [self.of(operand, arguments) for operand in definition.operands]
            if definition.operator == "not":
                return _negated(found[0])
            joined = found[0]
            for other in found[1:]:
                joined = self._joined(joined, other, 1 if definition.operator == "and" else -1)
            return joined
        own, inner = definition.arguments(arguments), definition.predicate.evaluate
        if isinstance(inner, Defined):
            return self.of(inner.definition, own)
        return self._leaf(definition.predicate, own)

    def _leaf(self, predicate: Predicate, arguments: Arguments) -> Samples:
        size = len(self.evidence.times)
        leaf = Leaf(words_of(predicate, arguments), unit_of(predicate, self.evidence, arguments))
        if predicate.evaluate is None:
            return self._unknown(
                replace(leaf, reason=f"there is no evaluator for '{predicate.name}'", cause=Cause.NO_STEP)
            )
        try:
            margins = np.asarray(predicate.evaluate(self.evidence, arguments), dtype=float) * si_factor(leaf.unit)
        except KeyError as missing:
            return self._unknown(replace(leaf, reason=f"the trace has no record of '{missing.args[0]}'"))
        except Unobserved as gap:
            return self._unknown(replace(leaf, reason=str(gap), cause=Cause.UNOBSERVED))
        self.leaves.append(leaf)
        finite = np.isfinite(margins)
        truths = np.where(finite, np.where(margins >= 0, 1, -1), 0).astype(np.int8)
        return _signed(truths, margins, np.full(size, len(self.leaves) - 1), tuple(self.leaves))

    def _unknown(self, leaf: Leaf) -> Samples:
        size = len(self.evidence.times)
        self.leaves.append(leaf)
        truths, number = np.zeros(size, dtype=np.int8), np.full(size, len(self.leaves) - 1)
        return Samples(truths, np.full(size, np.nan), number, tuple(self.leaves))

    def _joined(self, one: Samples, other: Samples, sign: int) -> Samples:
        """Join two operands by *and* (``sign`` 1) or *or* (-1).

        Where both decide, margins of one dimension are compared. A margin with a unit is preferred to a margin of ±1.
        Otherwise, the first operand in written order decides.
        """
        leaves = tuple(self.leaves)
        one, other = replace(one, leaves=leaves), replace(other, leaves=leaves)
        truths = np.minimum(one.truths, other.truths) if sign > 0 else np.maximum(one.truths, other.truths)
        first, second = one.dimensions(), other.dimensions()
        closer = np.where(first == second, sign * other.margins < sign * one.margins, (first < 0) & (second >= 0))
        take = (other.truths == truths) & ((one.truths != truths) | closer)
        return Samples(
            truths,
            np.where(take, other.margins, one.margins),
            np.where(take, other.deciding, one.deciding),
            leaves,
        )


def samples_of(definition: Definition, evidence: Evidence, arguments: Arguments) -> Samples:
    """Return the truth of a definition at each sample.

    A predicate without a record is unknown at all samples. Raises other errors of evaluators.
    """
    evaluation = _Evaluation(evidence)
    return replace(evaluation.of(definition, arguments), leaves=tuple(evaluation.leaves))


def plain_margins(samples: Samples, unit: str) -> FloatArray:
    """Return the margins in a unit, shape (n,). Without a unit, they are 1 and -1; NaN where the truth is unknown."""
    if unit:
        return samples.margins / si_factor(unit)
    return np.where(samples.truths == 0, np.nan, samples.truths.astype(float))


def judge_samples(
    samples: Samples,
    times: FloatArray,
    applies: FloatArray | None,
    closing: float | None,
    missing: NoWindow | None,
    *,
    some_time: bool,
) -> Verdict:
    """Judge a defined predicate at the samples of a window.

    ``times`` are the times of the samples, s, shape (n,). ``applies`` is the margin of the condition of ``whenever``,
    shape (n,). ``closing`` and ``missing`` have the same meaning as in ``at_some_time``. The margin of the verdict is
    the deciding predicate's, in its own unit: the smallest margin in this unit, or the largest for *at some time*.
    """
    rows = np.ones(len(times), dtype=bool)
    if applies is not None:
        verdict = whenever(samples.margins, applies, times, "")
        surely = np.isfinite(applies) & (applies >= 0)
        rows = surely if verdict.outcome is Outcome.VIOLATED else ~(np.isfinite(applies) & (applies < 0))
    elif some_time:
        verdict = at_some_time(samples.margins, times, "", closing, missing)
    else:
        known = samples.truths != 0 if np.any(samples.truths < 0) else rows
        verdict = throughout(samples.margins[known], times[known], "")
    if verdict.vacuous or (verdict.outcome is Outcome.UNKNOWN and missing is not None):
        return verdict
    return _explained(verdict, samples, times, rows, some_time=some_time)


def _explained(
    verdict: Verdict, samples: Samples, times: FloatArray, rows: NDArray[np.bool_], *, some_time: bool
) -> Verdict:
    """Return a verdict with the predicate that decides it. ``rows`` are the samples that count, shape (n,)."""
    if verdict.outcome is Outcome.UNKNOWN:
        open_rows = rows & (samples.truths == 0)
        leaf = samples.leaf(int(np.argmax(open_rows)))
        if not np.any(open_rows) or not leaf.reason:
            return verdict
        return unknown(f"whether {leaf.words}: {leaf.reason}", leaf.cause)
    wanted = 1 if verdict.outcome is Outcome.HOLDS else -1
    deciding = rows & (samples.truths == wanted)
    dimensions = samples.dimensions()
    # Prefer a margin with a unit to a margin of ±1.
    measured = deciding & (dimensions >= 0)
    first = int(np.argmax(measured if np.any(measured) else deciding))
    like = deciding & (dimensions == dimensions[first])
    margins = np.where(like, samples.margins, -np.inf if some_time else np.inf)
    row = int(np.argmax(margins) if some_time else np.argmin(margins))
    leaf = samples.leaf(row)
    margin, worst_at = float(samples.margins[row]) / si_factor(leaf.unit), float(times[row])
    at = worst_at if verdict.outcome is Outcome.HOLDS and not some_time else verdict.at
    words = f"decided by: {leaf.words}" + ("" if at == worst_at else f", at {worst_at:.2f} s")
    reason = f"{verdict.reason}; {words}" if verdict.reason else words
    return replace(verdict, robustness=margin, unit=leaf.unit, worst_at=worst_at, at=at, reason=reason)


def _negated(samples: Samples) -> Samples:
    truths = (-samples.truths).astype(np.int8)
    return _signed(truths, -samples.margins, samples.deciding, samples.leaves)


def _signed(
    truths: NDArray[np.int8], margins: FloatArray, deciding: NDArray[np.intp], leaves: tuple[Leaf, ...]
) -> Samples:
    """Return samples whose margins have the sign of their truth: a margin of 0 is true, and its negation false."""
    fitting = np.where(truths > 0, np.maximum(margins, 0.0), np.minimum(margins, LEAST))
    return Samples(truths, np.where(truths == 0, np.nan, fitting), deciding, leaves)
