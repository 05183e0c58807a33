"""Verdicts from the margins at the samples of a window: throughout, at some time, whenever a condition holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.verdict import NEVER_APPLIED, Cause, Outcome, Verdict, unknown

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.time import NoWindow

NOT_A_NUMBER = "the margin is not a number at some sample"


def throughout(margins: FloatArray, times: FloatArray, unit: str) -> Verdict:
    """Return the verdict on a predicate that must hold at all samples."""
    if not np.all(np.isfinite(margins)):
        return unknown(NOT_A_NUMBER, Cause.NO_RECORD)
    worst = int(np.argmin(margins))
    robustness, worst_at = float(margins[worst]), float(times[worst])
    if robustness >= 0:
        return Verdict(Outcome.HOLDS, robustness, unit, worst_at, worst_at=worst_at)
    first = int(np.argmax(margins < 0))
    return Verdict(Outcome.VIOLATED, robustness, unit, float(times[first]), worst_at=worst_at)


def at_some_time(
    margins: FloatArray, times: FloatArray, unit: str, closing: float | None, missing: NoWindow | None
) -> Verdict:
    """Return the verdict on a predicate that must hold at some sample.

    ``closing`` is the time (s) at which the window closes. ``missing`` is set if the trace lacks a part of the window.
    In this case, and if some margin is NaN, the verdict is unknown unless the predicate holds at some sample.
    """
    finite = np.isfinite(margins)
    best = int(np.argmax(np.where(finite, margins, -np.inf)))
    robustness, best_at = float(margins[best]), float(times[best])
    if finite[best] and robustness >= 0:
        first = float(times[int(np.argmax(finite & (margins >= 0)))])
        left = "" if closing is None else f", {max(closing - first, 0.0):.2f} s before the window closes"
        return Verdict(Outcome.HOLDS, robustness, unit, first, f"first held at {first:.2f} s{left}", best_at)
    if missing is not None:
        return unknown(missing.reason, Cause.NO_EVENT)
    if not np.all(finite):
        return unknown(NOT_A_NUMBER, Cause.NO_RECORD)
    end = float(times[-1])
    reason = f"it held at no time until {end:.2f} s, and was closest at {best_at:.2f} s"
    return Verdict(Outcome.VIOLATED, robustness, unit, end, reason, best_at)


def whenever(margins: FloatArray, condition: FloatArray, times: FloatArray, unit: str) -> Verdict:
    """Return the verdict on a predicate that must hold at the samples at which a condition holds.

    ``condition`` are the margins of the condition, shape (n,). At each sample, the clause is the strong Kleene
    implication of the condition and the predicate. A margin that is NaN is unknown.
    """
    known, held = np.isfinite(margins), np.isfinite(margins) & (margins >= 0)
    maybe = ~(np.isfinite(condition) & (condition < 0))
    surely = np.isfinite(condition) & (condition >= 0)
    violated = surely & known & ~held
    if not np.any(violated):
        undecided = maybe & ~held
        if np.any(undecided):
            row = int(np.argmax(undecided))
            reason = NOT_A_NUMBER if surely[row] else f"its condition is not known at {times[row]:.2f} s"
            return unknown(reason, Cause.NO_RECORD)
        if not np.any(maybe):
            return Verdict(Outcome.HOLDS, reason=NEVER_APPLIED, vacuous=NEVER_APPLIED)
    rows = surely & known if np.any(violated) else maybe
    return throughout(margins[rows], times[rows], unit)
