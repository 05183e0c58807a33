"""Extents of the objects of a scene around their position, which is the centre of their geometry."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.api import ObjectModel, Outline, Region, Shape, ShapeKind, Vector
from robbdd_tools.world.region_frames import bounds_of_box

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

RISES, BESIDE = 0.01, 0.03
"""A wall rises more than 10 mm above the floor of a workspace, at most 30 mm beside it."""
SPACE = 0.15
"""If a file has no site 'workspace', the workspace above the object has this height (m)."""
NARROWEST, WIDEST = 0.02, 0.5
"""The shorter side of a container is between these lengths (m) inside; what is wider is a table with a rim."""
RIM = 16
"""Number of points on each rim of a cylinder: between them, the error is below 2 % of the radius."""


def outline_of(model: ObjectModel) -> Outline:
    """Return the corners of boxes, the rims of cylinders, the centres of spheres with their radius."""
    return tuple(ball for shape in model.shapes for ball in _balls(shape))


def half_sides(model: ObjectModel, rotation: FloatArray) -> tuple[float, float]:
    """Return how far (m) an object with this rotation matrix reaches from its position along x and along y."""
    outline = outline_of(model)
    points = np.abs(np.array([point for point, _ in outline]) @ rotation.T)
    x, y, _ = (points + np.array([radius for _, radius in outline])[:, None]).max(axis=0).tolist()
    return x, y


def bounds_of(shapes: tuple[Shape, ...]) -> tuple[FloatArray, FloatArray]:
    """Return the lowest and the highest corner (m, each of shape (3,)) of the bounding box of shapes, own frame."""
    half = np.array([half_of(shape) for shape in shapes])
    middle = np.array([shape.position for shape in shapes])
    return np.min(middle - half, axis=0), np.max(middle + half, axis=0)


def space_above(low: FloatArray, high: FloatArray) -> Region:
    """Return the workspace above the top of a bounding box, given by two corners (m, each of shape (3,))."""
    (x, y, _), (length, width, _) = (low + high) / 2, high - low
    center = (float(x), float(y), float(high[2]) + SPACE / 2)
    return Region(center, (float(length) / 2, float(width) / 2, SPACE / 2))


def own_space(shapes: tuple[Shape, ...]) -> Region:
    """Return the workspace of an object without a stated one: its inside if it is a container, else the space above it.

    The inside of a container begins on its floor, between walls on all four sides. It is at least ``SPACE`` high, since
    the things in a tray are higher than its rim.
    """
    low, high = bounds_of(shapes)
    return _inside(shapes, low, high) or space_above(low, high)


def _inside(shapes: tuple[Shape, ...], low: FloatArray, high: FloatArray) -> Region | None:
    """Return the space between the walls around the middle of a bounding box, or ``None`` without walls or floor."""
    boxes = [bounds_of((shape,)) for shape in shapes]
    x, y = (float(middle) for middle in (low + high)[:2] / 2)
    floors = [float(top[2]) for bottom, top in boxes if bottom[0] < x < top[0] and bottom[1] < y < top[1]]
    if not floors:
        return None
    floor = max(floors)
    walls = [(bottom, top) for bottom, top in boxes if top[2] > floor + RISES]
    edges: list[list[float]] = []
    for axis, middle in enumerate((x, y)):
        below = [float(top[axis]) for _, top in walls if top[axis] < middle]
        above = [float(bottom[axis]) for bottom, _ in walls if bottom[axis] > middle]
        if not below or not above:
            return None
        edges.append([max(below), min(above)])
    half = np.array([(end - begin) / 2 for begin, end in edges])
    if half.min() < NARROWEST / 2:
        return None
    height = max(SPACE, float(high[2]) - floor)
    center = (sum(edges[0]) / 2, sum(edges[1]) / 2, floor + height / 2)
    found = Region(center, (float(half[0]), float(half[1]), height / 2))
    return with_walls(found, shapes) if _has_walls(found, shapes) else None


def with_walls(region: Region, shapes: tuple[Shape, ...]) -> Region:
    """Return a workspace of an object with these shapes, walled if a wall rises above its floor on all four sides.

    A wide one is a table with a rim, on which an arm works as on other tables.
    """
    is_wide = 2 * min(region.half[:2]) > WIDEST
    return replace(region, walled=not is_wide and _has_walls(region, shapes))


def _has_walls(region: Region, shapes: tuple[Shape, ...]) -> bool:
    boxes = [bounds_of((shape,)) for shape in shapes]
    center, half = np.array(region.center), bounds_of_box(region)
    bottom = center[2] - half[2]
    high = [(one, other) for one, other in boxes if one[2] < bottom + half[2] and other[2] > bottom + RISES]
    for axis, along in ((0, 1), (1, 0)):
        for side in (-1, 1):
            face = center[axis] + side * half[axis]
            beside = [box for box in high if box[0][axis] - BESIDE <= face <= box[1][axis] + BESIDE]
            outer = [box for box in beside if side * (box[0][axis] + box[1][axis]) / 2 >= side * face]
            first, last = center[along] - half[along], center[along] + half[along]
            lengths = (min(other[along], last) - max(one[along], first) for one, other in outer)
            if sum(length for length in lengths if length > 0.0) < half[along]:
                return False
    return True


def carrying(model: ObjectModel) -> ObjectModel:
    """Return an object that carries a workspace. If its model has none, this is its inside or the space above it."""
    if model.region is not None or model.parts:
        return model
    return replace(model, region=own_space(model.shapes))


def centred(model: ObjectModel) -> ObjectModel:
    """Return an object with its origin in the centre of its bounding box."""
    low, high = bounds_of(model.shapes)
    dx, dy, dz = (float(middle) for middle in (low + high) / 2)

    def moved(place: Vector) -> Vector:
        return (place[0] - dx, place[1] - dy, place[2] - dz)

    def moved_region(region: Region) -> Region:
        return replace(region, center=moved(region.center))

    return replace(
        model,
        shapes=tuple(replace(shape, position=moved(shape.position)) for shape in model.shapes),
        inertia=None if model.inertia is None else replace(model.inertia, center=moved(model.inertia.center)),
        rest_height=float(high[2] - low[2]) / 2,
        region=None if model.region is None else moved_region(model.region),
        parts=tuple(map(moved_region, model.parts)),
        frame=moved(model.frame),
    )


def half_of(shape: Shape) -> Vector:
    """Return half the edges (m) of a shape's bounding box in its own frame."""
    a, b, _ = shape.size
    match shape.kind:
        case ShapeKind.SPHERE:
            return a, a, a
        case ShapeKind.CYLINDER:
            return a, a, b
        case ShapeKind.BOX:
            return shape.size


def _balls(shape: Shape) -> Iterator[tuple[Vector, float]]:
    a, b, c = shape.size
    x, y, z = shape.position
    match shape.kind:
        case ShapeKind.SPHERE:
            yield shape.position, a
        case ShapeKind.BOX:
            for sx, sy, sz in product((-1, 1), repeat=3):
                yield (x + sx * a, y + sy * b, z + sz * c), 0.0
        case ShapeKind.CYLINDER:
            for side, step in product((-1, 1), range(RIM)):
                angle = 2 * pi * step / RIM
                yield (x + a * cos(angle), y + a * sin(angle), z + side * b), 0.0
