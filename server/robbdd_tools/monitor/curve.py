"""The margin of a predicate over time, for plots."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.time import During, NoWindow, TimeConstraint, Window, occurrence_times, window

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.trace import Trace

    Margins = Callable[[Window], FloatArray | None]
    """Returns the margin at each sample of a window, shape (n,), or ``None`` if it is unknown."""

POINTS = 400
"""Approximate number of points of a curve, enough for a screen. Longer curves are thinned; extremes and the deciding
samples stay."""
DIGITS = 6
"""Number of decimals of plotted numbers."""
DIGIT = 10**-DIGITS


@dataclass(frozen=True, slots=True)
class Curve:
    """The margin of one fluent over time.

    - ``start`` and ``end``: the window of the fluent (s); ``None`` if it has none, because of ``reason``.
    - ``margins``: the margins in the SI unit ``unit`` at ``times`` (s). Both are empty without a recording.
    - ``negated``: true if the clause negates the fluent.
    - ``some_time``: true if the fluent needs to hold at only one sample of its window: the largest margin decides.
    """

    start: float | None = None
    end: float | None = None
    reason: str = ""
    unit: str = ""
    negated: bool = False
    some_time: bool = False
    times: tuple[float, ...] = ()
    margins: tuple[float, ...] = ()


def curve(found: Curve, constraint: TimeConstraint, trace: Trace, margins: Margins) -> Curve:
    """Return the curve of a fluent, with its window and its points.

    The points extend beyond the window only if the margin does not depend on the start of the window. For *every*
    occurrence of an event, the window belongs to the occurrence with the smallest margin.
    """
    constraint = _decisive(constraint, trace, margins)
    whole = margins(Window(0, len(trace.times) - 1)) if len(trace.times) else None
    found = replace(found, some_time=constraint.some_time)
    selected = window(constraint, trace)
    if isinstance(selected, NoWindow) and constraint.some_time and selected.recorded is not None:
        selected = selected.recorded
    if isinstance(selected, NoWindow):
        return with_points(replace(found, reason=selected.reason), trace.times, whole)
    rows = slice(selected.first, selected.last + 1)
    times, inside = trace.times[rows], margins(selected)
    found = replace(found, start=round(float(times[0]), DIGITS), end=round(float(times[-1]), DIGITS))
    if whole is not None and inside is not None and np.array_equal(whole[rows], inside, equal_nan=True):
        return with_points(found, trace.times, whole)
    return with_points(found, times, inside)


def _decisive(constraint: TimeConstraint, trace: Trace, margins: Margins) -> TimeConstraint:
    """Return the time constraint of the deciding occurrence, if ``constraint`` names *every* occurrence."""
    if isinstance(constraint, During) or constraint.which != "every":
        return constraint
    times = occurrence_times(constraint, trace)
    if isinstance(times, NoWindow):
        return constraint

    def decisive_margin(one: TimeConstraint) -> float:
        selected = window(one, trace)
        inside = None if isinstance(selected, NoWindow) else margins(selected)
        if inside is None:
            return float("inf")
        return float(inside.max() if constraint.some_time else inside.min())

    return min((replace(constraint, number=number) for number in range(1, len(times) + 1)), key=decisive_margin)


def with_points(found: Curve, times: FloatArray, margins: FloatArray | None) -> Curve:
    """Return a curve with its points: finite ``margins`` (n,) at ``times`` (n,) s. Many points are thinned."""
    if margins is None:
        return found
    finite = np.isfinite(margins)
    times, margins = times[finite], margins[finite]
    if len(times) > POINTS:
        rows = sorted({*_extremes(margins), *_judged(found, times, margins)})
        times, margins = times[rows], margins[rows]
    return replace(found, times=tuple(times.round(DIGITS).tolist()), margins=tuple(margins.round(DIGITS).tolist()))


def _extremes(margins: FloatArray) -> Iterator[int]:
    """Yield the rows of the smallest and the largest margin in each of ``POINTS / 2`` parts of a curve."""
    bounds = np.linspace(0, len(margins), POINTS // 2 + 1).astype(int).tolist()
    for first, after in pairwise(bounds):
        part = margins[first:after]
        yield from (first + int(part.argmin()), first + int(part.argmax()))


def _judged(found: Curve, times: FloatArray, margins: FloatArray) -> Iterator[int]:
    """Yield the rows that decide the verdict: the window's first and last row, and the row of the deciding margin."""
    if found.start is None or found.end is None:
        return
    first, after = np.searchsorted(times, [found.start - DIGIT, found.end + DIGIT]).tolist()
    if first < after:
        inside = margins[first:after]
        yield from (first, after - 1, first + int(inside.argmax() if found.some_time else inside.argmin()))
