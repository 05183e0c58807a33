"""Find where a mobile base stands to work at a workspace: in front of one of the workspace's sides."""

from __future__ import annotations

from math import atan2, pi
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.motion import frame_of, tool_pose
from robbdd_tools.world.region_frames import along_edges
from robbdd_tools.world.working_area import NEAREST, side_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation

FARTHEST, SPACING = 0.80, 0.05
"""Distances (m) of the base's axis from a side of the workspace are tried below this limit, this far (m) apart."""
ALONG = (0.0, 0.15, -0.15, 0.30, -0.30, 0.45, -0.45, 0.60, -0.60)
"""Offsets (m) of the base from the middle of the side, tried in this order."""
INSIDE = 0.15
"""The arm must reach a place this far (m) inside the side, or in the middle of a narrower workspace."""
ABOVE = 0.10
"""Height (m) of the place that the arm must reach above the bottom of the workspace."""


def standing_places(
    simulation: Simulation, robot: Robot, workspace: str, is_free: Callable[[FloatArray], bool]
) -> Iterator[FloatArray]:
    """Yield for each side of a workspace the best pose of the base (x m, y m, yaw rad) there, if there is one.

    The base is collision-free and faces the side, and from it the arm reaches a place in the workspace.
    """
    for carrier, region in simulation.world.cast.regions.get(workspace, ()):
        position, rotation = along_edges(simulation.seen_place(carrier), region)
        middle = position + rotation @ np.array(region.center)
        for side in range(4):
            out, half, across = side_of(rotation, region, side)
            bottom = float(middle[2]) - region.half[2] + ABOVE
            found = _before_side(robot, (middle, out, half, across), bottom, is_free)
            if found is not None:
                yield found


def _before_side(
    robot: Robot,
    side: tuple[FloatArray, FloatArray, float, float],
    height: float,
    is_free: Callable[[FloatArray], bool],
) -> FloatArray | None:
    middle, out, half, length = side
    along = np.array([-out[1], out[0]])
    yaw = atan2(-out[1], -out[0])
    for offset in (one for one in ALONG if abs(one) <= length):
        for distance in np.arange(NEAREST, FARTHEST, SPACING).tolist():
            place = middle[:2] + (half + distance) * out + offset * along
            goal = place - (distance + min(half, INSIDE)) * out
            pose = np.array([*place, yaw])
            if not _reaches(robot, pose, np.array([*goal, height])):
                break
            if is_free(pose):
                return pose
    return None


def _reaches(robot: Robot, pose: FloatArray, place: FloatArray) -> bool:
    """Return whether the arm with its base at a pose reaches a place (3,) m with its tool down."""
    assert robot.mobile is not None, "only mobile bases drive"
    arm = arm_of(robot.model)
    base = robot.mobile.frame_at(robot.mobile.positions_at(pose))
    position, rotation = frame_of(tool_pose(base, place, base.yaw + pi / 2))
    try:
        arm.solve(arm.towards(position), position, rotation)
    except Unreachable:
        return False
    return True
