"""Add robots to the world: whole ones on their pedestals, and arms that share what carries them."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.joined_arms import JoinedArms, joined_arms
from robbdd_tools.world.mobile_base import base_of, drive_by_servos
from robbdd_tools.world.placement import FLOOR
from robbdd_tools.world.robot_specs import load_robot
from robbdd_tools.world.self_collision import name_bodies, pairs_apart
from robbdd_tools.world.tilted_base import UPRIGHT, rotation_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import RobotModel
    from robbdd_tools.world.pose import Pose

THINGS = 1
"""Collision group (bit) of objects; the n-th robot has the bit ``2 << n``."""
COLUMN = "robbdd-column"
"""Name of the body of the pedestal, which is added to the bodies of the robot's file."""
LOW = 1e-3
"""An arm whose base is less than twice this high (m) above the floor stands on the floor."""


def add_robots(spec: Any, agents: Mapping[str, RobotModel], bases: Mapping[str, Pose]) -> None:
    """Add the robots of all agents to a world. Agents that are arms of one robot share what carries them."""
    joined = joined_arms(agents, bases)
    for index, (name, robot) in enumerate(agents.items()):
        own = next((one for one in joined if name in one.arms), None)
        _add_robot(spec, name, robot, bases[name], index, len(bases), own)
    for one in joined:
        _add_carrier(spec, one, agents, bases)


def _add_robot(
    spec: Any, name: str, robot: RobotModel, base: Pose, index: int, count: int, joined: JoinedArms | None
) -> None:
    """Add a robot, or one of several arms that are ``joined``."""
    child = load_robot(robot)
    name_bodies(child)
    apart, beside_base = _pairs_apart(robot)
    robots = sum(2 << other for other in range(count))
    if joined is not None:
        joined.keep_arm(child, name)
    for geom in child.geoms:
        if geom.contype or geom.conaffinity:
            geom.contype = 2 << index
            geom.conaffinity = THINGS | robots
    mobile = base_of(robot)
    if mobile is not None:
        drive_by_servos(child, mobile)
    driven = robot.joints if mobile is None else (*robot.joints, *mobile.joints)
    for servo in child.actuators:
        if servo.target in driven:
            # The control input is the speed of the target: a target that jumps with every tick would shake the arm.
            servo.dyntype = mujoco.mjtDyn.mjDYN_INTEGRATOR
            servo.ctrllimited = False
    attach(spec, child, f"{name}/", _base_frame(spec, base, robot))
    pairs = apart
    if joined is None and _has_column(robot):
        _add_column(spec, name, base, THINGS | robots)
        pairs = [*apart, *((COLUMN, body) for body in beside_base)]
    _exclude(spec, ((f"{name}/{one}", f"{name}/{other}") for one, other in pairs))


def _add_carrier(spec: Any, joined: JoinedArms, agents: Mapping[str, RobotModel], bases: Mapping[str, Pose]) -> None:
    """Add what carries the arms of one robot. It collides with things and robots, as fixed things do."""
    name = next(iter(joined.arms))
    robot, base, robots = agents[name], bases[name], sum(2 << other for other in range(len(bases)))
    child = load_robot(robot)
    name_bodies(child)
    joined.keep_carrier(child)
    for geom in child.geoms:
        if geom.contype or geom.conaffinity:
            geom.contype, geom.conaffinity = THINGS, THINGS | robots
    attach(spec, child, f"{joined.name}/", _base_frame(spec, base, robot))
    found = {agent: _pairs_apart(agents[agent]) for agent in joined.arms}
    pairs = list(joined.apart(load_robot(robot), {agent: apart for agent, (apart, _) in found.items()}))
    if _has_column(robot):
        _add_column(spec, joined.name, base, THINGS | robots)
        column = f"{joined.name}/{COLUMN}"
        pairs += [
            (column, joined.in_world(body))
            for agent, (_, beside) in found.items()
            for body in beside
            if joined.owner(body) == agent
        ]
    _exclude(spec, pairs)


def _base_frame(spec: Any, base: Pose, robot: RobotModel) -> Any:
    return spec.worldbody.add_frame(pos=list(base.position), quat=rotation_of(base.yaw, robot.tilt))


def _has_column(robot: RobotModel) -> bool:
    """Return whether an arm stands on a pedestal. What carries a tilted or hanging arm is part of the scene."""
    return base_of(robot) is None and robot.tilt == UPRIGHT and not arm_of(robot).hangs


def _exclude(spec: Any, pairs: Iterable[tuple[str, str]]) -> None:
    """Ignore the contacts of pairs of bodies, if there are both."""
    for one, other in dict.fromkeys(pairs):
        if spec.body(one) is not None and spec.body(other) is not None:
            spec.add_exclude(bodyname1=one, bodyname2=other)


def _add_column(spec: Any, name: str, base: Pose, touches: int) -> None:
    """Add the pedestal of a fixed arm; ``touches`` are the collision groups (bits) that it collides with."""
    half = (base.position[2] - FLOOR) / 2
    if half < LOW:
        return
    x, y, z = base.position
    foot = spec.worldbody.add_body(name=f"{name}/{COLUMN}", pos=[x, y, z - half])
    column = foot.add_geom(type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.1, half, 0.0])
    column.contype, column.conaffinity = 0, touches
    column.rgba = [0.45, 0.47, 0.50, 1.0]


def attach(spec: Any, child: Any, prefix: str, frame: Any) -> None:
    """Add a model without its key frames. Where options and sizes of its file differ, the world keeps its own."""
    for key in list(child.keys):
        child.delete(key)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Attach conflict")
        spec.attach(child, prefix=prefix, frame=frame)


@cache
def _pairs_apart(robot: RobotModel) -> tuple[list[tuple[str, str]], list[str]]:
    child = load_robot(robot)
    name_bodies(child)
    return pairs_apart(child, robot)
