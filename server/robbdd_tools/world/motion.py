"""Tool paths, and joint motions that follow them within the robot's limits.

A tool pose is given in cylinder coordinates about the robot's base. So no path leads through the base, and a
redundant arm turns with its first joint.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, ceil, cos, hypot, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.engine import TICK

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.arm_kinematics import Arm
    from robbdd_tools.world.placement import Pose

ACCELERATION = 2.0
"""Largest acceleration of the tool along its path, m/s²."""
TURNING = 2.0
"""Largest speed of rotation of the tool about the vertical, rad/s."""
MARGIN = 0.7
"""Share of a joint's speed limit that a motion may use; the servo needs the rest."""
SPACING = 0.03
"""Joint positions are computed for points of a path that are this far (m) apart."""
PEAK_SPEED, PEAK_ACCELERATION = 1.875, 5.774
"""Peaks of the minimum-jerk profile over unit distance and time."""
BEND = 0.3
"""If a joint changes by more (rad) between path points, a second search starts at the arm's current position."""
JOINT_POINTS = 32
"""A motion on which the joints move evenly is computed in this many parts."""
SHORTEST = 0.1
"""Duration of the shortest motion, s."""


@dataclass(frozen=True, slots=True)
class ToolPose:
    """The tool pointing down: distance from the base's axis (m), direction (rad), height above the base (m).

    ``turn`` (rad) is the tool's rotation about the vertical, relative to this direction.
    """

    radius: float
    bearing: float
    height: float
    turn: float


@dataclass(frozen=True, slots=True)
class Motion:
    """A motion in control ticks: joint positions (rad) and velocities (rad/s), each (ticks, n)."""

    joints: FloatArray
    velocities: FloatArray


def tool_pose(base: Pose, position: FloatArray, closing: float) -> ToolPose:
    """Return the tool pose at a world position whose fingers close along the direction ``closing`` (rad).

    The fingers are interchangeable, so the turn is chosen within a quarter turn of straight.
    """
    x, y = float(position[0]) - base.position[0], float(position[1]) - base.position[1]
    direction = atan2(y, x) - base.yaw
    direction = atan2(sin(direction), cos(direction))
    turn = closing - base.yaw - direction - pi / 2
    turn -= pi * round(turn / pi)
    return ToolPose(hypot(x, y), direction, float(position[2]) - base.position[2], turn)


def tool_path(base: Pose, points: Iterable[tuple[FloatArray, float]], turn: float | None = None) -> list[ToolPose]:
    """Return the tool poses at world positions, each with the closing direction (rad) of the fingers there.

    The fingers do not change places between points, nor before the first one if the ``turn`` (rad) there is given.
    """
    found: list[ToolPose] = []
    for position, closing in points:
        pose = tool_pose(base, position, closing)
        last = pose.turn if turn is None else turn
        turn = pose.turn + pi * round((last - pose.turn) / pi)
        found.append(replace(pose, turn=turn))
    return found


def present_pose(arm: Arm, joints: FloatArray) -> ToolPose:
    """Return the current tool pose of an arm whose tool points down."""
    position, rotation = arm.forward(joints)
    direction = atan2(position[1], position[0])
    turn = atan2(rotation[1, 0], rotation[0, 0]) - direction
    return ToolPose(hypot(position[0], position[1]), direction, float(position[2]), atan2(sin(turn), cos(turn)))


def yaw_of(base: Pose, pose: ToolPose) -> float:
    """Return the rotation (rad) of a tool about the vertical, world frame."""
    return base.yaw + pose.bearing + pose.turn


def frame_of(pose: ToolPose) -> tuple[FloatArray, FloatArray]:
    """Return position (3,) and rotation matrix (3, 3) of a tool pose in the base frame."""
    yaw = pose.bearing + pose.turn
    c, s = cos(yaw), sin(yaw)
    at = [pose.radius * cos(pose.bearing), pose.radius * sin(pose.bearing), pose.height]
    return np.array(at), np.array([[c, s, 0.0], [s, -c, 0.0], [0.0, 0.0, -1.0]])


def plan(arm: Arm, joints: FloatArray, goal: ToolPose, limits: FloatArray, speed: float) -> Motion:
    """Plan a motion from joint positions (n,) to a tool pose.

    ``limits`` (n,) are the speed limits of the joints, rad/s; ``speed`` is the speed limit of the tool, m/s.

    The tool moves along a straight line in cylinder coordinates with a minimum-jerk profile, as fast as the tool's and
    the joints' limits allow. Raises ``Unreachable``.
    """
    start = present_pose(arm, joints)
    length = _length(start, goal)
    turn = abs(goal.turn - start.turn)
    count = max(2, ceil(max(length / SPACING, turn / 0.1)))
    poses = [_between(start, goal, float(share)) for share in np.linspace(0.0, 1.0, count + 1)[1:]]
    return _along(arm, joints, poses, (length, turn), limits, speed)


