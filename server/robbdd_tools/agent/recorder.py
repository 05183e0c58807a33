"""Keeps the samples of one execution in arrays that grow; a trace of them shares the memory."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.trace import EventStamp, Trace

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

ROWS = 1024


class Recorder:
    """Samples of ``names`` (bodies) and of what each agent grips. Rows are only ever appended.

    With them goes the engine's own state of ``width`` numbers, to come back to an instant later.
    """

    def __init__(self, names: tuple[str, ...], agents: tuple[str, ...], width: int) -> None:
        self._names = names
        self._width = width
        self._agents = agents
        self.clear()

    def clear(self) -> None:
        """Forget all samples; traces taken before keep theirs."""
        size = len(self._names)
        self._rows = 0
        self._times: FloatArray = np.empty(ROWS)
        self._positions: FloatArray = np.empty((ROWS, size, 3))
        self._orientations: FloatArray = np.empty((ROWS, size, 4))
        self._grips: dict[str, FloatArray] = {agent: np.empty((ROWS, size)) for agent in self._agents}
        self._states: FloatArray = np.empty((ROWS, self._width))

    @property
    def states(self) -> FloatArray:
        """The engine's joint positions at each sample, shape (n, width)."""
        return self._states[: self._rows]

    def append(
        self,
        time: float,
        positions: FloatArray,
        orientations: FloatArray,
        grips: Mapping[str, FloatArray],
        state: FloatArray,
    ) -> None:
        """Append a sample: positions (m, 3), orientations (m, 4), per agent what it grips (m,), the state (width,)."""
        if self._rows == len(self._times):
            self._grow()
        row = self._rows
        self._rows += 1
        self._times[row] = time
        self._positions[row] = positions
        self._orientations[row] = orientations
        self._states[row] = state
        for agent, held in grips.items():
            self._grips[agent][row] = held

    def trace(self, events: tuple[EventStamp, ...], finished: bool, remark: str) -> Trace:
        """Return the samples so far; what is appended later does not show in it."""
        rows = self._rows
        return Trace(
            self._names,
            self._times[:rows],
            self._positions[:rows],
            self._orientations[:rows],
            {agent: held[:rows] for agent, held in self._grips.items()},
            events,
            finished,
            remark,
        )

    def _grow(self) -> None:
        self._times = _doubled(self._times)
        self._positions = _doubled(self._positions)
        self._orientations = _doubled(self._orientations)
        self._states = _doubled(self._states)
        self._grips = {agent: _doubled(held) for agent, held in self._grips.items()}


def _doubled(rows: FloatArray) -> FloatArray:
    return np.concatenate([rows, np.empty_like(rows)])
