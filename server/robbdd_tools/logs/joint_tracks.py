"""The positions of joints in a log, and their values at any time."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

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
    _topics: dict[str, dict[str, _States]] = field(default_factory=dict[str, "dict[str, _States]"])

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
                states = joints[name] = _States()
            states.times.append(time)
            states.values.extend((float(position), float(effort)))

    def absorb(self, other: JointBuilder) -> None:
        """Add the states of another builder."""
        self.remarks |= other.remarks
        for topic, joints in other._topics.items():
            for name, states in joints.items():
                own = self._topics.setdefault(topic, {}).setdefault(name, _States())
                own.times.extend(states.times)
                own.values.extend(states.values)

    def drop(self, topic: str) -> None:
        """Forget the states that a topic published."""
        self._topics.pop(topic, None)

    def retime(self, convert: Callable[[array[int]], array[int]]) -> None:
        """Replace the times (ns) of all states."""
        for joints in self._topics.values():
            for states in joints.values():
                states.times = convert(states.times)

    def bounds(self) -> list[int]:
        """Return the times of the earliest and the latest state, ns; empty if there is none."""
        found = [time for joints in self._topics.values() for one in joints.values() for time in one.bounds()]
        return [min(found), max(found)] if found else []

    def tracks(self, begin: int) -> dict[str, dict[str, JointTrack]]:
        """Return the tracks, with times in s since ``begin`` (ns).

        Of several states at one time, the last one is kept. Positions that are not finite are left out.
        """
        every = {
            topic: {name: states.track(begin) for name, states in joints.items()}
            for topic, joints in self._topics.items()
        }
        return {
            topic: known
            for topic, joints in every.items()
            if (known := {name: track for name, track in joints.items() if len(track.times)})
        }


@dataclass
class _States:
    """The states of one joint: times (ns), and for each the position and the effort."""

    times: array[int] = field(default_factory=lambda: array("q"))
    values: array[float] = field(default_factory=lambda: array("d"))

    def bounds(self) -> tuple[int, int]:
        return min(self.times), max(self.times)

    def track(self, begin: int) -> JointTrack:
        stamps, values = np.array(self.times, dtype=np.int64), np.array(self.values).reshape(-1, 2)
        # The sort is stable: of equal times, the state that was recorded last stays last.
        order = np.argsort(stamps, kind="stable")
        stamps, values = stamps[order], values[order]
        usable = np.isfinite(values[:, 0])
        stamps, values = stamps[usable], values[usable]
        last = np.ones(len(stamps), bool)
        last[:-1] = stamps[1:] != stamps[:-1]
        return JointTrack((stamps[last] - begin) / 1e9, values[last, 0], values[last, 1])


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
