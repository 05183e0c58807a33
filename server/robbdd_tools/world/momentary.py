"""Velocities and contact forces at this moment, for users' behaviours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.catalog.api import FloatArray

Velocity = tuple["FloatArray", "FloatArray"]
"""Velocity of the position (3,) m/s and of the rotation (3,) rad/s, world frame."""


def velocity_of(model: Any, data: Any, body: str) -> Velocity:
    """Return the velocity of a body in the last step of the engine; raises ``KeyError``."""
    found: FloatArray = np.empty(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, model.body(body).id, found, 0)
    return found[3:], found[:3]


def velocity_between(
    before: tuple[FloatArray, FloatArray], after: tuple[FloatArray, FloatArray], seconds: float
) -> Velocity:
    """Return the velocity that leads from a pose (position m, rotation matrix) to another one."""
    turn, around = np.empty(4), np.empty(3)
    mujoco.mju_mat2Quat(turn, np.ascontiguousarray(after[1] @ before[1].T).ravel())
    mujoco.mju_quat2Vel(around, turn, seconds)
    return (after[0] - before[0]) / seconds, around


def force_between(model: Any, data: Any, owners: Sequence[str], first: str, second: str) -> float:
    """Return the sum of the contact forces (N) of two elements in the last step of the engine."""
    wrench: FloatArray = np.empty(6)
    total = 0.0
    for contact, geoms in enumerate(data.contact.geom.tolist() if data.ncon else []):
        if {owners[geom] for geom in geoms} == {first, second}:
            mujoco.mj_contactForce(model, data, contact, wrench)
            total += float(np.linalg.norm(wrench[:3]))
    return total
