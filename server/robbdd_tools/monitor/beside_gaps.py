"""Decide a clause by the observed part of its window, where that suffices although a log has gaps."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.sample_verdicts import at_some_time, throughout
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.unobserved import Unobserved
from robbdd_tools.monitor.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, FloatArray, Predicate
    from robbdd_tools.monitor.window_evidence import WindowEvidence


def decided_beside_gaps(
    predicate: Predicate,
    arguments: Arguments,
    evidence: WindowEvidence,
    gap: str,
    closing: float | None,
    *,
    some_time: bool,
) -> Verdict | None:
    """Return a verdict that no observation in the gaps could change; ``None`` if there is none.

    A predicate that must hold at ``some_time`` holds if it held at an observed sample; ``closing`` is the time (s) at
    which its window closes, if known. One that must hold throughout is violated if an observed sample violates it. The
    reason ends with that of the ``gap``.
    """
    if not (evidence.trace.log and predicate.pointwise):
        return None
    margins, times = _observed(predicate, arguments, evidence), evidence.times
    known = np.isfinite(margins)
    if not known.any():
        return None
    unit = predicate.unit if predicate.unit_for is None else predicate.unit_for(evidence, arguments)
    verdict = (
        at_some_time(margins, times, unit, closing, None)
        if some_time
        else throughout(margins[known], times[known], unit)
    )
    if verdict.outcome is not (Outcome.HOLDS if some_time else Outcome.VIOLATED):
        return None
    return replace(verdict, reason=f"{verdict.reason}; {gap}" if verdict.reason else f"although {gap}")


def _observed(predicate: Predicate, arguments: Arguments, evidence: WindowEvidence) -> FloatArray:
    """Return the margin at each sample, NaN where it is not known, shape (n,)."""
    assert predicate.evaluate is not None
    margins = np.full(len(evidence.times), np.nan)
    for first, last in _runs(arguments, evidence):
        # A speed at the first sample after a gap would need the one before.
        for begin in (first, first + 1):
            if begin > last:
                break
            with suppress(Unobserved):
                part = replace(evidence, window=Window(evidence.window.first + begin, evidence.window.first + last))
                margins[begin : last + 1] = predicate.evaluate(part, arguments)
                break
    return margins


def _runs(arguments: Arguments, evidence: WindowEvidence) -> Iterator[tuple[int, int]]:
    """Yield the first and the last row of each part of a window in which all places of the arguments are known."""
    words = [one for value in arguments.values() for one in ((value,) if isinstance(value, str) else value)]
    carriers = [carrier for word in words for carrier, _ in evidence.regions_of.get(word, ())]
    columns = [evidence.trace.column(name) for name in (*words, *carriers) if name in evidence.trace.names]
    rows = slice(evidence.window.first, evidence.window.last + 1)
    known = ~np.isnan(evidence.trace.positions[rows][:, columns]).any(axis=(1, 2))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int))).tolist()
    yield from ((first, after - 1) for first, after in zip(edges[::2], edges[1::2], strict=True))
