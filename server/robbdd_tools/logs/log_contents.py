"""The contents of a log as plain data: poses of frames, text messages, and the clock of their time stamps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.logs.joint_tracks import JointTrack

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

REGULAR, REGULAR_SHARE = 20, 0.9
"""A topic reports regularly if it has this many messages after the first one, and this share of them is not late."""
ROUNDING = 1e-6
"""Times (s) in a log have a smaller error."""


class UnreadableLog(RobbddError):
    """A file is not a log that can be read; the message names the file and the reason."""


@dataclass(frozen=True, slots=True)
class Track:
    """The poses of a frame relative to its ``parent``, in order of time.

    - ``times``: (n,) s since the begin of the log, increasing.
    - ``positions``: (n, 3) m.
    - ``orientations``: (n, 4) unit quaternions (w, x, y, z), NaN where only the position was recorded.
    - ``static``: true if the frame never moves relative to its parent. Then there is one pose, valid at all times.
    - ``later``: the tracks of the frame in its later parents, if it changes its parent, as a grasped object may do. A
      track has a pose that is not a number at the time at which another parent follows.
    """

    parent: str
    times: FloatArray
    positions: FloatArray
    orientations: FloatArray
    static: bool = False
    later: tuple[Track, ...] = ()

    @property
    def parents(self) -> tuple[str, ...]:
        """All parents that the frame has during the log."""
        return (self.parent, *(one.parent for one in self.later))


@dataclass(frozen=True, slots=True)
class TextStamp:
    """A text on a topic, and the time (s since the begin of the log) at which it was published.

    ``declared`` is true if the text is the name of an event that the user declares: by a signal, or by hand.
    """

    topic: str
    text: str
    time: float
    declared: bool = False


@dataclass(frozen=True, slots=True)
class Truths:
    """A topic's reports on a clause. Each of ``times`` (n,) s begins a value: true (1), false (-1) or unknown (NaN)."""

    times: FloatArray
    values: FloatArray

    def at(self, times: FloatArray, max_gap: float) -> FloatArray:
        """Return the last report at each of some times (n,) s, NaN before the first one.

        If the topic reports regularly, a report says nothing about a time more than ``max_gap`` (s) after it. A topic
        that reports changes only is quiet for as long as nothing changes.
        """
        rows = np.searchsorted(self.times, times, side="right") - 1
        known = np.maximum(rows, 0)
        overdue = self._is_regular(max_gap) & (times - self.times[known] > max_gap + ROUNDING)
        return np.where((rows < 0) | overdue, np.nan, self.values[known])

    def _is_regular(self, max_gap: float) -> bool:
        waits = np.diff(self.times)
        return len(waits) >= REGULAR and float(np.mean(waits <= max_gap)) >= REGULAR_SHARE


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
