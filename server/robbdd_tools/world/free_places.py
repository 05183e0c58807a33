"""Random places that are free: apart from other objects, bins and fixed shapes, and in front of the robot."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import atan2, cos, hypot, sin
from typing import TYPE_CHECKING

from robbdd_tools.world.errors import NoRoomLeft
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.working_area import is_on

if TYPE_CHECKING:
    import numpy as np

    from robbdd_tools.catalog.api import ObjectModel, Region, Vector
    from robbdd_tools.world.fixed_obstacles import Obstacle

BEARING = 2.6
"""Objects are placed where an arm turns by at most this angle (rad) to either side of straight ahead."""
TOUCHING = 0.002
"""Room (m) around objects if there is no space for more."""
TRIES = 400


@dataclass(frozen=True, slots=True)
class Field:
    """A rectangle to draw positions from: centre and half edges (m, world frame), and height (m) of objects there.

    ``yaw`` (rad) turns the rectangle and the objects; ``skew`` bounds their rotation (rad) from there. ``gap`` and
    ``wall_gap`` are distances (m) to other objects and to bins; in a bin there is no ``wall_gap``. ``base`` is the base
    of the robot that works there. ``obstacles`` are fixed shapes to keep clear of. ``on`` is the carrier's pose with
    the region above which objects stay, if the rectangle is larger; if it is ``apart``, such as a nest, what is beside
    the region is not in the way.
    """

    center: tuple[float, float]
    half: tuple[float, float]
    height: float
    skew: float
    gap: float
    wall_gap: float | None
    base: Pose
    obstacles: tuple[Obstacle, ...] = ()
    on: tuple[Pose, Region] | None = None
    yaw: float = 0.0
    apart: bool = False

    @property
    def is_exact(self) -> bool:
        """Return whether the rectangle is a point."""
        return hypot(*self.half) == 0.0

    def at(self, along: float, across: float) -> tuple[float, float]:
        """Return the point (m) at these shares, -1 to 1, of the half edges from the centre."""
        dx, dy, c, s = along * self.half[0], across * self.half[1], cos(self.yaw), sin(self.yaw)
        return self.center[0] + c * dx - s * dy, self.center[1] + s * dx + c * dy

    def has(self, x: float, y: float) -> bool:
        """Return whether a point (m) is above the carrier and before the robot."""
        return (self.on is None or is_on(*self.on, x, y)) and abs(bearing(self.base, x, y)) <= BEARING


@dataclass(frozen=True, slots=True)
class Size:
    """The cylinder around an upright object: its radius, and the height of the object's origin above the bottom, m."""

    radius: float
    rest_height: float


@dataclass(frozen=True, slots=True)
class Taken:
    """The circle (m, world frame) that an object takes up."""

    name: str
    x: float
    y: float
    radius: float

    def is_near(self, x: float, y: float, distance: float) -> bool:
        """Return whether a point is nearer to the circle than ``distance`` (m)."""
        return hypot(x - self.x, y - self.y) < self.radius + distance


@dataclass(frozen=True, slots=True)
class Wall:
    """An object, such as a bin, whose region others keep away from."""

    name: str
    pose: Pose
    model: ObjectModel

    def is_near(self, x: float, y: float, distance: float) -> bool:
        """Return whether a point is nearer to one of the regions than ``distance`` (m)."""
        own = self.model.region
        if own is not None:
            return self._is_near(own.half, (0.0, 0.0, 0.0), x, y, distance)
        return any(self._is_near(one.half, one.center, x, y, distance) for one in self.model.parts)

    def _is_near(self, half: Vector, center: Vector, x: float, y: float, distance: float) -> bool:
        yaw = self.pose.yaw
        x, y, c, s = x - self.pose.position[0], y - self.pose.position[1], cos(yaw), sin(yaw)
        dx = max(abs(c * x + s * y - center[0]) - half[0], 0.0)
        dy = max(abs(c * y - s * x - center[1]) - half[1], 0.0)
        return hypot(dx, dy) < distance


def bearing(base: Pose, x: float, y: float) -> float:
    """Return the direction (rad, in (-π, π]) of a point seen from a robot's base, 0 straight ahead."""
    angle = atan2(y - base.position[1], x - base.position[0]) - base.yaw
    return atan2(sin(angle), cos(angle))


def draw_place(
    name: str,
    place: str,
    size: Size,
    fields: Iterable[Field],
    taken: Sequence[Taken],
    walls: Sequence[Wall],
    rng: np.random.Generator,
) -> tuple[Pose, int]:
    """Return a free pose in the first field that has one, and the number of rejected random samples.

    Raises ``NoRoomLeft`` if no field has one; for an exact place, the error names what is in the way.
    """
    rejected = 0
    where = ""
    for field in fields:
        where = f"at '{place}' among {len(taken)} other objects"
        for _ in range(TRIES):
            dx, dy, turn = rng.uniform(-1.0, 1.0, 3)
            x, y = field.at(dx, dy)
            in_the_way = next(_in_the_way(field, size, (x, y), taken, walls), None)
            if in_the_way is None:
                return Pose((x, y, field.height + size.rest_height), field.yaw + turn * field.skew), rejected
            if field.is_exact:
                where = f"at its exact place: {in_the_way}"
            else:
                rejected += 1
    raise NoRoomLeft(name, where)


def _in_the_way(
    field: Field, size: Size, point: tuple[float, float], taken: Sequence[Taken], walls: Sequence[Wall]
) -> Iterator[str]:
    """Yield what makes a point unfit."""
    inside = (one for one in taken if not field.apart or field.has(one.x, one.y))
    near = [one.name for one in inside if one.is_near(*point, size.radius + field.gap)]
    if field.wall_gap is not None:
        near += [one.name for one in walls if one.is_near(*point, size.radius + field.wall_gap)]
    yield from (f"'{name}' is there" for name in near)
    top = field.height + 2.0 * size.rest_height
    if any(one.is_near(*point, size.radius + TOUCHING, field.height, top) for one in field.obstacles):
        yield "a fixed object is there"
    if not field.has(*point):
        yield "it is beside the surface or behind the robot"


def place_above(
    field: Field, walls: Sequence[Wall], radius: float, rng: np.random.Generator
) -> tuple[float, float] | None:
    """Draw a position (m, world frame) above a field, or return ``None`` if it is above a bin or behind the robot."""
    dx, dy = rng.uniform(-1.0, 1.0, 2)
    x, y = field.at(dx, dy)
    free = not any(one.is_near(x, y, radius + TOUCHING) for one in walls)
    return (x, y) if free and field.has(x, y) else None
