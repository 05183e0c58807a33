"""Objects with a ``drop_height``: they are dropped above a table at a random place and in a random orientation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import atan2
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.extent import bounds_of
from robbdd_tools.world.pose import Pose

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import ObjectModel
    from robbdd_tools.catalog.settings import Numbers

TRIES = 400


@dataclass(frozen=True, slots=True)
class Ball:
    """A sphere around a dropped object, m: objects may lie close to each other, but not in each other."""

    center: tuple[float, float, float]
    radius: float

    def meets(self, other: Ball) -> bool:
        """Return whether two spheres have a point in common."""
        between = np.subtract(self.center, other.center)
        return float(np.linalg.norm(between)) <= self.radius + other.radius


def drop(
    name: str,
    model: ObjectModel,
    heights: Numbers,
    draw_place: Callable[[], tuple[float, float] | None],
    others: Sequence[Ball],
    rng: np.random.Generator,
) -> tuple[Pose, Ball, int]:
    """Return the pose in which an object is released, a sphere around it, and the number of rejected samples.

    ``draw_place`` draws a position (m, world frame), or ``None`` if nothing can be there. The height is uniform between
    ``heights`` (m, world frame), the orientation uniform over all rotations. Raises ``SceneError`` if there is no room.
    """
    low, high = bounds_of(model.shapes)
    radius = float(np.linalg.norm(np.maximum(np.abs(low), np.abs(high))))
    for rejected in range(TRIES):
        place = draw_place()
        height = float(rng.uniform(heights[0], heights[1]))
        w, x, y, z = (float(part) for part in _rotation(rng))
        if place is None:
            continue
        ball = Ball((*place, height), radius)
        if not any(ball.meets(other) for other in others):
            return Pose(ball.center, atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)), (w, x, y, z)), ball, rejected
    raise SceneError(f"there is no room to drop '{name}' among {len(others)} other objects")


def _rotation(rng: np.random.Generator) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return a unit quaternion (w, x, y, z), uniform over all rotations."""
    parts = rng.normal(size=4)
    return parts / np.linalg.norm(parts)
