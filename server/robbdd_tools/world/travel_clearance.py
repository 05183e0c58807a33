"""Heights at which a tool carries an object over the shapes below its path."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, cos, hypot, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.extent import half_of, outline_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.motion import ToolPose
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation

SPACING = 0.02
"""Distance (m) between the points of a path that are examined."""
UPRIGHT = 0.999
"""A shape's own frame is used from this cosine of its tilt on, else the box around it along the world's axes."""


def height_over(simulation: Simulation, robot: Robot, name: str, start: ToolPose, goal: ToolPose) -> float:
    """Return the height (m) above the robot's base of the highest shape below the path of a carried object.

    The path from ``start`` to ``goal`` is straight in cylinder coordinates, like the path of a motion.
    """
    radius = _radius(simulation, name)
    points = np.array(list(_points(robot, start, goal)))
    others = (other for other in simulation.world.cast.objects if other != name)
    tops = (top for other in others for _, top in _levels(simulation, other, points, radius))
    return max(tops, default=-np.inf) - robot.base.position[2]


def is_roofed(simulation: Simulation, robot: Robot, name: str, at: ToolPose) -> bool:
    """Return whether something is above an object, or above the place where a tool at ``at`` would hold it."""
    radius, height = _radius(simulation, name), at.height + robot.base.position[2]
    points = np.array(list(_points(robot, at, at)))
    others = (other for other in simulation.world.cast.objects if other != name)
    return any(bottom > height for other in others for bottom, _ in _levels(simulation, other, points, radius))


def _points(robot: Robot, start: ToolPose, goal: ToolPose) -> Iterator[tuple[float, float]]:
    """Yield the places (m, world frame) of the tool along a path."""
    x, y, _ = robot.base.position
    turned = max(start.radius, goal.radius) * abs(goal.bearing - start.bearing)
    count = max(1, ceil(hypot(goal.radius - start.radius, turned) / SPACING))
    for share in np.linspace(0.0, 1.0, count + 1).tolist():
        reach = start.radius + share * (goal.radius - start.radius)
        direction = robot.base.yaw + start.bearing + share * (goal.bearing - start.bearing)
        yield x + reach * cos(direction), y + reach * sin(direction)


def _levels(simulation: Simulation, name: str, points: FloatArray, radius: float) -> Iterator[tuple[float, float]]:
    """Yield bottom and top (m) of those shapes of an object that are nearer to the path than ``radius`` (m)."""
    position, rotation = simulation.pose(name)
    upright = rotation[2, 2] > UPRIGHT
    turn = rotation[:2, :2] if upright else np.eye(2)
    flat = (points - position[:2]) @ turn
    for shape in simulation.world.cast.objects[name].shapes:
        place, half = rotation @ np.array(shape.position), np.abs(rotation) @ np.array(half_of(shape))
        sides = np.array(half_of(shape))[:2] if upright else half[:2]
        middle = np.array(shape.position)[:2] if upright else place[:2]
        beside = np.maximum(np.abs(flat - middle) - sides, 0.0)
        if np.hypot(beside[:, 0], beside[:, 1]).min() < radius:
            middle_height = float(position[2] + place[2])
            yield middle_height - float(half[2]), middle_height + float(half[2])


def _radius(simulation: Simulation, name: str) -> float:
    """Return the radius (m) of the upright cylinder about an object's position that encloses its present pose."""
    _, rotation = simulation.pose(name)
    return max(
        hypot(*(rotation @ np.array(point))[:2]) + radius
        for point, radius in outline_of(simulation.world.cast.objects[name])
    )
