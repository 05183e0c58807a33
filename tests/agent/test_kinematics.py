"""Forward and inverse kinematics of the Panda against its published parameters; planned motions keep the limits."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from robbdd_tools.agent.engine import TICK
from robbdd_tools.agent.kinematics import Unreachable, arm_of
from robbdd_tools.agent.motion import ToolPose, frame_of, plan, tool_pose
from robbdd_tools.agent.placement import Pose
from robbdd_tools.catalog.robots.panda import PANDA

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

ARM = arm_of(PANDA)
LIMITS = np.array(PANDA.velocity_limits)
SPEED = 0.5
MODIFIED_DH = (
    (0.0, 0.333, 0.0),
    (0.0, 0.0, -pi / 2),
    (0.0, 0.316, pi / 2),
    (0.0825, 0.0, pi / 2),
    (-0.0825, 0.384, -pi / 2),
    (0.0, 0.0, pi / 2),
    (0.088, 0.0, pi / 2),
)
"""a (m), d (m), alpha (rad) of each joint."""
poses = st.builds(
    ToolPose, st.floats(0.32, 0.65), st.floats(-2.4, 2.4), st.floats(-0.05, 0.25), st.floats(-pi / 2, pi / 2)
)


def product(joints: FloatArray) -> FloatArray:
    """Flange, hand (turned by -45° about z) and tool after the product of the joints' transformations."""
    frame = np.eye(4)
    for (a, d, alpha), theta in zip(MODIFIED_DH, joints, strict=True):
        frame = frame @ link(a, d, alpha, float(theta))
    return frame @ link(0.0, 0.107 + 0.1034, 0.0, -pi / 4)


def link(a: float, d: float, alpha: float, theta: float) -> FloatArray:
    ca, sa, ct, st_ = cos(alpha), sin(alpha), cos(theta), sin(theta)
    rows = [[ct, -st_, 0, a], [st_ * ca, ct * ca, -sa, -sa * d], [st_ * sa, ct * sa, ca, ca * d], [0, 0, 0, 1]]
    return np.array(rows, dtype=np.float64)


@given(st.lists(st.floats(0, 1), min_size=7, max_size=7))
@settings(max_examples=200, deadline=None)
def test_forward_kinematics_is_the_product_of_the_published_parameters(shares: list[float]) -> None:
    joints = ARM.lower + np.array(shares) * (ARM.upper - ARM.lower)
    position, rotation = ARM.forward(joints)
    expected = product(joints)
    assert np.abs(position - expected[:3, 3]).max() < 1e-6
    assert np.abs(rotation - expected[:3, :3]).max() < 1e-6


@given(poses)
@settings(max_examples=100, deadline=None)
def test_inverse_kinematics_puts_the_tool_there_within_the_limits(pose: ToolPose) -> None:
    position, rotation = frame_of(pose)
    joints = ARM.solve(ARM.towards(position), position, rotation)
    reached, turned = ARM.forward(joints)
    assert np.abs(reached - position).max() < 1e-4
    assert np.abs(turned - rotation).max() < 1e-3
    assert (joints >= ARM.lower).all()
    assert (joints <= ARM.upper).all()


def test_what_is_too_far_is_unreachable() -> None:
    position, rotation = frame_of(ToolPose(1.2, 0.0, 0.1, 0.0))
    with pytest.raises(Unreachable, match="mm short"):
        ARM.solve(ARM.home, position, rotation)


@given(poses, poses)
@settings(max_examples=25, deadline=None)
def test_a_motion_keeps_the_speed_limits_and_ends_at_its_goal(start: ToolPose, goal: ToolPose) -> None:
    position, rotation = frame_of(start)
    joints = ARM.solve(ARM.towards(position), position, rotation)
    try:
        motion = plan(ARM, joints, goal, LIMITS, SPEED)
    except Unreachable:
        reject()
    path = np.vstack([joints, motion.joints])
    speeds = np.abs(np.diff(path, axis=0)) / TICK
    assert (speeds <= LIMITS).all()
    assert (path >= ARM.lower).all()
    assert (path <= ARM.upper).all()
    reached, _ = ARM.forward(path[-1])
    assert np.abs(reached - frame_of(goal)[0]).max() < 1e-3
    tool = np.array([ARM.forward(row)[0] for row in path])
    assert np.linalg.norm(np.diff(tool, axis=0), axis=1).max() / TICK < 1.1 * SPEED


@given(st.floats(-3, 3), st.floats(0.3, 0.6), st.floats(-pi, pi))
def test_fingers_close_along_the_wanted_direction(bearing: float, radius: float, closing: float) -> None:
    point = np.array([radius * cos(bearing), radius * sin(bearing), 0.2])
    _, rotation = frame_of(tool_pose(Pose((0.0, 0.0, 0.0)), point, closing))
    along = np.array([cos(closing), sin(closing), 0.0])
    assert abs(abs(float(rotation[:, 1] @ along)) - 1.0) < 1e-9
