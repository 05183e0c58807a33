"""Every arm of the catalog: its kinematics against the published parameters, its motions within its limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.protocol.specs import ConfigSpec
from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.motion import ToolPose, frame_of, plan, tool_pose
from robbdd_tools.world.placement import Pose
from world.worlds import BALL, CUBE, OTHER_WS, SCENE, execution, pick_place

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

ROBOTS = {name: robot for name, robot in load_catalog().robots.items() if base_of(robot) is None}
"""The arms on fixed bases; a test of masses compares the arms of mobile robots with them."""


def classic(d: float, theta: float, a: float, alpha: float) -> FloatArray:
    """Transformation of the standard Denavit-Hartenberg convention."""
    ca, sa, ct, st_ = cos(alpha), sin(alpha), cos(theta), sin(theta)
    rows = [[ct, -st_ * ca, st_ * sa, a * ct], [st_, ct * ca, -ct * sa, a * st_], [0, sa, ca, d], [0, 0, 0, 1]]
    return np.array(rows, dtype=np.float64)


def modified(d: float, theta: float, a: float, alpha: float) -> FloatArray:
    """Transformation of the modified (Craig) convention."""
    ca, sa, ct, st_ = cos(alpha), sin(alpha), cos(theta), sin(theta)
    rows = [[ct, -st_, 0, a], [st_ * ca, ct * ca, -sa, -sa * d], [st_ * sa, ct * sa, ca, ca * d], [0, 0, 0, 1]]
    return np.array(rows, dtype=np.float64)


@dataclass(frozen=True)
class Published:
    """The manufacturer's parameters: d (m), offset (rad), a (m), alpha (rad) of each joint, and the adjacent frames.

    ``base`` is the frame of the first joint's predecessor in the base, ``tool`` the tool in the flange's frame; radius
    and height (m) bound the tried poses below the base's axis.
    """

    link: Callable[[float, float, float, float], FloatArray]
    rows: tuple[tuple[float, float, float, float], ...]
    base: FloatArray
    tool: FloatArray
    radius: tuple[float, float]
    height: tuple[float, float]

    def forward(self, joints: FloatArray) -> FloatArray:
        """Return the tool's frame (4, 4) as the product of the joints' transformations."""
        frame = self.base
        for (d, offset, a, alpha), angle in zip(self.rows, joints, strict=True):
            frame = frame @ self.link(d, float(angle) + offset, a, alpha)
        return frame @ self.tool


PUBLISHED = {
    "franka-panda": Published(
        modified,
        (
            (0.333, 0.0, 0.0, 0.0),
            (0.0, 0.0, 0.0, -pi / 2),
            (0.316, 0.0, 0.0, pi / 2),
            (0.0, 0.0, 0.0825, pi / 2),
            (0.384, 0.0, -0.0825, -pi / 2),
            (0.0, 0.0, 0.0, pi / 2),
            (0.0, 0.0, 0.088, pi / 2),
        ),
        np.eye(4),
        modified(0.107 + 0.1034, -pi / 4, 0.0, 0.0),
        (0.32, 0.65),
        (-0.05, 0.25),
    ),
    "ur10": Published(
        classic,
        (
            (0.1273, 0.0, 0.0, pi / 2),
            (0.0, 0.0, -0.612, 0.0),
            (0.0, 0.0, -0.5723, 0.0),
            (0.163941, 0.0, 0.0, pi / 2),
            (0.1157, 0.0, 0.0, -pi / 2),
            (0.0922, 0.0, 0.0, 0.0),
        ),
        # The base is turned by half a turn; the cup is at the end of a tube.
        np.diag([-1.0, -1.0, 1.0, 1.0]),
        classic(0.16, 0.0, 0.0, 0.0),
        (0.25, 0.9),
        (-0.1, 0.3),
    ),
    "ur5e": Published(
        classic,
        (
            (0.1625, 0.0, 0.0, pi / 2),
            (0.0, 0.0, -0.425, 0.0),
            (0.0, 0.0, -0.3922, 0.0),
            (0.1333, 0.0, 0.0, pi / 2),
            (0.0997, 0.0, 0.0, -pi / 2),
            (0.0996, 0.0, 0.0, 0.0),
        ),
        # The base is turned by half a turn.
        np.diag([-1.0, -1.0, 1.0, 1.0]),
        classic(0.12, 0.0, 0.0, 0.0),
        (0.25, 0.65),
        (-0.1, 0.3),
    ),
    "kinova-gen3": Published(
        classic,
        (
            (-(0.1564 + 0.1284), 0.0, 0.0, pi / 2),
            (-(0.0054 + 0.0064), pi, 0.0, pi / 2),
            (-(0.2104 + 0.2104), pi, 0.0, pi / 2),
            (-(0.0064 + 0.0064), pi, 0.0, pi / 2),
            (-(0.2084 + 0.1059), pi, 0.0, pi / 2),
            (0.0, pi, 0.0, pi / 2),
            (-(0.1059 + 0.0615), pi, 0.0, pi),
        ),
        classic(0.0, 0.0, 0.0, pi),
        classic(0.12, 0.0, 0.0, 0.0),
        (0.30, 0.65),
        (-0.12, 0.1),
    ),
}
every_robot = pytest.mark.parametrize("name", list(ROBOTS))


def poses(published: Published) -> st.SearchStrategy[ToolPose]:
    turns = st.floats(-pi / 2, pi / 2)
    return st.builds(ToolPose, st.floats(*published.radius), st.floats(-2.4, 2.4), st.floats(*published.height), turns)


def test_every_arm_is_compared_with_what_its_maker_publishes() -> None:
    assert PUBLISHED.keys() == ROBOTS.keys()


@every_robot
@given(data=st.data())
@settings(max_examples=200)
def test_forward_kinematics_is_the_product_of_the_published_parameters(name: str, data: st.DataObject) -> None:
    arm = arm_of(ROBOTS[name])
    count = len(arm.home)
    shares = data.draw(st.lists(st.floats(0, 1), min_size=count, max_size=count))
    joints = arm.lower + np.array(shares) * (arm.upper - arm.lower)
    position, rotation = arm.forward(joints)
    expected = PUBLISHED[name].forward(joints)
    assert np.abs(position - expected[:3, 3]).max() < 1e-6
    assert np.abs(rotation - expected[:3, :3]).max() < 1e-6


@every_robot
@given(data=st.data())
@settings(max_examples=100)
def test_inverse_kinematics_puts_the_tool_there_within_the_limits(name: str, data: st.DataObject) -> None:
    arm = arm_of(ROBOTS[name])
    position, rotation = frame_of(data.draw(poses(PUBLISHED[name])))
    joints = arm.solve(arm.towards(position), position, rotation)
    reached, turned = arm.forward(joints)
    assert np.abs(reached - position).max() < 1e-4
    assert np.abs(turned - rotation).max() < 1e-3
    assert (joints >= arm.lower).all()
    assert (joints <= arm.upper).all()


@every_robot
def test_at_home_the_tool_points_down_straight_ahead(name: str) -> None:
    arm = arm_of(ROBOTS[name])
    position, rotation = arm.forward(arm.home)
    assert 0.25 < position[0] < 0.5
    assert abs(position[1]) < 1e-3
    assert rotation == pytest.approx(np.diag([1.0, -1.0, -1.0]), abs=1e-3)


@every_robot
def test_what_is_too_far_is_unreachable(name: str) -> None:
    arm = arm_of(ROBOTS[name])
    with pytest.raises(Unreachable, match="mm short"):
        arm.solve(arm.home, *frame_of(ToolPose(1.6, 0.0, 0.1, 0.0)))


@every_robot
@given(data=st.data())
@settings(max_examples=25)
def test_a_motion_keeps_the_speed_limits_and_ends_at_its_goal(name: str, data: st.DataObject) -> None:
    robot = ROBOTS[name]
    arm, limits, speed = arm_of(robot), np.array(robot.velocity_limits), robot.tool_speed
    start, goal = data.draw(poses(PUBLISHED[name])), data.draw(poses(PUBLISHED[name]))
    position, rotation = frame_of(start)
    joints = arm.solve(arm.towards(position), position, rotation)
    try:
        motion = plan(arm, joints, goal, limits, speed)
    except Unreachable:
        reject()
    path = np.vstack([joints, motion.joints])
    speeds = np.abs(np.diff(path, axis=0)) / TICK
    assert (speeds <= limits).all()
    assert (path >= arm.lower).all()
    assert (path <= arm.upper).all()
    reached, _ = arm.forward(path[-1])
    assert np.abs(reached - frame_of(goal)[0]).max() < 1e-3
    tool = np.array([arm.forward(row)[0] for row in path])
    assert np.linalg.norm(np.diff(tool, axis=0), axis=1).max() / TICK < 1.1 * speed


def test_where_a_joint_comes_to_its_limit_the_tool_stays_on_its_path() -> None:
    """So near to its base, the Panda's elbow has to turn aside; straight ahead, the path leads to another posture."""
    robot = ROBOTS["franka-panda"]
    arm, limits = arm_of(robot), np.array(robot.velocity_limits)
    above = ToolPose(0.2554, 0.1582, 0.150, -0.3571)
    at = replace(above, height=-0.0343)
    joints = plan(arm, arm.home, above, limits, robot.tool_speed).joints[-1]
    for goal in (at, above):
        motion = plan(arm, joints, goal, limits, robot.tool_speed)
        radii = [float(np.hypot(*arm.forward(row)[0][:2])) for row in motion.joints]
        assert np.abs(np.array(radii) - above.radius).max() < 0.01
        joints = motion.joints[-1]


