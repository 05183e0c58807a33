"""Bags for tests, written message by message."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

ROS1, ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
TRINARY = "bdd_ros2_interfaces/msg/Trinary"
ROS2.register(get_types_from_msg("uint8 FALSE=0\nuint8 TRUE=1\nuint8 UNKNOWN=2\nuint8 value", TRINARY))
ROS1.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))


@dataclass(frozen=True, slots=True)
class Message:
    """A message: topic, time of reception (s), type, and a function that makes its content from a type store."""

    topic: str
    received: float
    kind: str
    make: Any


def transform(
    child: str,
    place: Sequence[float],
    *,
    stamp: float,
    received: float | None = None,
    parent: str = "map",
    turn: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
    topic: str = "/tf",
) -> Message:
    """A transform of one frame; the orientation is (w, x, y, z)."""

    def make(store: Any) -> Any:
        types = store.types
        one = types["geometry_msgs/msg/TransformStamped"](
            header=header(store, stamp, parent),
            child_frame_id=child,
            transform=types["geometry_msgs/msg/Transform"](
                translation=types["geometry_msgs/msg/Vector3"](*map(float, place)),
                rotation=types["geometry_msgs/msg/Quaternion"](turn[1], turn[2], turn[3], turn[0]),
            ),
        )
        return types["tf2_msgs/msg/TFMessage"](transforms=[one])

    return Message(topic, stamp if received is None else received, "tf2_msgs/msg/TFMessage", make)


def pose(topic: str, place: Sequence[float], *, stamp: float, parent: str = "map") -> Message:
    """A pose of the frame that the topic names."""

    def make(store: Any) -> Any:
        types = store.types
        return types["geometry_msgs/msg/PoseStamped"](
            header=header(store, stamp, parent),
            pose=types["geometry_msgs/msg/Pose"](
                position=types["geometry_msgs/msg/Point"](*map(float, place)),
                orientation=types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
            ),
        )

    return Message(topic, stamp, "geometry_msgs/msg/PoseStamped", make)


def text(words: str, received: float, topic: str = "/events") -> Message:
    """A text on a topic."""

    def make(store: Any) -> Any:
        return store.types["std_msgs/msg/String"](data=words)

    return Message(topic, received, "std_msgs/msg/String", make)


def truth(topic: str, value: bool | int, received: float) -> Message:
    """A truth value, as ``Bool``, or as ``Trinary``: 0 is false, 1 is true, 2 is unknown."""

    def make(store: Any) -> Any:
        if isinstance(value, bool):
            return store.types["std_msgs/msg/Bool"](data=value)
        return store.types[TRINARY](value=value)

    return Message(topic, received, "std_msgs/msg/Bool" if isinstance(value, bool) else TRINARY, make)


def header(store: Any, stamp: float, frame: str) -> Any:
    seconds, rest = divmod(round(stamp * 1e9), 1_000_000_000)
    time = store.types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=rest)
    fields = {"stamp": time, "frame_id": frame}
    more = {"seq": 0} if "seq" in {name for name, _ in store.fielddefs["std_msgs/msg/Header"][1]} else {}
    return store.types["std_msgs/msg/Header"](**more, **fields)


def write(path: Path, messages: Iterable[Message], kind: str = "sqlite") -> Path:
    """Write a bag: ``sqlite``, ``mcap`` or ``ros1``. Messages are written in the given order."""
    store = ROS1 if kind == "ros1" else ROS2
    path.parent.mkdir(parents=True, exist_ok=True)
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    writer = Writer1(path) if kind == "ros1" else Writer(path, version=9, storage_plugin=plugin)
    with writer:
        connections: dict[tuple[str, str], Any] = {}
        for one in messages:
            key = (one.topic, one.kind)
            if key not in connections:
                connections[key] = writer.add_connection(one.topic, one.kind, typestore=store)
            content = one.make(store)
            encode = store.serialize_ros1 if kind == "ros1" else store.serialize_cdr
            writer.write(connections[key], round(one.received * 1e9), encode(content, one.kind))
    return path
