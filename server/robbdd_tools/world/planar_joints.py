"""Find the joints of a mobile base, which are between the floor and an arm."""

from __future__ import annotations

from typing import Any

import numpy as np

from robbdd_tools.world.engine import mujoco

LEVEL = 1e-6
"""An axis counts as horizontal or vertical up to this deviation (a cosine)."""
HALL = 3.0
"""Sliding joints with at least this range (m) belong to a base that drives, others to a gantry."""
_BASE = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))


def drives(model: Any, joints: tuple[str, ...]) -> bool:
    """Return whether the first three of an arm's joints in a file belong to a base that drives."""
    if len(joints) <= len(_BASE):
        return False
    found = planar_joints(model, int(model.joint(joints[len(_BASE)]).id))
    if found is None or tuple(str(model.joint(one).name) for one in found) != joints[: len(_BASE)]:
        return False
    low, high = model.jnt_range[list(found[:2])].T
    return bool(np.all((model.jnt_limited[list(found[:2])] == 0) | (high - low >= HALL)))


def planar_joints(model: Any, joint: int) -> tuple[int, int, int] | None:
    """Return the joints of a mobile base that carries a joint of an arm, ``None`` if its base is fixed.

    These are the first three joints after the world: two horizontal sliding joints, then one about the vertical.
    """
    chain = [one for one in _joints_to(model, joint) if one != joint]
    if len(chain) < len(_BASE) or tuple(int(model.jnt_type[one]) for one in chain[:3]) != _BASE:
        return None
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    first, second, third = (data.xaxis[one] for one in chain[:3])
    is_level = abs(first[2]) < LEVEL and abs(second[2]) < LEVEL and abs(float(first @ second)) < LEVEL
    return (chain[0], chain[1], chain[2]) if is_level and abs(third[2]) > 1.0 - LEVEL else None


def _joints_to(model: Any, joint: int) -> list[int]:
    """Return the joints from the world to a joint, inclusive."""
    body, found = int(model.jnt_bodyid[joint]), list[int]()
    while body:
        first = int(model.body_jntadr[body])
        found = [*range(first, first + int(model.body_jntnum[body])), *found]
        body = int(model.body_parentid[body])
    return [one for one in found if one <= joint]
