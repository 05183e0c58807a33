"""Traces made by hand, for tests of the monitor and of evaluators."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from robbdd_tools.monitor.trace import EventStamp, Trace

STEP = 0.1
"""Seconds between samples."""


def trace_of(
    paths: Mapping[str, Sequence[Sequence[float]]],
    events: Mapping[str, float] | None = None,
    grips: Mapping[str, Mapping[str, Sequence[float]]] | None = None,
    finished: bool = True,
    remark: str = "",
) -> Trace:
    """Build a trace of bodies moving along paths (one point per sample), upright."""
    names = tuple(paths)
    count = len(next(iter(paths.values()))) if paths else 0
    positions = np.array([paths[name] for name in names], dtype=float).reshape(len(names), count, 3).swapaxes(0, 1)
    orientations = np.tile([1.0, 0.0, 0.0, 0.0], (count, len(names), 1))
    held = {
        agent: np.array([what.get(name, [0.0] * count) for name in names], dtype=float).T
        for agent, what in (grips or {}).items()
    }
    stamps = tuple(EventStamp(name, time) for name, time in (events or {}).items())
    return Trace(
        names, np.arange(count, dtype=np.float64) * STEP, positions, orientations, held, stamps, finished, remark
    )


def still(count: int, point: Sequence[float] = (0.0, 0.0, 0.0)) -> list[list[float]]:
    """Return ``count`` times the same point."""
    return [list(point)] * count


def heights(values: Sequence[float]) -> list[list[float]]:
    """Return points above the origin at these heights."""
    return [[0.0, 0.0, value] for value in values]
