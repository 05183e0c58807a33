"""Find when a condition becomes true in a trace: these are the occurrences of the event that it defines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.time import TOLERANCE

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

_FALSE, _TRUE, _UNKNOWN = 0, 1, 2


@dataclass(frozen=True, slots=True)
class RisingEdges:
    """The times (s) at which a condition becomes true.

    ``doubtful`` are the spans (s) in which it may have become true without being observed. ``held_from_start`` is true
    if it holds at the first sample.
    """

    times: tuple[float, ...]
    doubtful: tuple[tuple[float, float], ...]
    held_from_start: bool


def rising_edges(margins: FloatArray, times: FloatArray, seconds: float = 0.0) -> RisingEdges:
    """Return when a condition becomes true, from its margins at the samples of a trace, both of shape (n,).

    It becomes true at a sample at which it holds if it did not hold at the previous sample. If ``seconds`` is positive,
    the time is the first sample at which the condition has held for so long without interruption. A margin that is NaN
    is unknown: no occurrence is known from the last known sample before it until the first known sample after it.
    """
    if not len(times):
        return RisingEdges((), (), False)
    missing: list[bool] = np.isnan(margins).tolist()
    states = [
        _UNKNOWN if unknown else _TRUE if margin >= 0 else _FALSE
        for unknown, margin in zip(missing, margins.tolist(), strict=True)
    ]
    starts = [row for row in range(len(times)) if not row or states[row] != states[row - 1]]
    found: list[float] = []
    doubtful: list[tuple[float, float]] = []
    for first, end in zip(starts, [*starts[1:], len(times)], strict=True):
        state, before = states[first], states[first - 1] if first else _UNKNOWN
        if state == _UNKNOWN:
            doubtful.append((float(times[max(first - 1, 0)]), float(times[min(end, len(times) - 1)]) + seconds))
        elif state == _TRUE and before == _FALSE:
            due = float(times[first]) + seconds - TOLERANCE
            row = first + int(np.searchsorted(times[first:end], due, side="left"))
            found += [float(times[row])] if row < end else []
    return RisingEdges(tuple(found), tuple(doubtful), states[0] == _TRUE)
