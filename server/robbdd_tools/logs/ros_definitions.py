"""Definitions of messages for bags that lack them, as SQLite bags of ROS 2 before Iron do."""

from __future__ import annotations

from typing import Any

_HEADER = "std_msgs/Header header"
DEFINITIONS = {
    "vision_msgs/msg/ObjectHypothesis": "string class_id\nfloat64 score",
    "vision_msgs/msg/ObjectHypothesisWithPose": (
        "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose"
    ),
    "vision_msgs/msg/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
    "vision_msgs/msg/Detection3D": (
        f"{_HEADER}\nvision_msgs/ObjectHypothesisWithPose[] results\nvision_msgs/BoundingBox3D bbox\nstring id"
    ),
    "vision_msgs/msg/Detection3DArray": f"{_HEADER}\nvision_msgs/Detection3D[] detections",
    "gazebo_msgs/msg/ContactState": (
        "string info\nstring collision1_name\nstring collision2_name\ngeometry_msgs/Wrench[] wrenches\n"
        "geometry_msgs/Wrench total_wrench\ngeometry_msgs/Vector3[] contact_positions\n"
        "geometry_msgs/Vector3[] contact_normals\nfloat64[] depths"
    ),
    "gazebo_msgs/msg/ContactsState": f"{_HEADER}\ngazebo_msgs/ContactState[] states",
    "gazebo_msgs/msg/ModelStates": "string[] name\ngeometry_msgs/Pose[] pose\ngeometry_msgs/Twist[] twist",
    "gazebo_msgs/msg/LinkStates": "string[] name\ngeometry_msgs/Pose[] pose\ngeometry_msgs/Twist[] twist",
}
"""Types → their fields in ROS 2 Humble, by their public interface definitions."""


def known_types() -> Any:
    """Return the type store of ROS 2 Humble, with ``DEFINITIONS`` added. Raises ``ImportError`` without rosbags."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, fields in DEFINITIONS.items():
        store.register(get_types_from_msg(fields, name))
    return store
