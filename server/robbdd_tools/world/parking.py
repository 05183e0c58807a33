"""Find the place where an idle arm waits for others."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, pi
from typing import TYPE_CHECKING

from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.motion import frame_of, present_pose
from robbdd_tools.world.reaching import at_travel

if TYPE_CHECKING:
    from robbdd_tools.world.motion import ToolPose
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation

ASIDE = (pi / 2, -pi / 2, 0.0)
"""The tool waits at places that are turned by these angles (rad) from home about the base's axis, best first."""
AHEAD = 1e-6
"""Two places are equally good if their distances differ by at most this (m)."""


def parking_pose(simulation: Simulation, robot: Robot) -> ToolPose | None:
    """Return the tool pose in which an arm is out of the way of the others, ``None`` if it has none.

    Because most tools are above the table at home, this is the home pose turned by a quarter turn, to the side that is
    farther from the bases of the others, or else the home pose. It is collision-free and not below the travelling
    height.
    """
    home = at_travel(robot, present_pose(arm_of(robot.model), arm_of(robot.model).home))
    clearance = Clearance(simulation, robot, "", simulation.data)
    places = [replace(home, bearing=home.bearing + turn) for turn in ASIDE]
    # Sorting is stable: of two equally good sides, all arms choose the same one.
    places[:2] = sorted(places[:2], key=lambda pose: -round(_distance(simulation, robot, pose) / AHEAD))
    return next((pose for pose in places if _is_free(robot, pose, clearance)), None)


def _distance(simulation: Simulation, robot: Robot, pose: ToolPose) -> float:
    """Return the distance (m) of a tool pose from the nearest base of another arm, or from its shoulder beside it."""
    place = robot.base.at(_in_base(pose)).position
    others = (
        other.base.at((0.0, arm_of(other.model).aside, 0.0)).position
        for other in simulation.robots.values()
        if other is not robot
    )
    return min((hypot(place[0] - x, place[1] - y) for x, y, _ in others), default=0.0)


def _in_base(pose: ToolPose) -> tuple[float, float, float]:
    x, y, z = frame_of(pose)[0].tolist()
    return (x, y, z)


def _is_free(robot: Robot, pose: ToolPose, clearance: Clearance) -> bool:
    arm = arm_of(robot.model)
    position, rotation = frame_of(pose)
    try:
        return clearance.hit(arm.solve(arm.towards(position), position, rotation)).depth == 0.0
    except Unreachable:
        return False
