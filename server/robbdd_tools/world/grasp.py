"""Grasps of an object from above."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot, pi
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.api import Shape, ShapeKind
from robbdd_tools.world.errors import BehaviourError

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, ObjectModel

ROUND = 8
"""Number of directions tried on a round object."""
PLAY = 0.004
"""Minimum clearance (m) between an object and the open gripper."""
DEPTH = 0.030
"""Maximum depth (m) of the tool below an object's top: the length of the fingers."""


@dataclass(frozen=True, slots=True)
class Grasp:
    """The tool's position (3,) m, the direction (rad) across the tool, and the object's width there (m).

    Fingers close along this direction. ``below`` is the object's extent below the tool, m.
    """

    position: FloatArray
    closing: float
    width: float
    below: float


def finger_grasps(
    name: str, model: ObjectModel, position: FloatArray, rotation: FloatArray, stroke: float
) -> list[Grasp]:
    """Return the grasps of an object at a pose for a gripper with this ``stroke`` (m).

    Raises ``BehaviourError`` when the object is wider than the gripper opens.
    """
    center, directions, top = _highest(model, position, rotation)
    grip = np.array([center[0], center[1], max(float(center[2]), top - DEPTH)])
    below = float(grip[2]) - _bottom(model, position, rotation)
    fitting = [Grasp(grip, angle, width, below) for angle, width in directions if width + PLAY <= stroke]
    if not fitting:
        narrowest = min(width for _, width in directions)
        raise BehaviourError(f"{name} is {narrowest:.3f} m wide, the gripper opens {stroke:.3f} m")
    return fitting


def suction_grasps(
    name: str, model: ObjectModel, position: FloatArray, rotation: FloatArray, diameter: float
) -> list[Grasp]:
    """Return the grasps on the top of an object at a pose for a suction cup of this ``diameter`` (m).

    Raises ``BehaviourError`` when the object is smaller than the cup.
    """
    center, directions, top = _highest(model, position, rotation)
    narrowest = min(width for _, width in directions)
    if narrowest < diameter:
        raise BehaviourError(f"{name} is {narrowest:.3f} m wide, the suction cup {diameter:.3f} m")
    touch = np.array([center[0], center[1], top])
    below = top - _bottom(model, position, rotation)
    return [Grasp(touch, angle, narrowest, below) for angle, _ in _all_round(narrowest)]


def _highest(
    model: ObjectModel, position: FloatArray, rotation: FloatArray
) -> tuple[FloatArray, list[tuple[float, float]], float]:
    """Return centre (3,) m, closing directions (rad, width in m) and top (m) of the part to grip.

    This is the highest part directly above or below the object's position: a neck, but not the wall of a bin.
    """
    best: tuple[FloatArray, list[tuple[float, float]], float] | None = None
    for shape in model.shapes:
        center = position + rotation @ np.array(shape.position)
        directions, half_height = _directions(shape, rotation)
        top = float(center[2]) + half_height
        aside = hypot(*(center - position)[:2]) > min(width for _, width in directions) / 2
        if best is None or (top > best[2] and not aside):
            best = (center, directions, top)
    assert best is not None
    return best


def _bottom(model: ObjectModel, position: FloatArray, rotation: FloatArray) -> float:
    """Return the height (m) of an object's lowest point."""
    centers = (float(position[2] + rotation[2] @ np.array(shape.position)) for shape in model.shapes)
    return min(z - _directions(shape, rotation)[1] for z, shape in zip(centers, model.shapes, strict=True))


def _directions(shape: Shape, rotation: FloatArray) -> tuple[list[tuple[float, float]], float]:
    """Return closing directions (rad, width in m) of a shape, and half its height in this orientation (m)."""
    if shape.kind is ShapeKind.SPHERE:
        radius = shape.size[0]
        return _all_round(2 * radius), radius
    size = np.array(shape.size)
    if shape.kind is ShapeKind.CYLINDER:
        radius, half = shape.size[0], shape.size[1]
        if abs(rotation[2, 2]) > 0.7:
            return _all_round(2 * radius), half
        return [(atan2(rotation[1, 2], rotation[0, 2]) + pi / 2, 2 * radius)], radius
    up = int(np.argmax(np.abs(rotation[2])))
    flat = [axis for axis in range(3) if axis != up]
    return [(atan2(rotation[1, axis], rotation[0, axis]), 2 * float(size[axis])) for axis in flat], float(size[up])


def _all_round(width: float) -> list[tuple[float, float]]:
    return [(pi * step / ROUND, width) for step in range(ROUND)]
