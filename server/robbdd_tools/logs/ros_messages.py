"""Collect the poses, texts and truth values of the messages of a ROS bag."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from robbdd_tools.logs.action_goals import ROS1_STATES, ROS2_STATES, ActionGoals, GoalState
from robbdd_tools.logs.diagnostics import Diagnostics
from robbdd_tools.logs.frame_sources import STATIC
from robbdd_tools.logs.log_collector import LogCollector
from robbdd_tools.logs.log_names import is_intended_topic
from robbdd_tools.logs.pose_lists import PoseLists

if TYPE_CHECKING:
    from robbdd_tools.logs.log_contents import LogContents
    from robbdd_tools.logs.pose_lists import Pose

HOW_STAMPED = "messages are stamped by their headers, and those without one by their reception"
MAX_LISTED = 4
WORLD = "world"
"""Frame of the poses of a simulator."""


class RosContents:
    """Collects the data in the messages of a bag. Times are in ns."""

    def __init__(self, stated: Collection[str] = ()) -> None:
        """``stated`` has the topics whose clocks the user has stated."""
        self.found = LogCollector(stated)
        self.lists = PoseLists()
        self.goals = ActionGoals()
        self.remarks: list[str] = []
        self.shapeless: dict[str, set[str]] = {}
        """Topics of scenes, with the entities that have no place because they consist of none or several solids."""
        self.ahead = 0
        """The clock of the next messages' headers is ahead by this (ns)."""
        self._diagnostics = Diagnostics()
        self._plans: set[str] = set()

    def transforms(self, topic: str, received: int, message: Any) -> None:
        """Take the transforms of ``TFMessage``; those of ``/tf_static`` hold at all times."""
        static = topic.rpartition("/")[2] == STATIC
        for one in message.transforms:
            where, turn = one.transform.translation, one.transform.rotation
            pose = (where.x, where.y, where.z), (turn.w, turn.x, turn.y, turn.z)
            time = self._stamp(one.header.stamp), received
            self.found.transform(topic, one.child_frame_id, one.header.frame_id, time, pose, static=static)

    def pose(self, topic: str, received: int, message: Any) -> None:
        """Take the pose of the frame that the topic names."""
        self._pose(topic, topic, received, message.header, message.pose)

    def estimate(self, topic: str, received: int, message: Any) -> None:
        """Take a pose with its covariance; the covariance is not used."""
        self._pose(topic, topic, received, message.header, message.pose.pose)

    def odometry(self, topic: str, received: int, message: Any) -> None:
        """Take the pose of ``child_frame_id`` or, if it is missing, of the topic."""
        self._pose(topic, message.child_frame_id or topic, received, message.header, message.pose.pose)

    def poses(self, topic: str, received: int, message: Any) -> None:
        """Take a list of poses without names: ``topic/0``, ``topic/1`` …"""
        frames = self.lists.unnamed(topic, [_pose(one) for one in message.poses])
        for frame, one in zip(frames, message.poses, strict=True):
            self._pose(topic, frame, received, message.header, one)

    def states(self, topic: str, received: int, message: Any) -> None:
        """Take the models or links of a simulator, by their names."""
        frames = self.lists.named(topic, message.name)
        for frame, one in zip(frames, message.pose, strict=True):
            self.found.pose(topic, frame, WORLD, (0, received), _pose(one))

    def detection(self, topic: str, received: int, message: Any) -> None:
        """Take one detected thing."""
        self._detections(topic, received, message.header, [message])

    def detections(self, topic: str, received: int, message: Any) -> None:
        """Take detected things."""
        self._detections(topic, received, message.header, message.detections)

    def _detections(self, topic: str, received: int, header: Any, found: Iterable[Any]) -> None:
        named = [(name, one) for one in found if (name := self._name(topic, one))]
        frames = self.lists.named(topic, [name for name, _ in named])
        for frame, (_, one) in zip(frames, named, strict=True):
            # Some detectors fill in only the header of the list.
            own = one.header if one.header.frame_id else header
            pose = _detected_pose(one)
            self.lists.seen(topic, frame, self._stamp(own.stamp), (pose.position.x, pose.position.y, pose.position.z))
            self._pose(topic, frame, received, own, pose)

    def _name(self, topic: str, one: Any) -> str:
        name = _detected(one)
        if not name:
            self.lists.nameless.add(topic)
        return name

    def text(self, topic: str, received: int, message: Any) -> None:
        """Take a text, which may report an event, unless its topic is one of plans."""
        if is_intended_topic(topic):
            self._plans.add(topic)
        else:
            self.found.text(topic, received, str(message.data))

    def log_line(self, topic: str, received: int, message: Any) -> None:
        """Take a line of a program's log, which may report an event."""
        self.found.text(topic, received, str(message.msg))

    def diagnostics(self, topic: str, received: int, message: Any) -> None:
        """Take the changes of components' states as texts on ``topic/NAME``."""
        for one in message.status:
            level = one.level[0] if isinstance(one.level, bytes) else int(one.level)
            for words in self._diagnostics.texts(topic, str(one.name), level, str(one.message)):
                self.found.text(f"{topic}/{one.name}", received, words)

    def truth(self, topic: str, received: int, message: Any) -> None:
        """Take a truth value."""
        self.found.truth(topic, received, 1.0 if message.data else -1.0)

    def trinary(self, topic: str, received: int, message: Any) -> None:
        """Take a truth value that may be unknown."""
        # The type defines its own values; a stamped one contains it.
        value = getattr(message, "trinary", message)
        known = {int(value.TRUE): 1.0, int(value.FALSE): -1.0}
        self.found.truth(topic, received, known.get(int(value.value), math.nan))

    def joint_states(self, topic: str, received: int, message: Any) -> None:
        """Take the states of joints."""
        time = self._stamp(message.header.stamp), received
        self.found.joints(topic, time, message.name, message.position, message.effort)

    def wrench(self, topic: str, received: int, message: Any) -> None:
        """Take the size of a force."""
        force = message.wrench.force
        time = self._stamp(message.header.stamp), received
        self.found.force(topic, time, math.hypot(force.x, force.y, force.z))

    def contacts(self, topic: str, received: int, message: Any) -> None:
        """Take whether a contact sensor reports a contact, as a truth value."""
        found = message.states if hasattr(message, "states") else message.contacts
        self.found.truth(topic, received, 1.0 if len(found) else -1.0)

    def goal_states(self, topic: str, received: int, message: Any) -> None:
        """Take the states of an action's goals."""
        found: list[tuple[str, int, GoalState]] = []
        for one in message.status_list:
            if hasattr(one, "goal_info"):
                info, states = one.goal_info, ROS2_STATES
                goal, accepted = bytes(info.goal_id.uuid).hex(), _stamp(info.stamp)
            else:
                states = ROS1_STATES
                goal, accepted = str(one.goal_id.id), _stamp(one.goal_id.stamp)
            found.append((goal, accepted, states.get(int(one.status), GoalState.WAITING)))
        self.goals.take(topic, received, found)

    def finish(self) -> LogContents:
        """Return the contents, with times in s since the earliest used message."""
        for received, topic, text in self.goals.texts:
            self.found.text(topic, received, text)
        found = self.found.finish()
        return replace(
            found,
            tracks={frame: track for frame, track in found.tracks.items() if not self.lists.ambiguous(frame)},
            remarks=(
                *(HOW_STAMPED, *self.remarks, *found.remarks, *self.lists.remarks(), *self.goals.remarks),
                *(_shapeless(topic, names) for topic, names in self.shapeless.items()),
                *(_planned(topic) for topic in sorted(self._plans)),
            ),
        )

    def _pose(self, topic: str, frame: str, received: int, header: Any, pose: Any) -> None:
        self.found.pose(topic, frame, header.frame_id, (self._stamp(header.stamp), received), _pose(pose))

    def _stamp(self, stamp: Any) -> int:
        """Return the corrected time of a header; 0 if it has none."""
        found = _stamp(stamp)
        return found - self.ahead if found else 0


