"""Convert written rotations to unit quaternions (w, x, y, z)."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, sin, sqrt

from robbdd_tools.graph.write.units import ANGLES
from robbdd_tools.syntax import tree

Quaternion = tuple[float, float, float, float]
_SAME = 1e-4
"""Maximum deviation of the dot products of direction cosines from those of orthogonal unit vectors."""


NO_ROTATION: Quaternion = (0.0, 0.0, 0.0, 0.0)
"""Stands for an orientation that is no rotation, so that a run refuses it instead of ignoring it."""


def rotation_of(value: tree.Vector | tree.EulerAngles | tree.Axes) -> Quaternion | None:
    """Return the rotation that a value describes, or ``None`` if its numbers are not a rotation.

    Quaternions are normalised. Euler angles are intrinsic unless stated otherwise; angles without a unit are in rad.
    """
    match value:
        case tree.Vector():
            numbers = numbers_of(value)
            return _unit((numbers[3], *numbers[:3])) if len(numbers) == 4 else None
        case tree.EulerAngles():
            return _from_euler(value)
        case tree.Axes():
            return _from_axes([numbers_of(axis) for axis in (value.x, value.y, value.z)])


def numbers_of(vector: tree.Vector) -> tuple[float, ...]:
    """Return the numbers of a vector or, row by row, of a matrix."""
    found: list[float] = []
    for entry in vector.values:
        found += numbers_of(entry) if isinstance(entry, tree.Vector) else (float(entry.value),)
    return tuple(found)


def _unit(numbers: Sequence[float]) -> Quaternion | None:
    length = hypot(*numbers)
    if length < _SAME:
        return None
    w, x, y, z = (number / length for number in numbers)
    return (w, x, y, z)


def _from_euler(value: tree.EulerAngles) -> Quaternion | None:
    angles, factor = numbers_of(value.angles), ANGLES[value.unit or "rad"]
    if len(angles) != 3:
        return None
    total: Quaternion = (1.0, 0.0, 0.0, 0.0)
    for axis, angle in zip(value.axes or "xyz", angles, strict=True):
        half = angle * factor / 2
        vector = [sin(half) if axis == name else 0.0 for name in "xyz"]
        turn: Quaternion = (cos(half), vector[0], vector[1], vector[2])
        total = product(turn, total) if value.extrinsic else product(total, turn)
    return total


def product(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the rotation ``second`` followed by ``first``."""
    a, b, c, d = first
    w, x, y, z = second
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def _from_axes(axes: list[tuple[float, ...]]) -> Quaternion | None:
    """Return the rotation matrix with these columns as a quaternion. Its largest component is computed first."""
    if any(len(axis) != 3 for axis in axes):
        return None
    x, y, z = axes
    dots = [sum(a * b for a, b in zip(one, other, strict=True)) for one in axes for other in axes]
    expected = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    handed = sum(z[i] * (x[i - 2] * y[i - 1] - x[i - 1] * y[i - 2]) for i in range(3))
    if any(abs(dot - wanted) > _SAME for dot, wanted in zip(dots, expected, strict=True)) or handed < 0:
        return None
    squares = (
        1 + x[0] + y[1] + z[2],
        1 + x[0] - y[1] - z[2],
        1 - x[0] + y[1] - z[2],
        1 - x[0] - y[1] + z[2],
    )
    largest = squares.index(max(squares))
    scale = 2 * sqrt(squares[largest])
    wx, wy, wz = y[2] - z[1], z[0] - x[2], x[1] - y[0]
    xy, xz, yz = x[1] + y[0], x[2] + z[0], y[2] + z[1]
    whole = squares[largest]
    rows = ((whole, wx, wy, wz), (wx, whole, xy, xz), (wy, xy, whole, yz), (wz, xz, yz, whole))
    return _unit([number / scale for number in rows[largest]])
