"""Find the part of a table at which an arm works, and the place of a mobile base at a table."""

from __future__ import annotations

from math import atan2
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.settings import NORMAL
from robbdd_tools.world.pose import Pose

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, ObjectModel, Region
    from robbdd_tools.catalog.settings import Numbers

NEAREST = 0.30
"""If there is room, a mobile base's axis is this far (m) from the side of a workspace at which it works."""


def field_before(
    base: Pose, table: Pose, model: ObjectModel, area: Numbers = NORMAL
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return centre and half edges (m) of the part of a table in front of a robot's base, ``None`` if there is none.

    ``area`` (m) has four limits relative to the base: nearest and farthest ahead, rightmost and leftmost (left is
    positive).
    """
    if model.region is None:
        return None
    if abs(base.position[1] - table.position[1]) > model.region.half[1]:
        return _field_before_end(base, table, model.region, area)
    side = 1.0 if table.position[0] >= base.position[0] else -1.0
    (near, far), (low, high) = (sorted(side * edge for edge in edges) for edges in (area[:2], area[2:]))
    left, ahead, _ = (at + offset for at, offset in zip(table.position, model.region.center, strict=True))
    x = _overlap(base.position[0] + near, base.position[0] + far, left, model.region.half[0])
    y = _overlap(base.position[1] + low, base.position[1] + high, ahead, model.region.half[1])
    if x is None or y is None:
        return None
    return ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2), ((x[1] - x[0]) / 2, (y[1] - y[0]) / 2)


def _field_before_end(
    base: Pose, table: Pose, region: Region, area: Numbers
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return the same for a base beyond the left or right end of a table, with its forward direction along y."""
    side = 1.0 if table.position[1] >= base.position[1] else -1.0
    (near, far), (low, high) = sorted(side * edge for edge in area[:2]), sorted(-side * edge for edge in area[2:])
    y = _overlap(base.position[1] + near, base.position[1] + far, table.position[1], region.half[1])
    x = _overlap(base.position[0] + low, base.position[0] + high, table.position[0], region.half[0])
    if x is None or y is None:
        return None
    return ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2), ((x[1] - x[0]) / 2, (y[1] - y[0]) / 2)


def _overlap(low: float, high: float, middle: float, half: float) -> tuple[float, float] | None:
    start, end = max(low, middle - half), min(high, middle + half)
    return (start, end) if start < end or low == high == start == end else None


def before_base(base: Pose, table: Pose, model: ObjectModel, place: Pose) -> tuple[float, float]:
    """Return how far (m) a place on a table is ahead of a robot's base and to its left, as in ``field_before``."""
    x, y = (float(there - here) for there, here in zip(place.position[:2], base.position[:2], strict=True))
    if model.region is not None and abs(base.position[1] - table.position[1]) > model.region.half[1]:
        side = 1.0 if table.position[1] >= base.position[1] else -1.0
        return side * y, -side * x
    side = 1.0 if table.position[0] >= base.position[0] else -1.0
    return side * x, side * y


def side_of(rotation: FloatArray, region: Region, side: int) -> tuple[FloatArray, float, float]:
    """Return the outward direction (2,) of a side, its distance from the middle, and half its length (m)."""
    axis = side % 2
    out = rotation[:2, axis] * (1.0 if side < 2 else -1.0)
    return out / np.linalg.norm(out), region.half[axis], region.half[1 - axis]


def place_before(base: Pose, table: Pose, model: ObjectModel) -> Pose:
    """Return where a mobile base will stand at a table: in front of the middle of the side nearest to it now."""
    assert model.region is not None, "only tables with a workspace are in front of a robot"
    turn = np.array([[np.cos(table.yaw), -np.sin(table.yaw)], [np.sin(table.yaw), np.cos(table.yaw)]])
    middle = np.array(table.at(model.region.center).position[:2])
    places: list[tuple[float, Pose]] = []
    for side in range(4):
        out, half, _ = side_of(turn, model.region, side)
        x, y = (middle + (half + NEAREST) * out).tolist()
        gap = float(np.hypot(x - base.position[0], y - base.position[1]))
        places.append((round(gap, 6), Pose((x, y, base.position[2]), atan2(-out[1], -out[0]))))
    return min(places, key=lambda one: one[0])[1]