@given(st.floats(-3, 3), st.floats(0.3, 0.6), st.floats(-pi, pi))
def test_fingers_close_along_the_wanted_direction(bearing: float, radius: float, closing: float) -> None:
    point = np.array([radius * cos(bearing), radius * sin(bearing), 0.2])
    _, rotation = frame_of(tool_pose(Pose((0.0, 0.0, 0.0)), point, closing))
    along = np.array([cos(closing), sin(closing), 0.0])
    assert abs(abs(float(rotation[:, 1] @ along)) - 1.0) < 1e-9


@pytest.mark.physics
@pytest.mark.parametrize("speed", ["0.5", "3"])
@pytest.mark.parametrize(("thing", "seed"), [(BALL, 1), (CUBE, 5)])
@every_robot
def test_position_velocity_and_torque_stay_within_the_published_limits(
    name: str, thing: str, seed: int, speed: str
) -> None:
    """Even when the tool is asked to be faster than the joints can be."""
    robot, agent = ROBOTS[name], f"env:{ROBOTS[name].prefixes[0]}"
    config = (
        ConfigSpec(OTHER_WS, "height_scale", "0.8"),
        ConfigSpec(agent, "ee_speed", speed),
    )
    run = execution([pick_place(thing, OTHER_WS, agent)], replace(SCENE, agents=(agent,), config=config), seed)
    simulation = run.simulation
    places = simulation.robots[agent]
    angles: list[FloatArray] = []
    speeds: list[FloatArray] = []
    torques: list[FloatArray] = []

    def look() -> None:
        angles.append(simulation.joint_positions(places))
        speeds.append(np.abs(simulation.data.qvel[places.speeds]))
        torques.append(np.abs(simulation.data.qfrc_actuator[places.speeds]))

    simulation.watchers.append(look)
    run.advance_until(lambda _: False)
    assert run.completed == 1
    arm = arm_of(robot)
    assert (np.min(angles, axis=0) >= arm.lower).all()
    assert (np.max(angles, axis=0) <= arm.upper).all()
    assert (np.max(speeds, axis=0) <= robot.velocity_limits).all()
    assert (np.max(torques, axis=0) <= robot.torque_limits).all()
    assert np.max(speeds) > 0.5
    assert np.max(torques) > 1.0
