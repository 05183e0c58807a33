"""Write a stored trace as a rosbag2, so that RViz, PlotJuggler and Foxglove show it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.logs.transforms import rotated

if TYPE_CHECKING:
    from robbdd_tools.monitor.trace import Trace

WORLD = "world"
EVENTS = "/events"
NO_ROSBAGS = "writing ROS bags needs the extra 'logs': pip install 'robbdd-tools[logs]'"
BEGIN = 1_000_000_000
"""Time (ns) of the begin of the trace: a stamp of zero means *no time* in ROS."""


class CannotExport(RobbddError):
    """A trace cannot be written as a bag; the message gives the reason."""


Joints = Sequence[tuple[float, Mapping[str, Mapping[str, float]]]]
"""Samples: a time (s) and the joint positions (rad or m) of each agent."""


def write_ros2_bag(
    folder: Path,
    trace: Trace,
    frames: Mapping[str, tuple[float, float, float]],
    joints: Joints = (),
    *,
    mcap: bool = False,
) -> None:
    """Write a trace as a bag of ROS 2.

    It has ``/tf``, the events (``std_msgs/String`` on ``/events``), what each agent holds (``/AGENT/holds``), and the
    joint states of each agent (``/AGENT/joint_states``). A frame has the local name of its element. ``frames`` maps
    each object to the position (m) of its model's frame in the object's coordinates.

    Raises ``CannotExport`` if the folder exists or rosbags is not installed.
    """
    try:
        from rosbags.rosbag2 import StoragePlugin, Writer
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise CannotExport(NO_ROSBAGS) from None
    if folder.exists():
        raise CannotExport(f"{folder} exists: name a new folder")
    store = get_typestore(Stores.ROS2_HUMBLE)
    plugin = StoragePlugin.MCAP if mcap else StoragePlugin.SQLITE3
    with Writer(folder, version=9, storage_plugin=plugin) as writer:
        connections: dict[str, Any] = {}
        for time, topic, message in sorted(_messages(trace, frames, joints, store), key=lambda entry: entry[0]):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, message.__msgtype__, typestore=store)
            writer.write(connections[topic], time, store.serialize_cdr(message, message.__msgtype__))


def _messages(
    trace: Trace, frames: Mapping[str, tuple[float, float, float]], joints: Joints, store: Any
) -> Iterator[tuple[int, str, Any]]:
    text = store.types["std_msgs/msg/String"]
    for row, time in enumerate(trace.times.tolist()):
        stamp = _nanoseconds(time)
        yield stamp, "/tf", _transforms(trace, row, stamp, frames, store)
    for event in trace.events:
        yield _nanoseconds(event.time), EVENTS, text(data=event.name)
    for time, agents in joints:
        for agent, angles in agents.items():
            stamp = _nanoseconds(time)
            yield stamp, f"/{_local(agent)}/joint_states", _joint_state(angles, stamp, store)
    for agent, record in trace.grips.items():
        held = [trace.names[int(np.argmax(row))] if row.any() else "" for row in record]
        for row, name in enumerate(held):
            if row == 0 or held[row - 1] != name:
                yield _nanoseconds(float(trace.times[row])), f"/{_local(agent)}/holds", text(data=_local(name))


def _transforms(
    trace: Trace, row: int, stamp: int, frames: Mapping[str, tuple[float, float, float]], store: Any
) -> Any:
    types = store.types
    header = _header(stamp, WORLD, store)
    turns = trace.orientations[row]
    offsets = np.array([frames.get(name, (0.0, 0.0, 0.0)) for name in trace.names]).reshape(-1, 3)
    places = trace.positions[row] + rotated(turns, offsets)
    return types["tf2_msgs/msg/TFMessage"](
        transforms=[
            types["geometry_msgs/msg/TransformStamped"](
                header=header,
                child_frame_id=_local(name),
                transform=types["geometry_msgs/msg/Transform"](
                    translation=types["geometry_msgs/msg/Vector3"](*place),
                    rotation=types["geometry_msgs/msg/Quaternion"](turn[1], turn[2], turn[3], turn[0]),
                ),
            )
            for name, place, turn in zip(trace.names, places.tolist(), turns.tolist(), strict=True)
        ]
    )


def _joint_state(angles: Mapping[str, float], stamp: int, store: Any) -> Any:
    nothing = np.empty(0)
    return store.types["sensor_msgs/msg/JointState"](
        header=_header(stamp, "", store),
        name=list(angles),
        position=np.array(list(angles.values()), dtype=float),
        velocity=nothing,
        effort=nothing,
    )


def _header(stamp: int, frame: str, store: Any) -> Any:
    time = store.types["builtin_interfaces/msg/Time"](sec=stamp // 1_000_000_000, nanosec=stamp % 1_000_000_000)
    return store.types["std_msgs/msg/Header"](stamp=time, frame_id=frame)


def _nanoseconds(time: float) -> int:
    return BEGIN + round(time * 1e9)


def _local(name: str) -> str:
    return name.rpartition(":")[2]
