"""Drives of the joints of users' arms: position servos, their largest forces, and the weight that they have to bear."""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.coupled_joints import coupled_by_name
from robbdd_tools.world.engine import TIMESTEP, mujoco
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource

STIFFNESS = 2000.0
"""Smallest stiffness (N m/rad) of added servos."""
SLIDING = 10.0
"""For a sliding joint, the smallest stiffness (N/m) is this many times as large."""
FREQUENCY, RATIO = 20.0, 0.7
"""Natural frequency (rad/s) and damping ratio of servos that are added to joints with a large inertia."""
STEADY = 5.0
"""A joint with an added servo has an inertia of at least this many times its damping times the time step."""

Range = tuple[float, float]
"""Smallest and largest force (N, N m)."""
UNLIMITED: Range = (-inf, inf)


def add_servos(spec: Any, joints: tuple[str, ...], followers: tuple[str, ...]) -> None:
    """Replace the motor or velocity servo of each joint without a position servo by a position servo.

    A servo with gravity compensation is a joint impedance controller: it drives torque-controlled arms, too. Followers
    are not driven. The forces that a drive can exert bear the arm's own weight, too.
    """
    driven = {str(one.target): one for one in spec.actuators if one.trntype == mujoco.mjtTrn.mjTRN_JOINT}
    for joint in followers:
        if joint in driven:
            spec.delete(driven[joint])
    inertias = _inertias(spec, joints)
    for joint in joints:
        actuator = driven.get(joint)
        forces = UNLIMITED if actuator is None else _forces(actuator)
        _limit_drive(spec.joint(joint), forces)
        if actuator is not None and _is_position_servo(actuator):
            continue
        if actuator is not None:
            spec.delete(actuator)
        sliding = SLIDING if spec.joint(joint).type == mujoco.mjtJoint.mjJNT_SLIDE else 1.0
        # The engine solves ties and contacts without the damping of servos: a light joint would give way or shake. Real
        # drives have rotors.
        least = STIFFNESS * sliding * (STEADY * 2 * RATIO * TIMESTEP) ** 2
        rotor = max(0.0, least - inertias[joint])
        spec.joint(joint).armature += rotor
        inertia = inertias[joint] + rotor
        stiffness = max(STIFFNESS * sliding, FREQUENCY**2 * inertia)
        servo = spec.add_actuator(name=f"{joint}-servo", target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.set_to_position(kp=stiffness, kv=2 * RATIO * (stiffness * inertia) ** 0.5)
        if isfinite(forces[1]):
            servo.forcerange, servo.forcelimited = forces, True


def refuse_weak_drives(
    model: Any, source: ModelSource, joints: tuple[str, ...], home: tuple[float, ...], fingers: dict[str, float]
) -> None:
    """Raise ``SceneError`` if a drive cannot hold the arm at home, with the positions of the open gripper's joints."""
    data = mujoco.MjData(model)
    for joint, position in (*fingers.items(), *zip(joints, home, strict=True)):
        data.qpos[model.joint(joint).qposadr[0]] = position
    mujoco.mj_forward(model, data)
    for joint in joints:
        number = model.joint(joint).id
        needed = float(data.qfrc_gravcomp[model.jnt_dofadr[number]])
        low, high = model.jnt_actfrcrange[number].tolist()
        if model.jnt_actfrclimited[number] and not low <= needed <= high:
            bears, needed = max(high if needed > 0 else -low, 0.0), abs(needed)
            unit = "N" if model.jnt_type[number] == mujoco.mjtJoint.mjJNT_SLIDE else "N m"
            weak = f"the drive of '{joint}' bears {bears:.3g} {unit}"
            weight = f"at home the arm's own weight needs {needed:.3g} {unit}"
            raise SceneError(
                f"{weak}, but {weight}: correct the limit or the masses in {source.name}", origin=source.origin
            )


def _limit_drive(joint: Any, forces: Range) -> None:
    """Let the drive of a joint bear the arm's weight within its ``forces`` and the joint's own limits."""
    joint.actgravcomp = True
    low, high = _common(forces, _range(joint.actfrcrange, joint.actfrclimited))
    if isfinite(high):
        joint.actfrcrange, joint.actfrclimited = [low, high], True


def _is_position_servo(actuator: Any) -> bool:
    return (
        actuator.biastype == mujoco.mjtBias.mjBIAS_AFFINE
        and actuator.gainprm[0] > 0
        and abs(actuator.gainprm[0] + actuator.biasprm[1]) <= 1e-6 * actuator.gainprm[0]
        and actuator.gear[0] == 1.0
    )


def _forces(actuator: Any) -> Range:
    """Return the forces that an actuator can exert on its joint."""
    forces = _range(actuator.forcerange, actuator.forcelimited)
    if actuator.biastype == mujoco.mjtBias.mjBIAS_NONE:
        forces = _common(forces, _scaled(_range(actuator.ctrlrange, actuator.ctrllimited), actuator.gainprm[0]))
    return _scaled(forces, actuator.gear[0])


def _range(stated: FloatArray, limited: int) -> Range:
    """Return a range of a file; an empty one, or one that is switched off, limits nothing."""
    low, high = float(stated[0]), float(stated[1])
    return (low, high) if low < high and limited != mujoco.mjtLimited.mjLIMITED_FALSE else UNLIMITED


def _common(one: Range, other: Range) -> Range:
    return max(one[0], other[0]), min(one[1], other[1])


def _scaled(forces: Range, factor: float) -> Range:
    low, high = sorted((forces[0] * float(factor), forces[1] * float(factor)))
    return low, high


def _inertias(spec: Any, joints: tuple[str, ...]) -> dict[str, float]:
    """Return the inertia (kg m², kg) that each joint moves in the arm's posture in the file."""
    model = spec.copy().compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    coupled = coupled_by_name(model, joints)
    return {joint: coupled.inertia(full, int(model.joint(joint).dofadr[0])) for joint in joints}
