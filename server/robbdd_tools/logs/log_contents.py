"""The contents of a log as plain data: poses of frames, text messages, and the clock of their time stamps."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.logs.joint_tracks import JointTrack

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


MIN_LENGTH = 0.5
"""Four numbers whose length is at least this are a quaternion that merely needs normalising."""


SAME = 1e-6
"""If positions (m) and quaternions differ by at most this, they are the same pose, published again."""


class UnreadableLog(RobbddError):
    """A file is not a log that can be read; the message names the file and the reason."""


@dataclass(frozen=True, slots=True)
class Track:
    """The poses of a frame relative to its ``parent``, in order of time.

    - ``times``: (n,) s since the begin of the log, increasing.
    - ``positions``: (n, 3) m.
    - ``orientations``: (n, 4) unit quaternions (w, x, y, z).
    - ``static``: true if the frame never moves relative to its parent. Then there is one pose, valid at all times.
    """

    parent: str
    times: FloatArray
    positions: FloatArray
    orientations: FloatArray
    static: bool = False


@dataclass(frozen=True, slots=True)
class TextStamp:
    """A text on a topic, and the time (s since the begin of the log) at which it was published."""

    topic: str
    text: str
    time: float


@dataclass(frozen=True, slots=True)
class Truths:
    """A topic's reports on a clause. Each of ``times`` (n,) s begins a value: true (1), false (-1) or unknown (NaN)."""

    times: FloatArray
    values: FloatArray


@dataclass(frozen=True, slots=True)
class LogContents:
    """Everything of a log that clauses are judged on.

    - ``tracks``: maps a frame to its poses.
    - ``texts``: the texts on all topics, in order of time.
    - ``truths``: maps a topic of truth values to them.
    - ``joints``: maps a topic of joint states to its joints, and the name of each joint to the joint's states.
    - ``forces``: maps a topic of wrenches to a track whose ``positions`` are the sizes of the forces, N.
    - ``end``: the time of the last message, s since the first.
    - ``unfinished``: true if the recording continues or was interrupted, so that the end of the log is not its real
      end.
    - ``remarks``: sentences on how the log was read, for example a clock offset that was corrected.
    """

    tracks: Mapping[str, Track]
    texts: tuple[TextStamp, ...] = ()
    end: float = 0.0
    remarks: tuple[str, ...] = ()
    truths: Mapping[str, Truths] = field(default_factory=dict[str, Truths])
    joints: Mapping[str, Mapping[str, JointTrack]] = field(default_factory=dict[str, Mapping[str, JointTrack]])
    forces: Mapping[str, JointTrack] = field(default_factory=dict[str, JointTrack])
    unfinished: bool = False


@dataclass
class TrackBuilder:
    """Collects the poses of frames in any order of time. Times are in ns of the log's clock."""

    _frames: dict[str, _Poses] = field(default_factory=dict[str, "_Poses"])
    _lost: dict[str, str] = field(default_factory=dict[str, str])
    """Frames whose poses cannot be used → the reason; empty if another sentence already names it."""

    def add(
        self,
        frame: str,
        parent: str,
        time: int,
        position: tuple[float, float, float],
        orientation: tuple[float, float, float, float],
        *,
        static: bool = False,
    ) -> None:
        """Add a pose: position in m, orientation as (w, x, y, z)."""
        poses = self._frames.get(frame)
        if poses is None:
            poses = self._frames[frame] = _Poses(parent)
        if poses.parent != parent:
            self._lost[frame] = _two_parents(frame, poses.parent, parent)
            return
        poses.static = poses.static and static
        poses.times.append(time)
        poses.values.extend((*position, *orientation))

    def absorb(self, other: TrackBuilder) -> None:
        """Add the poses of another builder. A frame to which the builders give different parents has two parents."""
        self._lost |= {frame: words for frame, words in other._lost.items() if frame not in self._lost}
        for frame, poses in other._frames.items():
            own = self._frames.setdefault(frame, _Poses(poses.parent, static=poses.static))
            if own.parent != poses.parent:
                self._lost[frame] = _two_parents(frame, own.parent, poses.parent)
                continue
            own.static = own.static and poses.static
            own.times.extend(poses.times)
            own.values.extend(poses.values)

    def drop(self, frame: str) -> None:
        """Forget the poses of a frame. The frame remains, but its place is unknown."""
        if frame in self._frames:
            self._lost.setdefault(frame, "")

    def retime(self, convert: Callable[[array[int]], array[int]]) -> None:
        """Replace the times (ns) of all poses."""
        for poses in self._frames.values():
            poses.times = convert(poses.times)

    def bounds(self) -> list[int]:
        """Return the times of the earliest and the latest pose that is not static, ns; empty if there is none."""
        moving = [one for frame, one in self._frames.items() if not one.static and frame not in self._lost]
        times = [time for one in moving for time in (min(one.times), max(one.times))]
        return [min(times), max(times)] if times else []

    def tracks(self, begin: int, remarks: list[str]) -> dict[str, Track]:
        """Return the tracks, with times in s since ``begin`` (ns).

        If a frame has several poses at one time, the last one is kept. Poses that are not finite, or whose quaternion
        has no length, are left out. If a frame has several parents, or different static poses, its place is unknown,
        and a sentence about it is added to ``remarks``.
        """
        found: dict[str, Track] = {}
        for frame, poses in self._frames.items():
            if frame not in self._lost and poses.static and poses.differ():
                self._lost[frame] = f"frame '{frame}' has several static poses: its place is not known"
            track = _nowhere(poses.parent) if frame in self._lost else poses.track(begin)
            if len(track.times):
                found[frame] = track
        remarks += filter(None, self._lost.values())
        return found


def _two_parents(frame: str, one: str, other: str) -> str:
    words = f"frame '{frame}' has two parents, '{one}' and '{other}': publish one of them only"
    return f"{words}; its place is not known"


def _nowhere(parent: str) -> Track:
    """Return the track of a frame whose place is never known. Without it, its children would have no parent."""
    return Track(parent, np.zeros(1), np.full((1, 3), np.nan), np.full((1, 4), np.nan))


@dataclass
class _Poses:
    """The poses of one frame: their times (ns), positions (m) and orientations (w, x, y, z)."""

    parent: str
    static: bool = True
    times: array[int] = field(default_factory=lambda: array("q"))
    values: array[float] = field(default_factory=lambda: array("d"))

    def differ(self) -> bool:
        """Return whether the poses are not all the same."""
        values = np.array(self.values).reshape(-1, 7)
        return bool(np.ptp(values, axis=0).max(initial=0.0) > SAME)

    def track(self, begin: int) -> Track:
        stamps, values = np.array(self.times, dtype=np.int64), np.array(self.values).reshape(-1, 7)
        # The sort is stable: of equal times, the pose that was recorded last stays last.
        order = np.argsort(stamps, kind="stable")
        stamps, values = stamps[order], values[order]
        length = np.linalg.norm(values[:, 3:], axis=1)
        usable = np.isfinite(values).all(axis=1) & (length > MIN_LENGTH)
        stamps, values, length = stamps[usable], values[usable], length[usable]
        last = np.ones(len(stamps), bool)
        last[:-1] = False if self.static else stamps[1:] != stamps[:-1]
        turns = values[last, 3:] / length[last, None]
        return Track(self.parent, (stamps[last] - begin) / 1e9, values[last, :3], turns, self.static)
