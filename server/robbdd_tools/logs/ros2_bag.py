"""Write a stored trace as a rosbag2, so that RViz, PlotJuggler and Foxglove show it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.logs.scene_markers import MARKERS, SOLID, event_marker, frame_name, marker_array, scene_markers
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


@dataclass(frozen=True, slots=True)
class DrawnScene:
    """How a stored scene is drawn: the trace's ``/geometry``, and the times (s) and messages of its ``/tf``."""

    geometry: Mapping[str, Any]
    bodies: Sequence[tuple[float, Mapping[str, Any]]]


def write_ros2_bag(
    folder: Path,
    trace: Trace,
    frames: Mapping[str, tuple[float, float, float]],
    joints: Joints = (),
    *,
    scene: DrawnScene | None = None,
    mcap: bool = False,
) -> None:
    """Write a trace as a bag of ROS 2.

    It has ``/tf``, the events (``std_msgs/String`` on ``/events``), what each agent holds (``/AGENT/holds``), and the
    joint states of each agent (``/AGENT/joint_states``). A frame has the local name of its element. ``frames`` maps
    each object to the position (m) of its model's frame in the object's coordinates. With a ``scene``, the bag also has
    markers (``/markers``), and the frames of the links of arms.

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
        for time, topic, message in sorted(_messages(trace, frames, joints, scene, store), key=lambda entry: entry[0]):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, message.__msgtype__, typestore=store)
            writer.write(connections[topic], time, store.serialize_cdr(message, message.__msgtype__))


def _messages(
    trace: Trace,
    frames: Mapping[str, tuple[float, float, float]],
    joints: Joints,
    scene: DrawnScene | None,
    store: Any,
) -> Iterator[tuple[int, str, Any]]:
    if scene is not None:
        yield from _drawn(scene, trace, frames, store)
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


def _drawn(
    scene: DrawnScene, trace: Trace, frames: Mapping[str, tuple[float, float, float]], store: Any
) -> Iterator[tuple[int, str, Any]]:
    """Yield the markers of a scene, the frames of the bodies that are no elements, and a text for each event."""
    markers = list(scene_markers(scene.geometry, frames))
    yield BEGIN, MARKERS, marker_array(markers, _time(BEGIN, store), store)
    elements = {*trace.names, SOLID}
    moving = {one["child_frame_id"] for _, message in scene.bodies[1:] for one in message["transforms"]}
    for row, (time, message) in enumerate(scene.bodies):
        links = [one for one in message["transforms"] if one["child_frame_id"] not in elements]
        stamp = _nanoseconds(time)
        for topic, moves in (("/tf", True), ("/tf_static", False)):
            found = [one for one in links if (one["child_frame_id"] in moving) == moves]
            if found and (moves or row == 0):
                yield stamp, topic, _body_frames(found, stamp, store)
    shown = next((_local(name) for name in trace.names if name in trace.grips), WORLD)
    for event in trace.events:
        stamp = _nanoseconds(event.time)
        yield stamp, MARKERS, marker_array([event_marker(event.name, shown)], _time(stamp, store), store, len(markers))


def _body_frames(found: Sequence[Mapping[str, Any]], stamp: int, store: Any) -> Any:
    types = store.types
    header = _header(stamp, WORLD, store)
    return types["tf2_msgs/msg/TFMessage"](
        transforms=[
            types["geometry_msgs/msg/TransformStamped"](
                header=header,
                child_frame_id=frame_name(one["child_frame_id"]),
                transform=types["geometry_msgs/msg/Transform"](
                    translation=types["geometry_msgs/msg/Vector3"](**one["translation"]),
                    rotation=types["geometry_msgs/msg/Quaternion"](**one["rotation"]),
                ),
            )
            for one in found
        ]
    )


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
    return store.types["std_msgs/msg/Header"](stamp=_time(stamp, store), frame_id=frame)


def _time(stamp: int, store: Any) -> Any:
    return store.types["builtin_interfaces/msg/Time"](sec=stamp // 1_000_000_000, nanosec=stamp % 1_000_000_000)


def _nanoseconds(time: float) -> int:
    return BEGIN + round(time * 1e9)


def _local(name: str) -> str:
    return name.rpartition(":")[2]