def plan_through(arm: Arm, joints: FloatArray, poses: Sequence[ToolPose], limits: FloatArray, speed: float) -> Motion:
    """Plan a motion from joint positions (n,) through tool poses at equal distances.

    ``limits`` and ``speed`` have the same meaning as in ``plan``. Raises ``Unreachable``.
    """
    pairs = list(pairwise((present_pose(arm, joints), *poses)))
    length = sum(_length(one, other) for one, other in pairs)
    turn = sum(abs(other.turn - one.turn) for one, other in pairs)
    return _along(arm, joints, poses, (length, turn), limits, speed)


def plan_joints(arm: Arm, joints: FloatArray, goal: FloatArray, limits: FloatArray, speed: float) -> Motion:
    """Plan a motion on which all joints (n,) move evenly to their goals (n,), with the bounds of ``plan``."""
    shares = np.linspace(0.0, 1.0, JOINT_POINTS + 1)
    path = joints + shares[:, None] * (goal - joints)
    places = np.array([arm.forward(one)[0] for one in path])
    length = float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    duration = max(
        SHORTEST,
        PEAK_SPEED * length / speed,
        (PEAK_ACCELERATION * length / ACCELERATION) ** 0.5,
        float((PEAK_SPEED * np.abs(goal - joints) / (MARGIN * limits)).max()),
    )
    return _timed(path, shares, duration)


def _along(
    arm: Arm,
    joints: FloatArray,
    poses: Sequence[ToolPose],
    way: tuple[float, float],
    limits: FloatArray,
    speed: float,
) -> Motion:
    """Return the motion through tool poses at equal distances; ``way`` is its length (m) and its turn (rad)."""
    length, turn = way
    shares = np.linspace(0.0, 1.0, len(poses) + 1)
    points = [joints]
    last = joints
    for pose in poses:
        # Extrapolate the path: the search starts one step ahead.
        seed = 2.0 * points[-1] - last
        last = points[-1]
        points.append(_next(arm, points[-1], seed, pose))
    path = np.array(points)
    rate = np.abs(np.diff(path, axis=0)).max(axis=0) * len(poses)
    duration = max(
        SHORTEST,
        PEAK_SPEED * length / speed,
        PEAK_SPEED * turn / TURNING,
        (PEAK_ACCELERATION * length / ACCELERATION) ** 0.5,
        float((PEAK_SPEED * rate / (MARGIN * limits)).max()),
    )
    return _timed(path, shares, duration)


def _next(arm: Arm, present: FloatArray, ahead: FloatArray, pose: ToolPose) -> FloatArray:
    """Return joint positions at a pose near the current ones; raises ``Unreachable``.

    At a joint limit, the other joints must compensate, and a search from the extrapolated start finds another posture.
    So the nearer solution is taken.
    """
    found = arm.solve(ahead, *frame_of(pose))
    if np.abs(found - present).max() <= BEND:
        return found
    other = arm.solve(present, *frame_of(pose))
    return min(found, other, key=lambda joints: float(np.abs(joints - present).max()))


def _timed(path: FloatArray, shares: FloatArray, duration: float) -> Motion:
    ticks = max(1, ceil(duration / TICK))
    time = np.arange(ticks + 1) / ticks
    progress = time**3 * (10.0 + time * (6.0 * time - 15.0))
    joints = np.empty((ticks + 1, path.shape[1]))
    for joint in range(path.shape[1]):
        joints[:, joint] = np.interp(progress, shares, path[:, joint])
    velocities = np.empty_like(joints)
    velocities[1:-1] = (joints[2:] - joints[:-2]) / (2 * TICK)
    velocities[-1] = 0.0
    return Motion(joints[1:], velocities[1:])


def _between(start: ToolPose, goal: ToolPose, share: float) -> ToolPose:
    def mix(a: float, b: float) -> float:
        return a + share * (b - a)

    return ToolPose(
        mix(start.radius, goal.radius),
        mix(start.bearing, goal.bearing),
        mix(start.height, goal.height),
        mix(start.turn, goal.turn),
    )


def _length(start: ToolPose, goal: ToolPose) -> float:
    around = (start.radius + goal.radius) / 2 * (goal.bearing - start.bearing)
    return float(np.linalg.norm([goal.radius - start.radius, around, goal.height - start.height]))
