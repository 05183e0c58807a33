"""The position from which a camera sees all of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

ROOM = 1.06
"""The picture shows this many times the extent of the scene, so that there is room around it."""
ROUNDS = 6
"""Number of corrections of the aim; each one leaves only a small part of the error."""
CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
"""The corners (8, 3) of a box whose half edges are 1."""


def corners_of(model: Any, data: Any) -> FloatArray:
    """Return the corners (n, 3), m, world frame, of the boxes around all shapes except the floor."""
    shapes = np.flatnonzero(model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE)
    middles, halves = model.geom_aabb[shapes, :3], model.geom_aabb[shapes, 3:]
    local = middles[:, None, :] + halves[:, None, :] * CORNERS
    turns = data.geom_xmat[shapes].reshape(-1, 3, 3)
    placed = data.geom_xpos[shapes][:, None, :] + local @ turns.transpose(0, 2, 1)
    return placed.reshape(-1, 3)


def aim(points: FloatArray, azimuth: float, elevation: float, field: float, aspect: float) -> tuple[FloatArray, float]:
    """Return the point (3,) m at which a camera must look to see all points, and the camera's distance (m) from it.

    Args:
        points: (n, 3), m, in the world frame.
        azimuth: direction of view, degrees.
        elevation: direction of view, degrees, negative if the camera looks down.
        field: the vertical angle of view, degrees.
        aspect: width of the picture over its height.
    """
    turn, tilt = np.radians(azimuth), np.radians(elevation)
    ahead = np.array([np.cos(tilt) * np.cos(turn), np.cos(tilt) * np.sin(turn), np.sin(tilt)])
    right = np.array([np.sin(turn), -np.cos(turn), 0.0])
    above = np.cross(right, ahead)
    reach = np.tan(np.radians(field) / 2)
    limits = np.array([reach * aspect, reach]) / ROOM
    target: FloatArray = (points.min(axis=0) + points.max(axis=0)) / 2
    distance = 0.0
    for _ in range(ROUNDS):
        seen = (points - target) @ np.stack([right, above, ahead], axis=1)
        distance = float((np.abs(seen[:, :2]) / limits - seen[:, 2:]).max())
        # The nearest points spread most: move the aim to the middle of what the picture shows.
        shares = seen[:, :2] / (distance + seen[:, 2:])
        shift = (shares.min(axis=0) + shares.max(axis=0)) / 2 * distance
        target = target + shift[0] * right + shift[1] * above
    seen = (points - target) @ np.stack([right, above, ahead], axis=1)
    return target, float((np.abs(seen[:, :2]) / limits - seen[:, 2:]).max())
