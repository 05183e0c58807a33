"""The positions of joints in a log, and their values at any time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.large_arrays import large_array
from robbdd_tools.logs.stored_rows import BLOCK, StoredRows

if TYPE_CHECKING:
    import numpy.typing as npt

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.stored_rows import Nanoseconds

TURN = 2 * np.pi


@dataclass(frozen=True, slots=True)
class JointTrack:
    """The states of one joint, in order of time.

    - ``times``: (n,) s since the begin of the log, increasing.
    - ``positions``: (n,) rad, or m of a sliding joint.
    - ``efforts``: (n,) N m or N; NaN where none was published.
    """

    times: FloatArray
    positions: FloatArray
    efforts: FloatArray


JointTracks = Mapping[str, Mapping[str, JointTrack]]
"""Topic → name of a joint → its states."""


@dataclass
class JointBuilder:
    """Collects the states of joints in any order of time. Times are in ns of the log's clock."""

    remarks: dict[str, None] = field(default_factory=dict[str, None])
    """Sentences on messages that are not used."""
    _topics: dict[str, dict[str, StoredRows]] = field(default_factory=dict[str, dict[str, StoredRows]])
    """Topic → name of a joint → rows of its position and its effort."""

    def add(
        self, topic: str, time: int, names: Sequence[str], positions: Sequence[float], efforts: Sequence[float] = ()
    ) -> None:
        """Add the states of a message. A message without positions is ignored: some drivers publish only velocities."""
        if not len(positions):
            return
        if len(positions) != len(names):
            words = f"a message on '{topic}' has {len(names)} joints but {len(positions)} positions"
            self.remarks[f"{words}: it is not used"] = None
            return
        forces = efforts if len(efforts) == len(names) else [np.nan] * len(names)
        joints = self._topics.setdefault(topic, {})
        for name, position, effort in zip(names, positions, forces, strict=True):
            states = joints.get(name)
            if states is None:
                states = joints[name] = StoredRows(2)
            states.append(time, (float(position), float(effort)))

    def absorb(self, other: JointBuilder) -> None:
        """Add the states of another builder."""
        self.remarks |= other.remarks
        for topic, joints in other._topics.items():
            for name, states in joints.items():
                own = self._topics.setdefault(topic, {}).setdefault(name, StoredRows(2))
                own.absorb(states)

    def drop(self, topic: str) -> None:
        """Forget the states that a topic published."""
        self._topics.pop(topic, None)

    def retime(self, convert: Callable[[Nanoseconds], Nanoseconds]) -> None:
        """Replace the times (ns) of all states."""
        for joints in self._topics.values():
            for name, states in joints.items():
                joints[name] = states.retimed(convert)

    def bounds(self) -> list[int]:
        """Return the times of the earliest and the latest state, ns; empty if there is none."""
        found = [time for joints in self._topics.values() for one in joints.values() for time in one.bounds()]
        return [min(found), max(found)] if found else []

    def tracks(self, begin: int) -> dict[str, dict[str, JointTrack]]:
        """Return the tracks, with times in s since ``begin`` (ns).

        Of several states at one time, the last one is kept. Positions that are not finite are left out.
        """
        every = {
            topic: {name: _track(states, begin) for name, states in joints.items()}
            for topic, joints in self._topics.items()
        }
        return {
            topic: known
            for topic, joints in every.items()
            if (known := {name: track for name, track in joints.items() if len(track.times)})
        }


def _track(states: StoredRows, begin: int) -> JointTrack:
    stamps, values = states.in_order(_has_position)
    times, positions, efforts = (large_array((len(stamps),)) for _ in range(3))
    for first in range(0, len(stamps), BLOCK):
        rows = slice(first, first + BLOCK)
        times[rows] = (stamps[rows] - begin) / 1e9
        positions[rows], efforts[rows] = values[rows, 0], values[rows, 1]
    return JointTrack(times, positions, efforts)


def _has_position(values: FloatArray) -> npt.NDArray[np.bool_]:
    return np.isfinite(values[:, 0])


def positions_at(track: JointTrack, times: FloatArray, max_gap: float, *, wraps: bool = False) -> FloatArray:
    """Return the positions of a joint at ``times`` (n,) s, shape (n,).

    A position is interpolated linearly between two states that are at most ``max_gap`` (s) apart; it is NaN where they
    are further apart, and before the first and after the last state. If the joint ``wraps``, the shorter way counts,
    because drivers may publish angles of joints without limits that jump by whole turns between two states.
    """
    known = np.unwrap(track.positions, period=TURN) if wraps else track.positions
    after = np.clip(np.searchsorted(track.times, times, side="left"), 0, len(track.times) - 1)
    before = np.where(track.times[after] == times, after, np.maximum(after - 1, 0))
    missing = (times < track.times[0]) | (times > track.times[-1])
    missing |= track.times[after] - track.times[before] > max_gap
    return np.where(missing, np.nan, np.interp(times, track.times, known))
