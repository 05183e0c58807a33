"""Collect the data in the messages of a log, with the clocks of their headers and of their reception."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from robbdd_tools.logs.frame_sources import FrameSources
from robbdd_tools.logs.header_clocks import HeaderClocks, HeaderTime
from robbdd_tools.logs.joint_tracks import JointBuilder
from robbdd_tools.logs.log_contents import LogContents, TextStamp, Truths

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.logs.pose_lists import Pose
    from robbdd_tools.logs.stored_rows import Nanoseconds
    from robbdd_tools.logs.track_builder import TrackBuilder

FORCE = "force"


class LogCollector:
    """Collects poses, states of joints, forces, texts and truth values. Times are in ns.

    The time of a message is the time in its header or, if it is zero or missing, the time of reception. Messages must
    be added in the order of their reception.
    """

    def __init__(self, stated: Collection[str] = ()) -> None:
        """``stated`` has the topics whose clocks the user has stated."""
        self.clocks = HeaderClocks(stated)
        self._stamped, self._received = _Messages(), _Messages()
        self._texts: list[tuple[int, str, str, bool]] = []
        self._truths: dict[str, list[tuple[int, float]]] = {}

    def transform(
        self, topic: str, frame: str, parent: str, time: tuple[int, int], pose: Pose, *, static: bool = False
    ) -> None:
        """Add a transform. ``time`` has the time of its header and the time of its reception."""
        stamp, received = time
        name = frame.lstrip("/")
        # Static transforms hold at all times: they are published once, and may have the time of a start long ago.
        messages = self._stamped if static else self._messages(topic, name, time)
        _add(messages.frames.of_transforms(topic), name, parent, stamp or received, pose, static=static)

    def transforms(
        self,
        topic: str,
        frame: str,
        parents: Iterable[tuple[str, npt.NDArray[np.bool_]]],
        times: tuple[Nanoseconds, Nanoseconds],
        poses: FloatArray,
    ) -> None:
        """Add transforms of a moving frame. The names have no leading slashes.

        ``parents`` has each parent with its rows. ``times`` has the times (n,) of headers, of which all or none are
        zero, and of reception. ``poses`` (n, 7) has positions (m) and orientations (w, x, y, z).
        """
        stamps, received = times
        messages = self._stamped if stamps[0] else self._received
        if stamps[0]:
            self.clocks.seen_many(topic, frame, received, stamps)
        builder = messages.frames.of_transforms(topic)
        for parent, rows in parents:
            builder.extend(frame, parent, (stamps if stamps[0] else received)[rows], poses[rows])

    def pose(self, topic: str, frame: str, parent: str, time: tuple[int, int], pose: Pose) -> None:
        """Add the pose of a frame on a topic of its own; ``time`` as for ``transform``."""
        name = frame.lstrip("/")
        messages = self._messages(topic, name, time)
        _add(messages.frames.of_topic(topic), name, parent, time[0] or time[1], pose)

    def joints(
        self,
        topic: str,
        time: tuple[int, int],
        names: Sequence[str],
        positions: Sequence[float],
        efforts: Sequence[float] = (),
    ) -> None:
        """Add the states of joints; ``time`` as for ``transform``."""
        self._messages(topic, "", time).joints.add(topic, time[0] or time[1], names, positions, efforts)

    def force(self, topic: str, time: tuple[int, int], size: float) -> None:
        """Add the size of a force, N; ``time`` as for ``transform``."""
        self._messages(topic, "", time).forces.add(topic, time[0] or time[1], [FORCE], [size])

    def text(self, topic: str, received: int, text: str, *, declared: bool = False) -> None:
        """Add a text without a header, which may report an event, or the name of a ``declared`` event."""
        self._texts.append((received, topic, text, declared))

    def truth(self, topic: str, received: int, value: float) -> None:
        """Add a truth value: 1, -1 or NaN."""
        self._truths.setdefault(topic, []).append((received, value))

    def finish(self) -> LogContents:
        """Return the contents, with times in s since the earliest used message."""
        clock = self.clocks.header_time()
        self._stamped.drop(clock.unusable)
        if clock.timeless:
            self._received, self._texts, self._truths = _Messages(), [], {}
        self._received.retime(clock)
        every = self._stamped
        every.absorb(self._received)
        texts = sorted(zip(_moved([time for time, *_ in self._texts], clock), self._texts, strict=True))
        truths = {topic: _truths(found, clock) for topic, found in self._truths.items()}
        stamps = [*every.bounds(), *(time for time, _ in texts)]
        stamps += [time for times, _ in truths.values() for time in (times[0], times[-1])]
        begin, end = min(stamps, default=0), max(stamps, default=0)
        remarks: list[str] = []
        return LogContents(
            every.frames.tracks(begin, remarks),
            tuple(TextStamp(topic, text, (time - begin) / 1e9, known) for time, (_, topic, text, known) in texts),
            (end - begin) / 1e9,
            (*clock.remarks, *remarks, *every.joints.remarks),
            {topic: Truths((np.array(times) - begin) / 1e9, values) for topic, (times, values) in truths.items()},
            every.joints.tracks(begin),
            {topic: found[FORCE] for topic, found in every.forces.tracks(begin).items()},
        )

    def _messages(self, topic: str, frame: str, time: tuple[int, int]) -> _Messages:
        stamp, received = time
        if not stamp:
            return self._received
        self.clocks.seen(topic, frame, received, stamp)
        return self._stamped


class _Messages:
    """Messages whose times are from one clock."""

    def __init__(self) -> None:
        self.frames = FrameSources()
        self.joints = JointBuilder()
        self.forces = JointBuilder()

    def absorb(self, other: _Messages) -> None:
        self.frames.absorb(other.frames)
        self.joints.absorb(other.joints)
        self.forces.absorb(other.forces)

    def drop(self, unusable: Collection[tuple[str, str]]) -> None:
        for topic, frame in unusable:
            if frame:
                self.frames.drop(topic, frame)
            self.joints.drop(topic)
            self.forces.drop(topic)

    def retime(self, clock: HeaderTime) -> None:
        self.frames.retime(clock.of)
        self.joints.retime(clock.of)
        self.forces.retime(clock.of)

    def bounds(self) -> list[int]:
        return [*self.frames.bounds(), *self.joints.bounds(), *self.forces.bounds()]


def _add(builder: TrackBuilder, frame: str, parent: str, time: int, pose: Pose, *, static: bool = False) -> None:
    place, turn = pose
    builder.add(frame, parent.lstrip("/"), time, place, turn, static=static)


def _moved(times: Sequence[int], clock: HeaderTime) -> list[int]:
    return clock.of(np.array(times, dtype=np.int64)).tolist()


def _truths(found: list[tuple[int, float]], clock: HeaderTime) -> tuple[list[int], npt.NDArray[np.float64]]:
    """Return the times (ns) of truth values and the values, both in order of time."""
    times = _moved([time for time, _ in found], clock)
    order = sorted(range(len(times)), key=times.__getitem__)
    return [times[row] for row in order], np.array([found[row][1] for row in order])
