"""The contents of a log as plain data: poses of frames, texts, and the clock that stamps them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.exceptions import RobbddError

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


Row = tuple[int, float, float, float, float, float, float, float]
"""Time (ns), position (m) and orientation (w, x, y, z) of a frame."""


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
class LogContents:
    """Everything of a log that clauses are judged on.

    - ``tracks``: maps a frame to its poses.
    - ``texts``: the texts on all topics, in order of time.
    - ``end``: the time of the last message, s since the first.
    - ``remarks``: sentences on how the log was read, for example a clock offset that was corrected.
    """

    tracks: Mapping[str, Track]
    texts: tuple[TextStamp, ...] = ()
    end: float = 0.0
    remarks: tuple[str, ...] = ()


@dataclass
class TrackBuilder:
    """Collects the poses of frames in any order of time. Times are in ns of the log's clock."""

    _rows: dict[str, list[Row]] = field(default_factory=dict[str, list[Row]])
    _parents: dict[str, str] = field(default_factory=dict[str, str])
    _static: dict[str, bool] = field(default_factory=dict[str, bool])

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
        """Add a pose: position in m, orientation as (w, x, y, z).

        Raises ``UnreadableLog`` if the frame had another parent before.
        """
        known = self._parents.setdefault(frame, parent)
        if known != parent:
            raise UnreadableLog(f"frame '{frame}' has two parents, '{known}' and '{parent}': publish one of them only")
        self._static[frame] = self._static.get(frame, True) and static
        self._rows.setdefault(frame, []).append((time, *position, *orientation))

    @property
    def first(self) -> int | None:
        """The time of the earliest pose that is not static, ns; ``None`` if there is none."""
        return min((rows[0][0] for frame, rows in self._sorted() if not self._static[frame]), default=None)

    @property
    def last(self) -> int | None:
        """The time of the latest pose that is not static, ns; ``None`` if there is none."""
        return max((rows[-1][0] for frame, rows in self._sorted() if not self._static[frame]), default=None)

    def tracks(self, begin: int) -> dict[str, Track]:
        """Return the tracks, with times in s since ``begin`` (ns).

        Of several poses at one time, the last one is kept. Poses that are not finite, or whose quaternion has no
        length, are left out.
        """
        found = {frame: self._track(frame, rows, begin) for frame, rows in self._sorted()}
        return {frame: track for frame, track in found.items() if len(track.times)}

    def _sorted(self) -> list[tuple[str, list[Row]]]:
        # Sorting is stable: of equal times, the pose that was recorded last stays last.
        return [(frame, sorted(rows, key=lambda row: row[0])) for frame, rows in self._rows.items()]

    def _track(self, frame: str, rows: list[Row], begin: int) -> Track:
        stamps = np.array([row[0] for row in rows], dtype=np.int64)
        values = np.array([row[1:] for row in rows], dtype=float)
        length = np.linalg.norm(values[:, 3:], axis=1)
        usable = np.isfinite(values).all(axis=1) & (length > 0.5)
        usable[:-1] &= (stamps[1:] != stamps[:-1]) | ~usable[1:]
        if self._static[frame]:
            usable &= np.arange(len(rows)) == (np.flatnonzero(usable)[-1] if usable.any() else -1)
        stamps, values, length = stamps[usable], values[usable], length[usable]
        return Track(
            self._parents[frame],
            (stamps - begin) / 1e9,
            values[:, :3],
            values[:, 3:] / length[:, None],
            self._static[frame],
        )