READERS: Mapping[str, Callable[[RosContents, str, int, Any], None]] = {
    "tf2_msgs/msg/TFMessage": RosContents.transforms,
    "tf/msg/tfMessage": RosContents.transforms,
    "geometry_msgs/msg/PoseStamped": RosContents.pose,
    "geometry_msgs/msg/PoseWithCovarianceStamped": RosContents.estimate,
    "geometry_msgs/msg/PoseArray": RosContents.poses,
    "nav_msgs/msg/Odometry": RosContents.odometry,
    "gazebo_msgs/msg/ModelStates": RosContents.states,
    "gazebo_msgs/msg/LinkStates": RosContents.states,
    "vision_msgs/msg/Detection3D": RosContents.detection,
    "vision_msgs/msg/Detection3DArray": RosContents.detections,
    "sensor_msgs/msg/JointState": RosContents.joint_states,
    "geometry_msgs/msg/WrenchStamped": RosContents.wrench,
    "gazebo_msgs/msg/ContactsState": RosContents.contacts,
    "ros_gz_interfaces/msg/Contacts": RosContents.contacts,
    "std_msgs/msg/String": RosContents.text,
    "rcl_interfaces/msg/Log": RosContents.log_line,
    "rosgraph_msgs/msg/Log": RosContents.log_line,
    "diagnostic_msgs/msg/DiagnosticArray": RosContents.diagnostics,
    "std_msgs/msg/Bool": RosContents.truth,
    "bdd_ros2_interfaces/msg/Trinary": RosContents.trinary,
    "bdd_ros2_interfaces/msg/TrinaryStamped": RosContents.trinary,
    "action_msgs/msg/GoalStatusArray": RosContents.goal_states,
    "actionlib_msgs/msg/GoalStatusArray": RosContents.goal_states,
}
"""Types of messages → how they are read."""


