"""Bags for tests, written message by message."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

ROS1, ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
TRINARY = "bdd_ros2_interfaces/msg/Trinary"
ROS2.register(get_types_from_msg("uint8 FALSE=0\nuint8 TRUE=1\nuint8 UNKNOWN=2\nuint8 value", TRINARY))
CONTACTS = "gazebo_msgs/msg/ContactsState"
MODELS, VISION = "gazebo_msgs/msg/ModelStates", "vision_msgs/msg/"
PACKAGES = {
    MODELS: "string[] name\ngeometry_msgs/Pose[] pose\ngeometry_msgs/Twist[] twist",
    "gazebo_msgs/msg/ContactState": (
        "string info\nstring collision1_name\nstring collision2_name\ngeometry_msgs/Wrench[] wrenches\n"
        "geometry_msgs/Wrench total_wrench\ngeometry_msgs/Vector3[] contact_positions\n"
        "geometry_msgs/Vector3[] contact_normals\nfloat64[] depths"
    ),
    CONTACTS: "std_msgs/Header header\ngazebo_msgs/ContactState[] states",
    f"{VISION}ObjectHypothesis": "string class_id\nfloat64 score",
    f"{VISION}ObjectHypothesisWithPose": "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose",
    f"{VISION}BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
    f"{VISION}Detection3D": "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\nstring id",
    f"{VISION}Detection3DArray": "std_msgs/Header header\nDetection3D[] detections",
}
for name, fields in PACKAGES.items():
    ROS2.register(get_types_from_msg(fields, name))
    ROS1.register(get_types_from_msg(fields, name))
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


def joints(
    names: Sequence[str],
    positions: Sequence[float],
    stamp: float,
    *,
    efforts: Sequence[float] = (),
    topic: str = "/joint_states",
    received: float | None = None,
) -> Message:
    """The states of joints. With a ``stamp`` of zero, its header has no time."""

    def make(store: Any) -> Any:
        return store.types["sensor_msgs/msg/JointState"](
            header=header(store, stamp, ""),
            name=list(names),
            position=np.array(positions, dtype=float),
            velocity=np.empty(0),
            effort=np.array(efforts, dtype=float),
        )

    return Message(topic, stamp if received is None else received, "sensor_msgs/msg/JointState", make)


def wrench(topic: str, force: Sequence[float], stamp: float) -> Message:
    """A force (N) and no moment."""

    def make(store: Any) -> Any:
        vector = store.types["geometry_msgs/msg/Vector3"]
        both = store.types["geometry_msgs/msg/Wrench"](force=vector(*map(float, force)), torque=vector(0.0, 0.0, 0.0))
        return store.types["geometry_msgs/msg/WrenchStamped"](header=header(store, stamp, "tool"), wrench=both)

    return Message(topic, stamp, "geometry_msgs/msg/WrenchStamped", make)


def contact(topic: str, touching: bool, received: float) -> Message:
    """The contacts of a simulator's sensor: one or none."""

    def make(store: Any) -> Any:
        types = store.types
        vector = types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
        none = types["geometry_msgs/msg/Wrench"](force=vector, torque=vector)
        one = types["gazebo_msgs/msg/ContactState"](
            info="",
            collision1_name="pad",
            collision2_name="cube",
            wrenches=[],
            total_wrench=none,
            contact_positions=[],
            contact_normals=[],
            depths=np.empty(0),
        )
        states = [one] if touching else []
        return types[CONTACTS](header=header(store, received, "world"), states=states)

    return Message(topic, received, CONTACTS, make)


def poses(topic: str, places: Sequence[Sequence[float]], *, stamp: float) -> Message:
    """A list of poses without names."""

    def make(store: Any) -> Any:
        found = [_pose(store, place) for place in places]
        return store.types["geometry_msgs/msg/PoseArray"](header=header(store, stamp, "map"), poses=found)

    return Message(topic, stamp, "geometry_msgs/msg/PoseArray", make)


def models(places: dict[str, Sequence[float]], received: float) -> Message:
    """The states of a simulator's models, without a header."""

    def make(store: Any) -> Any:
        nothing = store.types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
        still = store.types["geometry_msgs/msg/Twist"](linear=nothing, angular=nothing)
        return store.types[MODELS](
            name=list(places), pose=[_pose(store, place) for place in places.values()], twist=[still] * len(places)
        )

    return Message("/gazebo/model_states", received, MODELS, make)


