"""Poses of bodies."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, sin
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Vector


@dataclass(frozen=True, slots=True)
class Pose:
    """Position (m, world frame) and rotation about the vertical (rad).

    For a body that is not upright, ``rotation`` is the full rotation as a quaternion, w first.
    """

    position: Vector
    yaw: float = 0.0
    rotation: tuple[float, ...] = ()

    def at(self, offset: Vector) -> Pose:
        """Return the pose of a frame at an offset (m) in this one."""
        w, x, y, z = self.rotation or (cos(self.yaw / 2), 0.0, 0.0, sin(self.yaw / 2))
        a, b, c = offset
        # Rotate by the unit quaternion: v + 2 w (u × v) + 2 u × (u × v).
        p, q, r = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
        turned = (a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p)
        px, py, pz = (start + way for start, way in zip(self.position, turned, strict=True))
        return replace(self, position=(px, py, pz))
