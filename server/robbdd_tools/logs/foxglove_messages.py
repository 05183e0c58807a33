"""Take the data out of Foxglove's messages, as plain data: from JSON, or decoded from Protobuf."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from robbdd_tools.logs.pose_lists import frame_in

if TYPE_CHECKING:
    from robbdd_tools.logs.pose_lists import Pose
    from robbdd_tools.logs.ros_messages import RosContents

SOLIDS = ("arrows", "cubes", "spheres", "cylinders", "models")
"""Parts of an entity of a scene that have poses."""
SECOND = 1_000_000_000


def take_foxglove(contents: RosContents, topic: str, kind: str, received: int, message: Any) -> None:
    """Take a message of one of the types ``FOXGLOVE``. Raises ``KeyError`` and the like for a damaged message."""
    FOXGLOVE[kind](contents, topic, received, message)


def _transforms(contents: RosContents, topic: str, received: int, message: Any) -> None:
    for one in message["transforms"]:
        _transform(contents, topic, received, one)


def _transform(contents: RosContents, topic: str, received: int, message: Any) -> None:
    pose = _vector(message["translation"]), _turn(message["rotation"])
    time = _moved(contents, _stamp(message["timestamp"])), received
    contents.found.transform(topic, message["child_frame_id"], message["parent_frame_id"], time, pose)


def _pose_in_frame(contents: RosContents, topic: str, received: int, message: Any) -> None:
    time = _moved(contents, _stamp(message["timestamp"])), received
    contents.found.pose(topic, topic, message["frame_id"], time, _pose(message["pose"]))


def _poses_in_frame(contents: RosContents, topic: str, received: int, message: Any) -> None:
    time = _moved(contents, _stamp(message["timestamp"])), received
    frames = contents.lists.unnamed(topic, [_pose(one) for one in message["poses"]])
    for frame, pose in zip(frames, message["poses"], strict=True):
        contents.found.pose(topic, frame, message["frame_id"], time, _pose(pose))


def _scene(contents: RosContents, topic: str, received: int, message: Any) -> None:
    """Take the entities that consist of one solid: only then is the place of the solid that of the entity."""
    for entity in message["entities"]:
        solids = [one for kind in SOLIDS for one in entity.get(kind) or ()]
        frame = frame_in(topic, str(entity["id"]))
        if len(solids) != 1:
            contents.shapeless.setdefault(topic, set()).add(str(entity["id"]))
            continue
        time = _moved(contents, _stamp(entity["timestamp"])), received
        contents.found.pose(topic, frame, entity["frame_id"], time, _pose(solids[0]["pose"]))


def _log(contents: RosContents, topic: str, received: int, message: Any) -> None:
    contents.found.text(topic, received, str(message["message"]))


def _joints(contents: RosContents, topic: str, received: int, message: Any) -> None:
    states = [one for one in message["joints"] if one.get("position") is not None]
    time = _moved(contents, _stamp(message["timestamp"])), received
    names, positions = [str(one["name"]) for one in states], [float(one["position"]) for one in states]
    efforts = [float(one.get("effort", math.nan)) for one in states]
    contents.found.joints(topic, time, names, positions, efforts)


def _ros_joints(contents: RosContents, topic: str, received: int, message: Any) -> None:
    time = _moved(contents, _header_stamp(message)), received
    contents.found.joints(topic, time, message["name"], message["position"], message.get("effort") or ())


FOXGLOVE: Mapping[str, Callable[[RosContents, str, int, Any], None]] = {
    "foxglove.FrameTransforms": _transforms,
    "foxglove.FrameTransform": _transform,
    "foxglove.PoseInFrame": _pose_in_frame,
    "foxglove.PosesInFrame": _poses_in_frame,
    "foxglove.SceneUpdate": _scene,
    "foxglove.Log": _log,
    "foxglove.JointStates": _joints,
    # ROS's type of joint states, which bridges also write as JSON messages.
    "sensor_msgs/JointState": _ros_joints,
    "sensor_msgs/msg/JointState": _ros_joints,
}
"""Types of messages → how they are read."""


def _moved(contents: RosContents, stamp: int) -> int:
    """Return the corrected time of a header; 0 if it has none."""
    return stamp - contents.ahead if stamp else 0


def _header_stamp(message: Any) -> int:
    """Return the stamp (ns) of a ROS message's header, whose names differ between ROS 1 and ROS 2."""
    stamp = message["header"]["stamp"]
    rest = next((stamp[name] for name in ("nanosec", "nsec", "nsecs") if name in stamp), 0)
    return int(stamp.get("sec", stamp.get("secs", 0))) * SECOND + int(rest)


def _pose(value: Any) -> Pose:
    return _vector(value["position"]), _turn(value["orientation"])


def _vector(value: Any) -> tuple[float, float, float]:
    return float(value["x"]), float(value["y"]), float(value["z"])


def _turn(value: Any) -> tuple[float, float, float, float]:
    return float(value["w"]), float(value["x"]), float(value["y"]), float(value["z"])


def _stamp(value: Any) -> int:
    # Protobuf's own type of time stamps has other names than Foxglove's JSON.
    return int(value.get("sec", value.get("seconds", 0))) * SECOND + int(value.get("nsec", value.get("nanos", 0)))
