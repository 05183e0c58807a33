"""Simulate how the fingers of a gripper from a file close: openings, reach and lever on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.gripper_faces import extent

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.finger_opening import Opening
    from robbdd_tools.world.gripper_actuators import GripperParts

SETTLING, STILL = 5000, 1e-3
"""A gripper opens or closes within this many steps of 2 ms; joints slower than this (rad/s, m/s) are at rest."""
BETWEEN = 0.02
"""A state of a closing gripper is recorded each time a joint has moved by more than this (rad, m)."""
USUAL = (0.15, 0.85)
"""Parts have a width between these shares of the widest opening."""


@dataclass(frozen=True, slots=True)
class Passed:
    """A state of closing fingers: the opening ``width`` (m), how far (m) they reach ``beyond`` the tool, and the
    ``length`` (m, rad) of the actuator."""

    width: float
    beyond: float
    length: float


def swept(
    parts: GripperParts,
    driven: tuple[Any, Any],
    opening: Opening,
    way: tuple[FloatArray, float],
    tool: tuple[FloatArray, float],
) -> tuple[Passed, ...]:
    """Return states from open to closed. There are none for sliding fingers, which always reach equally far.

    ``driven`` holds the compiled model and the actuator, ``way`` the positions of all joints when open and the value
    that closes the gripper, and ``tool`` the direction out of the hand and how far the tool is along it.
    """
    model, actuator = driven
    if not any(joint.type == mujoco.mjtJoint.mjJNT_HINGE for joint in parts.joints):
        return ()
    own = {str(body.name) for body in parts.bodies[1:]}
    shapes = [
        str(model.geom(geom).name)
        for geom in range(model.ngeom)
        if str(model.body(int(model.geom_bodyid[geom])).name) in own
        and (model.geom_contype[geom] or model.geom_conaffinity[geom])
    ]
    data = mujoco.MjData(model)
    number = model.actuator(actuator.name).id
    data.qpos[:], data.ctrl[number] = way[0], way[1]
    found: list[Passed] = []
    for state in _states_on_the_way(model, data, *joints_beside(parts, model)):
        data.qpos[:] = state
        mujoco.mj_fwdPosition(model, data)
        lowest = max(extent(model, data, name, tool[0])[1] for name in shapes)
        found.append(Passed(opening.at(state), lowest - tool[1], float(data.actuator_length[number])))
    return tuple(found)


def lever_of(
    model: Any, actuator: Any, ends: Sequence[FloatArray], widths: tuple[float, float], sweep: Sequence[Passed]
) -> float:
    """Return how far an actuator moves (m, rad) per metre of the opening, on average over usual widths of parts.

    ``ends`` are the joint positions of the closed and the open gripper, and ``widths`` (m) the openings when it is open
    and when it is closed.
    """
    usual = [one for one in sweep if USUAL[0] * widths[0] <= one.width <= USUAL[1] * widths[0]]
    if len(usual) > 1 and usual[0].width > usual[-1].width:
        return abs((usual[0].length - usual[-1].length) / (usual[0].width - usual[-1].width))
    closed, opened = (_length(model, actuator, state) for state in ends)
    return abs(opened - closed) / (widths[0] - widths[1])


def _length(model: Any, actuator: Any, state: FloatArray) -> float:
    data = mujoco.MjData(model)
    data.qpos[:] = state
    mujoco.mj_fwdPosition(model, data)
    return float(data.actuator_length[model.actuator(actuator.name).id])


def joints_beside(parts: GripperParts, model: Any) -> tuple[FloatArray, FloatArray]:
    """Return the addresses of the positions and speeds of all joints except the gripper's."""
    behind = {str(joint.name) for joint in parts.joints}
    fixed = [j for j in range(model.njnt) if str(model.joint(j).name) not in behind]
    return model.jnt_qposadr[fixed], model.jnt_dofadr[fixed]


def _states_on_the_way(model: Any, data: Any, places: FloatArray, speeds: FloatArray) -> list[FloatArray]:
    """Return joint positions about ``BETWEEN`` apart until the gripper is at rest; the other joints stay in place."""
    start = data.qpos[places].copy()
    found = [data.qpos.copy()]
    for step in range(SETTLING):
        mujoco.mj_step(model, data)
        data.qpos[places], data.qvel[speeds] = start, 0.0
        if np.abs(data.qpos - found[-1]).max() > BETWEEN:
            found.append(data.qpos.copy())
        elif step > SETTLING / 10 and np.abs(data.qvel).max(initial=0.0) < STILL:
            break
    return [*found, data.qpos.copy()]


def move_alone(model: Any, data: Any, places: FloatArray, speeds: FloatArray) -> int:
    """Step until the gripper is at rest; return the last step. ``places`` and ``speeds`` address joints that stay."""
    start = data.qpos[places].copy()
    step = 0
    for step in range(SETTLING):
        mujoco.mj_step(model, data)
        data.qpos[places], data.qvel[speeds] = start, 0.0
        if step > SETTLING / 10 and np.abs(data.qvel).max(initial=0.0) < STILL:
            break
    return step
