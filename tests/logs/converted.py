"""Bags of ROS 2 written again as logs of other kinds, with the same poses, events and joint states."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mcap.writer import Writer as McapWriter
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer as Writer1

from logs.bags import ROS1, header

KINDS = ("ros1", "foxglove", "csv")
DRAWN = "visualization_msgs/msg/MarkerArray"
"""Drawings for viewers, which say nothing that is judged."""


def messages(bag: Path) -> Iterator[tuple[str, int, str, Any]]:
    """Yield topic, time of reception (ns), type and content."""
    with AnyReader([bag]) as reader:
        known = [one for one in reader.connections if one.msgtype != DRAWN]
        for connection, received, raw in reader.messages(connections=known):
            yield connection.topic, received, connection.msgtype, reader.deserialize(raw, connection.msgtype)


def converted(bag: Path, kind: str, folder: Path) -> Path:
    """Write a bag of ROS 2 as a ROS 1 bag, as an MCAP of Foxglove's types or as a table, and return its path."""
    return {"ros1": _ros1, "foxglove": _foxglove, "csv": _table}[kind](bag, folder)


def _ros1(bag: Path, folder: Path) -> Path:
    path = folder / "run.bag"
    connections: dict[str, Any] = {}
    with Writer1(path) as writer:
        for topic, received, kind, content in messages(bag):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=ROS1)
            writer.write(connections[topic], received, ROS1.serialize_ros1(_of_ros1(content, kind), kind))
    return path


def _of_ros1(content: Any, kind: str) -> Any:
    """Return a message whose headers are those of ROS 1."""
    if kind == "tf2_msgs/msg/TFMessage":
        moved = ROS1.types["geometry_msgs/msg/TransformStamped"]
        return ROS1.types[kind](
            transforms=[moved(_header(one.header), one.child_frame_id, one.transform) for one in content.transforms]
        )
    if kind == "sensor_msgs/msg/JointState":
        return ROS1.types[kind](
            _header(content.header), content.name, content.position, content.velocity, content.effort
        )
    return content


def _header(found: Any) -> Any:
    return header(ROS1, found.stamp.sec + found.stamp.nanosec / 1e9, found.frame_id)


def _foxglove(bag: Path, folder: Path) -> Path:
    path = folder / "run.mcap"
    with path.open("wb") as file:
        writer = McapWriter(file)
        writer.start()
        channels: dict[str, int] = {}
        for topic, received, kind, content in messages(bag):
            schema, plain = _plain(kind, content)
            if topic not in channels:
                number = writer.register_schema(schema, "jsonschema", b"{}")
                channels[topic] = writer.register_channel(topic, "json", number)
            writer.add_message(channels[topic], received, json.dumps(plain).encode(), received)
        writer.finish()
    return path


def _plain(kind: str, content: Any) -> tuple[str, Any]:
    match kind:
        case "tf2_msgs/msg/TFMessage":
            return "foxglove.FrameTransforms", {"transforms": [_moved(one) for one in content.transforms]}
        case "sensor_msgs/msg/JointState":
            states = zip(content.name, content.position.tolist(), strict=True)
            joints = [{"name": name, "position": position} for name, position in states]
            return "foxglove.JointStates", {"timestamp": _stamp(content.header), "joints": joints}
        case _:
            return "foxglove.Log", {"message": content.data}


def _moved(one: Any) -> dict[str, Any]:
    where, turn = one.transform.translation, one.transform.rotation
    return {
        "timestamp": _stamp(one.header),
        "parent_frame_id": one.header.frame_id,
        "child_frame_id": one.child_frame_id,
        "translation": {"x": where.x, "y": where.y, "z": where.z},
        "rotation": {"x": turn.x, "y": turn.y, "z": turn.z, "w": turn.w},
    }


def _stamp(found: Any) -> dict[str, int]:
    return {"sec": found.stamp.sec, "nsec": found.stamp.nanosec}


def _table(bag: Path, folder: Path) -> Path:
    """A table has no topics: it has poses and events, but not what is held."""
    path = folder / "run.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(("time", "frame", "parent", "x", "y", "z", "qx", "qy", "qz", "qw", "event"))
        for topic, received, kind, content in messages(bag):
            if kind == "tf2_msgs/msg/TFMessage":
                for one in content.transforms:
                    where, turn, stamp = one.transform.translation, one.transform.rotation, one.header.stamp
                    time = f"{stamp.sec}.{stamp.nanosec:09d}"
                    place = (where.x, where.y, where.z, turn.x, turn.y, turn.z, turn.w)
                    table.writerow((time, one.child_frame_id, one.header.frame_id, *map(repr, place), ""))
            elif topic == "/events":
                table.writerow((f"{received / 1e9:.9f}", *[""] * 9, content.data))
    return path
