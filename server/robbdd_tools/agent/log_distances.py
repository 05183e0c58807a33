"""Distances in a log that no cell has: its lengths are probably not in metres."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from robbdd_tools.monitor.trace import Trace

FAR = 100.0
"""Elements of a cell are nearer to each other than this (m). In millimetres, their coordinates are some hundred."""


def far_apart(trace: Trace) -> list[str]:
    """Return a remark on the two elements of a log that are farthest apart, if they are implausibly far apart."""
    first = {name: place for name in trace.names if (place := _first_place(trace, name)) is not None}
    if len(first) < 2:
        return []
    places = np.array([*first.values()])
    distances = np.linalg.norm(places[:, None] - places[None], axis=2)
    one, other = (int(index) for index in np.unravel_index(int(np.argmax(distances)), distances.shape))
    if distances[one, other] <= FAR:
        return []
    names = [*first]
    words = f"{names[one]} and {names[other]} are {distances[one, other]:.0f} m apart"
    return [f"{words}: positions in a log are read in metres, so convert them if they are in millimetres"]


def _first_place(trace: Trace, name: str) -> np.ndarray | None:
    positions = trace.positions[:, trace.column(name)]
    seen = np.flatnonzero(np.isfinite(positions).all(axis=1))
    return positions[seen[0]] if len(seen) else None