HEADERLESS = frozenset(
    {
        "gazebo_msgs/msg/ModelStates",
        "gazebo_msgs/msg/LinkStates",
        "gazebo_msgs/msg/ContactsState",
        "ros_gz_interfaces/msg/Contacts",
        "std_msgs/msg/String",
        "std_msgs/msg/Bool",
        "rcl_interfaces/msg/Log",
        "rosgraph_msgs/msg/Log",
        "diagnostic_msgs/msg/DiagnosticArray",
        "bdd_ros2_interfaces/msg/Trinary",
        "bdd_ros2_interfaces/msg/TrinaryStamped",
        "action_msgs/msg/GoalStatusArray",
        "actionlib_msgs/msg/GoalStatusArray",
    }
)
"""Types without headers: their messages have the time of reception."""


def _pose(pose: Any) -> Pose:
    where, turn = pose.position, pose.orientation
    return (where.x, where.y, where.z), (turn.w, turn.x, turn.y, turn.z)


def _detected(one: Any) -> str:
    """Return the name of a detected thing: its tracking id or else its most likely class; empty if it has neither."""
    tracked = getattr(one, "id", "") or getattr(one, "tracking_id", "")
    if tracked or not len(one.results):
        return str(tracked)
    best = max(one.results, key=lambda result: float(getattr(result, "hypothesis", result).score))
    hypothesis = getattr(best, "hypothesis", best)
    return str(hypothesis.class_id if hasattr(hypothesis, "class_id") else hypothesis.id)


def _detected_pose(one: Any) -> Any:
    """Return the pose of the most likely class, or the centre of the box if a detector fills in only the box."""
    if not len(one.results):
        return one.bbox.center
    best = max(one.results, key=lambda result: float(getattr(result, "hypothesis", result).score))
    place = best.pose.pose.position
    return best.pose.pose if any((place.x, place.y, place.z)) else one.bbox.center


def _planned(topic: str) -> str:
    words = f"texts on '{topic}' may say what is planned, not what happened, so they report no events"
    return f"{words}; if they do, write --event 'EVENT={topic} is TEXT'"


def _shapeless(topic: str, names: set[str]) -> str:
    listed = ", ".join(f"'{name}'" for name in sorted(names)[:MAX_LISTED])
    return f"entities on '{topic}' without exactly one solid have no place: {listed}{' …' * (len(names) > MAX_LISTED)}"


def _stamp(stamp: Any) -> int:
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)
