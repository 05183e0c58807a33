"""Find the part of a table at which an arm works, and the place of a mobile base at a table."""

from __future__ import annotations

from math import atan2, cos, hypot, inf, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.settings import NORMAL
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.region_frames import pose_along_edges

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, ObjectModel, Region
    from robbdd_tools.catalog.settings import Numbers

Area = tuple[tuple[float, float], tuple[float, float]]
"""Centre and half edges (m) of a rectangle along the world's axes."""
FARTHEST = 2.0
"""No arm reaches a table that is farther (m) from its base."""
EXACT = 1e-9
"""Rounding (m) of points on an edge."""
NEAREST = 0.30
"""If there is room, a mobile base's axis is this far (m) from the side of a workspace at which it works."""


def field_before(base: Pose, table: Pose, model: ObjectModel, area: Numbers = NORMAL) -> Area | None:
    """Return centre and half edges (m) of the part of a table in front of a robot's base, ``None`` if there is none.

    ``area`` (m) has four limits relative to the base: nearest and farthest ahead, rightmost and leftmost (left is
    positive). Edges are parallel to the world's axes: around a table that is turned, the corners are beside it.
    """
    if model.region is None:
        return None
    middle, half = area_of(table, model.region)
    if abs(base.position[1] - middle[1]) > half[1]:
        return _field_before_end(base, middle, half, area)
    side = 1.0 if middle[0] >= base.position[0] else -1.0
    (near, far), (low, high) = (sorted(side * edge for edge in edges) for edges in (area[:2], area[2:]))
    x = _overlap(base.position[0] + near, base.position[0] + far, middle[0], half[0])
    y = _overlap(base.position[1] + low, base.position[1] + high, middle[1], half[1])
    if x is None or y is None:
        return None
    return ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2), ((x[1] - x[0]) / 2, (y[1] - y[0]) / 2)


def is_on(table: Pose, region: Region, x: float, y: float) -> bool:
    """Return whether a point (m, world frame) is above or below a region of a table that may be turned."""
    table = pose_along_edges(table, region)
    mx, my, _ = table.at(region.center).position
    dx, dy, c, s = x - mx, y - my, cos(table.yaw), sin(table.yaw)
    ahead, left = abs(c * dx + s * dy), abs(c * dy - s * dx)
    return ahead <= region.half[0] + EXACT and left <= region.half[1] + EXACT


def area_of(table: Pose, region: Region) -> Area:
    """Return centre and half edges (m) of the rectangle, parallel to the world's axes, around a region of a table."""
    table = pose_along_edges(table, region)
    x, y, _ = table.at(region.center).position
    c, s = abs(cos(table.yaw)), abs(sin(table.yaw))
    long, wide, _ = region.half
    return (x, y), (c * long + s * wide, s * long + c * wide)


def area_within(base: Pose, table: Pose, region: Region) -> Area | None:
    """Return ``area_of`` a region, or ``None`` if all of it is farther from a base than any arm reaches."""
    (x, y), (hx, hy) = area_of(table, region)
    gaps = max(abs(x - base.position[0]) - hx, 0.0), max(abs(y - base.position[1]) - hy, 0.0)
    return None if hypot(*gaps) > FARTHEST else ((x, y), (hx, hy))


def _field_before_end(base: Pose, middle: tuple[float, float], half: tuple[float, float], area: Numbers) -> Area | None:
    """Return the same for a base beyond the left or right end of a table, with its forward direction along y."""
    side = 1.0 if middle[1] >= base.position[1] else -1.0
    (near, far), (low, high) = sorted(side * edge for edge in area[:2]), sorted(-side * edge for edge in area[2:])
    y = _overlap(base.position[1] + near, base.position[1] + far, middle[1], half[1])
    x = _overlap(base.position[0] + low, base.position[0] + high, middle[0], half[0])
    if x is None or y is None:
        return None
    return ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2), ((x[1] - x[0]) / 2, (y[1] - y[0]) / 2)


def _overlap(low: float, high: float, middle: float, half: float) -> tuple[float, float] | None:
    start, end = max(low, middle - half), min(high, middle + half)
    return (start, end) if start < end or low == high == start == end else None


def before_base(base: Pose, table: Pose, model: ObjectModel, place: Pose) -> tuple[float, float]:
    """Return how far (m) a place on a table is ahead of a robot's base and to its left, as in ``field_before``."""
    x, y = (float(there - here) for there, here in zip(place.position[:2], base.position[:2], strict=True))
    middle, half = (table.position[:2], (0.0, inf)) if model.region is None else area_of(table, model.region)
    if abs(base.position[1] - middle[1]) > half[1]:
        side = 1.0 if middle[1] >= base.position[1] else -1.0
        return side * y, -side * x
    side = 1.0 if middle[0] >= base.position[0] else -1.0
    return side * x, side * y


def side_of(rotation: FloatArray, region: Region, side: int) -> tuple[FloatArray, float, float]:
    """Return the outward direction (2,) of a side, its distance from the middle, and half its length (m)."""
    axis = side % 2
    out = rotation[:2, axis] * (1.0 if side < 2 else -1.0)
    return out / np.linalg.norm(out), region.half[axis], region.half[1 - axis]


def place_before(base: Pose, table: Pose, model: ObjectModel) -> Pose:
    """Return where a mobile base will stand at a table: in front of the middle of the side nearest to it now."""
    assert model.region is not None, "only tables with a workspace are in front of a robot"
    table = pose_along_edges(table, model.region)
    turn = np.array([[np.cos(table.yaw), -np.sin(table.yaw)], [np.sin(table.yaw), np.cos(table.yaw)]])
    middle = np.array(table.at(model.region.center).position[:2])
    places: list[tuple[float, Pose]] = []
    for side in range(4):
        out, half, _ = side_of(turn, model.region, side)
        x, y = (middle + (half + NEAREST) * out).tolist()
        gap = float(np.hypot(x - base.position[0], y - base.position[1]))
        places.append((round(gap, 6), Pose((x, y, base.position[2]), atan2(-out[1], -out[0]))))
    return min(places, key=lambda one: one[0])[1]
