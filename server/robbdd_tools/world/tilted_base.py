"""Represent bases that hang or lean by an upright base at the same place and a tilt of the arm.

So all controllers see an upright base whose x axis points ahead, and tools point down, even from a ceiling.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, cos, hypot, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.pose import Pose

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

Quaternion = tuple[float, float, float, float]
"""w, x, y, z."""
UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)
LOW, HIGH = -0.3, 0.5
"""A base below or above these heights (m above the origin of a usual cell) works far above or below itself, at the
height of tables: it stands on the floor, or on top of a gantry."""
LYING = 0.1
"""The direction of a unit axis is known if its horizontal part is longer than this."""


@dataclass(frozen=True, slots=True)
class Tilt:
    """The rotation (w, x, y, z) of a base relative to its upright base, and its height (m, rounded).

    The height is above the origin of a usual cell, whose tables are ``TABLE_TOP`` (m) high.
    """

    rotation: Quaternion
    height: float


def upright_part(pose: Pose) -> tuple[Pose, Quaternion | None]:
    """Return the upright pose of a base, and the rotation of the base relative to it, if any.

    The x axis of the base points ahead. If it is vertical, as may happen for an arm on a wall, the z axis points ahead.
    """
    if not pose.rotation:
        return pose, None
    axes = np.empty(9)
    mujoco.mju_quat2Mat(axes, np.array(pose.rotation))
    x, z = axes[0::3], axes[2::3]
    ahead = x if hypot(x[0], x[1]) > LYING else z
    yaw = atan2(ahead[1], ahead[0])
    tilt: FloatArray = np.empty(4)
    mujoco.mju_mulQuat(tilt, about_vertical(-yaw), np.array(pose.rotation))
    w, i, j, k = (round(float(part), 9) for part in tilt)
    return replace(pose, yaw=yaw, rotation=()), (w, i, j, k)


def tilt_of(pose: Pose, rise: float) -> Tilt | None:
    """Return the tilt of a base in a cell whose tables are higher than usual by ``rise`` (m); ``None`` if upright."""
    rotation = upright_part(pose)[1]
    return None if rotation is None else Tilt(rotation, round(pose.position[2] - rise, 2))


def far_from_tables(pose: Pose, rise: float) -> Tilt | None:
    """Return the height of an upright base that is far below or above the tables; ``None`` for others."""
    height = round(pose.position[2] - rise, 2)
    return None if LOW < height < HIGH else Tilt(UPRIGHT, height)


def about_vertical(yaw: float) -> FloatArray:
    """Return the quaternion (4,) of a rotation about the vertical (rad)."""
    return np.array([cos(yaw / 2), 0.0, 0.0, sin(yaw / 2)])


def rotation_of(yaw: float, tilt: Quaternion) -> list[float]:
    """Return the quaternion of a base that is turned about the vertical (rad) and tilted."""
    if tilt == UPRIGHT:
        return [cos(yaw / 2), 0.0, 0.0, sin(yaw / 2)]
    whole: FloatArray = np.empty(4)
    mujoco.mju_mulQuat(whole, about_vertical(yaw), np.array(tilt))
    return [float(part) for part in whole]


def tilt_model(model: Any, tilt: Quaternion) -> None:
    """Turn everything in the compiled model of an arm about the origin of its base."""
    if tilt == UPRIGHT:
        return
    turn = np.array(tilt)
    first = model.body_parentid == 0
    first[0] = False
    for places, rotations, own in (
        (model.body_pos, model.body_quat, first),
        (model.geom_pos, model.geom_quat, model.geom_bodyid == 0),
        (model.site_pos, model.site_quat, model.site_bodyid == 0),
    ):
        for number in np.flatnonzero(own):
            place, rotation = places[number].copy(), rotations[number].copy()
            mujoco.mju_rotVecQuat(places[number], place, turn)
            mujoco.mju_mulQuat(rotations[number], turn, rotation)
