"""Read ROS 1 bags, and rosbag2 folders and files (SQLite or MCAP), without a ROS installation."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.logs.log_contents import LogContents, TextStamp, TrackBuilder, Truths, UnreadableLog

if TYPE_CHECKING:
    from collections.abc import Callable

MIN_OFFSET = 1.0
"""Seconds between the clocks of headers and of reception from which they count as different clocks."""
STATIC = "tf_static"
NO_ROSBAGS = "reading ROS bags needs the extra 'logs': pip install 'robbdd-tools[logs]'"


def read_ros_bag(path: Path) -> LogContents:
    """Return the contents of a bag.

    Poses are stamped by the headers of their messages. Texts have no header, so they are stamped by their reception.
    If the two clocks differ, the time of reception is moved by the median difference, and a remark says so.
    Raises ``UnreadableLog``.
    """
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise UnreadableLog(NO_ROSBAGS) from None
    contents = _Contents()
    try:
        # Bags of ROS 2 before Iron do not contain the definitions of their types.
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            wanted = [one for one in reader.connections if one.msgtype in READERS]
            for connection, received, raw in reader.messages(connections=wanted) if wanted else ():
                message = reader.deserialize(raw, connection.msgtype)
                READERS[connection.msgtype](contents, connection.topic, received, message)
    except UnreadableLog as error:
        raise UnreadableLog(f"{path}: {error}") from None
    except Exception as error:  # On damaged bytes each decoder raises exceptions of its own types.
        raise UnreadableLog(f"{path} cannot be read as a ROS bag: {error or type(error).__name__}") from error
    return contents.finish()


class _Contents:
    """Collects what the messages of a bag say. Times are in ns."""

    def __init__(self) -> None:
        self.builder = TrackBuilder()
        self.texts: list[tuple[int, str, str]] = []
        self.truths: dict[str, list[tuple[int, float]]] = {}
        self.offsets: list[int] = []

    def transform(self, topic: str, received: int, message: Any) -> None:
        static = topic.rpartition("/")[2] == STATIC
        for one in message.transforms:
            stamp = _stamp(one.header.stamp)
            if not static:
                self.offsets.append(received - stamp)
            where, turn = one.transform.translation, one.transform.rotation
            self._add(one.child_frame_id, one.header.frame_id, stamp, where, turn, static=static)

    def pose(self, topic: str, received: int, message: Any) -> None:
        self._stamped(topic, received, message, message.pose)

    def odometry(self, topic: str, received: int, message: Any) -> None:
        self._stamped(message.child_frame_id or topic, received, message, message.pose.pose)

    def text(self, topic: str, received: int, message: Any) -> None:
        self.texts.append((received, topic, str(message.data)))

    def truth(self, topic: str, received: int, message: Any) -> None:
        self.truths.setdefault(topic, []).append((received, 1.0 if message.data else -1.0))

    def trinary(self, topic: str, received: int, message: Any) -> None:
        # The type defines its own values; a stamped one contains it.
        value = getattr(message, "trinary", message)
        known = {int(value.TRUE): 1.0, int(value.FALSE): -1.0}
        self.truths.setdefault(topic, []).append((received, known.get(int(value.value), math.nan)))

    def finish(self) -> LogContents:
        offset = int(np.median(self.offsets)) if self.offsets else 0
        different = abs(offset) > MIN_OFFSET * 1e9
        shift = offset if different else 0
        texts = sorted((received - shift, topic, text) for received, topic, text in self.texts)
        truths = {topic: sorted((time - shift, one) for time, one in found) for topic, found in self.truths.items()}
        stamps = [*self.builder.bounds(), *(time for time, _, _ in texts)]
        stamps += [time for found in truths.values() for time, _ in found]
        begin, end = min(stamps, default=0), max(stamps, default=0)
        remarks = ("poses are stamped by their headers, texts by their reception",)
        if different:
            remarks += (f"the time of reception is {offset / 1e9:.3f} s ahead of the headers, and was corrected",)
        return LogContents(
            self.builder.tracks(begin),
            tuple(TextStamp(topic, text, (time - begin) / 1e9) for time, topic, text in texts),
            (end - begin) / 1e9,
            remarks,
            {topic: _truths(found, begin) for topic, found in truths.items()},
        )

    def _stamped(self, name: str, received: int, message: Any, pose: Any) -> None:
        stamp = _stamp(message.header.stamp)
        self.offsets.append(received - stamp)
        self._add(name, message.header.frame_id, stamp, pose.position, pose.orientation, static=False)

    def _add(self, frame: str, parent: str, stamp: int, where: Any, turn: Any, *, static: bool) -> None:
        position, rotation = (where.x, where.y, where.z), (turn.w, turn.x, turn.y, turn.z)
        self.builder.add(frame.lstrip("/"), parent.lstrip("/"), stamp, position, rotation, static=static)


READERS: dict[str, Callable[[_Contents, str, int, Any], None]] = {
    "tf2_msgs/msg/TFMessage": _Contents.transform,
    "tf/msg/tfMessage": _Contents.transform,
    "geometry_msgs/msg/PoseStamped": _Contents.pose,
    "nav_msgs/msg/Odometry": _Contents.odometry,
    "std_msgs/msg/String": _Contents.text,
    "std_msgs/msg/Bool": _Contents.truth,
    "bdd_ros2_interfaces/msg/Trinary": _Contents.trinary,
    "bdd_ros2_interfaces/msg/TrinaryStamped": _Contents.trinary,
}
"""Types of messages → how they are read."""


def _truths(found: list[tuple[int, float]], begin: int) -> Truths:
    times = np.array([time - begin for time, _ in found]) / 1e9
    return Truths(times, np.array([value for _, value in found]))


def _stamp(stamp: Any) -> int:
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)
