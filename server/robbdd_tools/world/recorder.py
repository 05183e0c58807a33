"""Store the samples of one execution in growing arrays; traces share their memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.trace import EventStamp, Trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray

ROWS = 1024


@dataclass(frozen=True, eq=False)
class Bodies:
    """The recorded bodies and their places in the state.

    ``positions`` (m, 3) m and ``orientations`` (m, 4) are the initial poses of the bodies ``names``; fixed bodies keep
    them. The columns ``loose`` (k,) are bodies with poses in the engine's state, at the indices ``places`` (k, 3) and
    ``turns`` (k, 4). The columns ``tools`` (a,) are the agents' tools and the parts that move by joints.
    """

    names: tuple[str, ...]
    positions: FloatArray
    orientations: FloatArray
    loose: NDArray[np.intp]
    places: NDArray[np.intp]
    turns: NDArray[np.intp]
    tools: NDArray[np.intp]


class Recorder:
    """Samples of bodies and of each agent's grips. Rows are only ever appended.

    A sample is the engine's own state of ``width`` numbers, so that the simulation can return to an instant. Derived
    quantities are computed for many samples at once, when a trace is requested.
    """

    def __init__(self, bodies: Bodies, agents: tuple[str, ...], width: int) -> None:
        self._bodies = bodies
        self._width = width
        self._agents = agents
        self.clear()

    def clear(self) -> None:
        """Delete all samples; earlier traces keep theirs."""
        bodies = self._bodies
        self._rows = self._expanded = 0
        self._times: FloatArray = np.empty(ROWS)
        self._positions: FloatArray = np.empty((ROWS, *bodies.positions.shape))
        self._orientations: FloatArray = np.empty((ROWS, *bodies.orientations.shape))
        self._tools: FloatArray = np.empty((ROWS, len(bodies.tools), 7))
        self._grips: dict[str, FloatArray] = {agent: np.empty((ROWS, len(bodies.names))) for agent in self._agents}
        self._states: FloatArray = np.empty((ROWS, self._width))

    @property
    def states(self) -> FloatArray:
        """The engine's joint positions at each sample, shape (n, width)."""
        return self._states[: self._rows]

    def append(self, time: float, state: FloatArray, grips: Mapping[str, FloatArray]) -> FloatArray:
        """Append a sample: the state (width,), and the grips (m,) of each agent.

        Return the array, shape (a, 7), into which the caller writes the positions and orientations of the tools.
        """
        if self._rows == len(self._times):
            self._grow()
        row = self._rows
        self._rows += 1
        self._times[row] = time
        self._states[row] = state
        for agent, held in grips.items():
            self._grips[agent][row] = held
        return self._tools[row]

    def trace(self, events: tuple[EventStamp, ...], finished: bool, remark: str) -> Trace:
        """Return the samples so far; later ones do not appear in it."""
        self._expand()
        rows = self._rows
        return Trace(
            self._bodies.names,
            self._times[:rows],
            self._positions[:rows],
            self._orientations[:rows],
            {agent: held[:rows] for agent, held in self._grips.items()},
            events,
            finished,
            remark,
        )

    def _expand(self) -> None:
        """Compute the poses of all bodies in new samples."""
        new, bodies = slice(self._expanded, self._rows), self._bodies
        self._expanded = self._rows
        states, tools = self._states[new], self._tools[new]
        self._positions[new] = bodies.positions
        self._orientations[new] = bodies.orientations
        self._positions[new, bodies.loose] = states[:, bodies.places]
        self._orientations[new, bodies.loose] = states[:, bodies.turns]
        self._positions[new, bodies.tools] = tools[..., :3]
        self._orientations[new, bodies.tools] = tools[..., 3:]

    def _grow(self) -> None:
        self._times = _doubled(self._times)
        self._positions = _doubled(self._positions)
        self._orientations = _doubled(self._orientations)
        self._tools = _doubled(self._tools)
        self._states = _doubled(self._states)
        self._grips = {agent: _doubled(held) for agent, held in self._grips.items()}


def _doubled(rows: FloatArray) -> FloatArray:
    return np.concatenate([rows, np.empty_like(rows)])
