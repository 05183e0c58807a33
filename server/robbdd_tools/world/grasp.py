"""Grasps of an object from above."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import atan2, hypot, inf, pi
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
RISES, LEAST_DEPTH = (0.005, 0.01, 0.015, 0.02), 0.008
"""Where the fingers have no room, an object is gripped this much (m) higher, but at least so far below its top."""
OTHER_PARTS = 4
"""Number of parts beside an object's middle that are tried."""
FINGER = 0.01
"""Room (m) for a finger beside a part."""


@dataclass(frozen=True, slots=True)
class Grasp:
    """The tool's position (3,) m, the direction (rad) across the tool, and the object's width there (m).

    Fingers close along this direction. ``below`` is the object's extent below the tool, m. ``aside`` is the horizontal
    way from the tool to the place of the object's position, m, world frame; 0 for the part in the object's middle.
    ``part`` is the number of the shape to grip if it is another one. ``depth`` is how far the tool is below the top, m.
    """

    position: FloatArray
    closing: float
    width: float
    below: float
    aside: tuple[float, float] = (0.0, 0.0)
    part: int | None = None
    depth: float = 0.0

    def higher(self) -> Iterator[Grasp]:
        """Yield the same grasp nearer to the top, as long as the fingers hold enough of the object."""
        for rise in RISES:
            if self.depth - rise >= LEAST_DEPTH:
                up = np.array([0.0, 0.0, rise])
                yield replace(self, position=self.position + up, below=self.below + rise, depth=self.depth - rise)


def finger_grasps(
    name: str, model: ObjectModel, position: FloatArray, rotation: FloatArray, stroke: float, closed: float = 0.0
) -> list[Grasp]:
    """Return the grasps of an object at a pose for a gripper that opens to ``stroke`` and closes to ``closed`` (m).

    Those of the part in the object's middle come first, then those of up to ``OTHER_PARTS`` parts beside it. Raises
    ``BehaviourError`` when the object is wider than the gripper opens, or narrower than it closes.
    """
    middle = _middle(model, position, rotation)
    fitting: list[Grasp] = []
    narrowest, widest = inf, 0.0
    for index in (middle, *_parts_beside(model, position, rotation, middle)):
        shape = model.shapes[index]
        center = position + rotation @ np.array(shape.position)
        directions, half_height = _directions(shape, rotation)
        grip = np.array([center[0], center[1], max(float(center[2]), float(center[2]) + half_height - DEPTH)])
        below = float(grip[2]) - _bottom(model, position, rotation)
        aside = (0.0, 0.0) if index == middle else (float(position[0] - grip[0]), float(position[1] - grip[1]))
        part = None if index == middle else index
        fits = ((angle, width) for angle, width in directions if closed < width and width + PLAY <= stroke)
        depth = float(center[2]) + half_height - float(grip[2])
        fitting += [Grasp(grip, angle, width, below, aside, part, depth) for angle, width in fits]
        narrowest = min(narrowest, *(width for _, width in directions))
        widest = max(widest, *(width for _, width in directions))
    if not fitting:
        if widest <= closed:
            raise BehaviourError(f"{name} is {widest:.3f} m wide, the gripper closes to {closed:.3f} m")
        play = "" if narrowest > stroke else f"; with {1000 * PLAY:g} mm of play, that is too little"
        raise BehaviourError(f"{name} is {narrowest:.3f} m wide, the gripper opens {stroke:.3f} m{play}")
    return fitting


def suction_grasps(
    name: str, model: ObjectModel, position: FloatArray, rotation: FloatArray, diameter: float
) -> list[Grasp]:
    """Return the grasps on the top of an object at a pose for a suction cup of this ``diameter`` (m).

    Raises ``BehaviourError`` when the object is smaller than the cup.
    """
    shape = model.shapes[_middle(model, position, rotation)]
    center = position + rotation @ np.array(shape.position)
    directions, half_height = _directions(shape, rotation)
    top = float(center[2]) + half_height
    narrowest = min(width for _, width in directions)
    if narrowest < diameter:
        raise BehaviourError(f"{name} is {narrowest:.3f} m wide, the suction cup {diameter:.3f} m")
    touch = np.array([center[0], center[1], top])
    below = top - _bottom(model, position, rotation)
    return [Grasp(touch, angle, narrowest, below) for angle, _ in _all_round(narrowest)]


def _middle(model: ObjectModel, position: FloatArray, rotation: FloatArray) -> int:
    """Return the number of the highest shape directly above or below the object's position.

    This is a neck, but not the wall of a bin.
    """
    best, best_top = 0, -inf
    for index, shape in enumerate(model.shapes):
        center = position + rotation @ np.array(shape.position)
        directions, half_height = _directions(shape, rotation)
        top = float(center[2]) + half_height
        aside = hypot(*(center - position)[:2]) > min(width for _, width in directions) / 2
        if index == 0 or (top > best_top and not aside):
            best, best_top = index, top
    return best


def _parts_beside(model: ObjectModel, position: FloatArray, rotation: FloatArray, middle: int) -> list[int]:
    """Return the numbers of other shapes with nothing of the object above them or beside them, nearest first.

    What carries other things has none: it is not moved by its walls.
    """
    if not model.graspable:
        return []
    centers = [position + rotation @ np.array(shape.position) for shape in model.shapes]
    sizes = [_directions(shape, rotation) for shape in model.shapes]
    tops = [float(center[2]) + half for center, (_, half) in zip(centers, sizes, strict=True)]

    def is_free(index: int) -> bool:
        room = min(width for _, width in sizes[index][0]) / 2 + FINGER
        above = (other for other in range(len(tops)) if other != index and tops[other] > tops[index] - FINGER)
        return all(
            hypot(*(centers[other] - centers[index])[:2]) >= room + min(width for _, width in sizes[other][0]) / 2
            for other in above
        )

    beside = [index for index in range(len(tops)) if index != middle and is_free(index)]
    return sorted(beside, key=lambda index: hypot(*(centers[index] - position)[:2]))[:OTHER_PARTS]


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