def detected(
    things: Sequence[tuple[str, str, Sequence[float]]], stamp: float, *, boxed: bool = False, topic: str = "/seen"
) -> Message:
    """Detections: the id, the class and the place of each. With ``boxed``, only the boxes have the places."""

    def make(store: Any) -> Any:
        return store.types[f"{VISION}Detection3DArray"](
            header=header(store, stamp, "map"), detections=[_detection(store, *one, boxed=boxed) for one in things]
        )

    return Message(topic, stamp, f"{VISION}Detection3DArray", make)


def detected_alone(name: str, kind: str, place: Sequence[float], stamp: float) -> Message:
    """A detection with its own header."""

    def make(store: Any) -> Any:
        return _detection(store, name, kind, place, stamp=stamp)

    return Message("/seen", stamp, f"{VISION}Detection3D", make)


def _detection(
    store: Any, name: str, kind: str, place: Sequence[float], *, stamp: float | None = None, boxed: bool = False
) -> Any:
    types = store.types
    covered = types["geometry_msgs/msg/PoseWithCovariance"](
        pose=_pose(store, (0, 0, 0) if boxed else place), covariance=np.zeros(36)
    )
    # The second hypothesis is less likely than the first.
    results = [
        types[f"{VISION}ObjectHypothesisWithPose"](
            hypothesis=types[f"{VISION}ObjectHypothesis"](class_id=one, score=score), pose=covered
        )
        for one, score in ((kind, 0.9), ("shadow", 0.1))
        if kind
    ]
    box = types[f"{VISION}BoundingBox3D"](
        center=_pose(store, place), size=types["geometry_msgs/msg/Vector3"](0.1, 0.1, 0.1)
    )
    own = header(store, 0.0, "") if stamp is None else header(store, stamp, "map")
    return types[f"{VISION}Detection3D"](header=own, results=results, bbox=box, id=name)


def goals(action: str, states: dict[str, int], received: float, *, accepted: float | None = None) -> Message:
    """The states of an action's goals, by the numbers of ROS 2. The goals are named by one letter each."""

    def make(store: Any) -> Any:
        types = store.types
        seconds, rest = divmod(round((received if accepted is None else accepted) * 1e9), 1_000_000_000)
        time = types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=rest)

        def state(name: str, number: int) -> Any:
            identity = types["unique_identifier_msgs/msg/UUID"](uuid=np.full(16, ord(name), np.uint8))
            info = types["action_msgs/msg/GoalInfo"](goal_id=identity, stamp=time)
            return types["action_msgs/msg/GoalStatus"](goal_info=info, status=number)

        return types["action_msgs/msg/GoalStatusArray"](status_list=[state(*one) for one in states.items()])

    return Message(f"/{action}/_action/status", received, "action_msgs/msg/GoalStatusArray", make)


def diagnostics(states: dict[str, tuple[int, str]], received: float) -> Message:
    """The level and the message of each component."""

    def make(store: Any) -> Any:
        kind = store.types["diagnostic_msgs/msg/DiagnosticStatus"]
        found = [
            kind(level=level, name=name, message=words, hardware_id="", values=[])
            for name, (level, words) in states.items()
        ]
        return store.types["diagnostic_msgs/msg/DiagnosticArray"](header=header(store, received, ""), status=found)

    return Message("/diagnostics", received, "diagnostic_msgs/msg/DiagnosticArray", make)


def _pose(store: Any, place: Sequence[float]) -> Any:
    types = store.types
    return types["geometry_msgs/msg/Pose"](
        position=types["geometry_msgs/msg/Point"](*map(float, place)),
        orientation=types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
    )


def header(store: Any, stamp: float, frame: str) -> Any:
    seconds, rest = divmod(round(stamp * 1e9), 1_000_000_000)
    time = store.types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=rest)
    fields = {"stamp": time, "frame_id": frame}
    more = {"seq": 0} if "seq" in {name for name, _ in store.fielddefs["std_msgs/msg/Header"][1]} else {}
    return store.types["std_msgs/msg/Header"](**more, **fields)


def write(path: Path, messages: Iterable[Message], kind: str = "sqlite") -> Path:
    """Write a bag: ``sqlite``, ``old`` (SQLite without definitions), ``mcap`` or ``ros1``.

    Messages are written in the given order.
    """
    store = ROS1 if kind == "ros1" else ROS2
    path.parent.mkdir(parents=True, exist_ok=True)
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    writer = Writer1(path) if kind == "ros1" else Writer(path, version=8 if kind == "old" else 9, storage_plugin=plugin)
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
