"""Fixed shapes around a random place, such as the walls of a fixture: no object is drawn into them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.api import ShapeKind
from robbdd_tools.catalog.object_settings import can_move

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel, Shape, Vector
    from robbdd_tools.world.pose import Pose

RESTING = 1e-3
"""A shape whose top is less than this (m) above the bottom of an object carries it."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """The box, along the world's axes, around a shape of a fixed object: two corners (m, world frame)."""

    low: Vector
    high: Vector

    def is_near(self, x: float, y: float, distance: float, bottom: float, top: float) -> bool:
        """Return whether the box is nearer than ``distance`` to a vertical line from ``bottom`` to ``top``, in m."""
        if self.high[2] < bottom + RESTING or self.low[2] > top:
            return False
        dx = max(self.low[0] - x, x - self.high[0], 0.0)
        dy = max(self.low[1] - y, y - self.high[1], 0.0)
        return hypot(dx, dy) < distance


def fixed_obstacles(objects: Mapping[str, ObjectModel], poses: Mapping[str, Pose], but: str) -> tuple[Obstacle, ...]:
    """Return the shapes of all fixed objects that have a pose, but not those of the carrier ``but``."""
    fixed = ((objects[name], pose) for name, pose in poses.items() if name != but and not can_move(objects[name]))
    return tuple(_around(shape, pose) for model, pose in fixed for shape in model.shapes)


def _around(shape: Shape, pose: Pose) -> Obstacle:
    corners = np.array([pose.at(corner).position for corner in _corners(shape)])
    low, high = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return Obstacle((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def _corners(shape: Shape) -> Iterator[Vector]:
    radius, length, _ = shape.size
    half = {
        ShapeKind.BOX: shape.size,
        ShapeKind.SPHERE: (radius, radius, radius),
        ShapeKind.CYLINDER: (radius, radius, length),
    }[shape.kind]
    for signs in product((-1.0, 1.0), repeat=3):
        x, y, z = (at + sign * size for at, sign, size in zip(shape.position, signs, half, strict=True))
        yield x, y, z
