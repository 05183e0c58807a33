"""Mobile bases of arms: two sliding joints and one turning joint between the floor and the arm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.planar_joints import LEVEL, planar_joints
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.robot_specs import load_robot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, RobotModel

SPEED, TURNING = 0.5, 1.0
"""Largest speeds (m/s, rad/s) of a base whose file states none."""
GRIP = 0.5
"""If a file states no force limit, the wheels of a base can push with this share of its weight (friction)."""
LEVER = 0.2
"""Without a torque limit in the file, the torque is this push at this lever (m): half the distance of the wheels."""
FREQUENCY, RATIO = 20.0, 1.0
"""Natural frequency (rad/s) and damping ratio of the servos of a base."""


@dataclass(frozen=True, slots=True)
class MobileBase:
    """The base of an arm in its file: the names of two sliding joints and of the turning joint that they carry.

    ``speed`` (m/s) and ``turning`` (rad/s) are its largest speeds, ``force`` (N) and ``torque`` (N m) what its wheels
    can exert. ``stated`` is whether all these limits are from the file. ``gains`` are each servo's stiffness and
    damping.
    """

    joints: tuple[str, str, str]
    speed: float
    turning: float
    force: float
    torque: float
    stated: bool
    gains: tuple[tuple[float, float], ...]


def read_base(model: Any, joint: str) -> MobileBase | None:
    """Return the mobile base in an arm's compiled file that carries its first joint, ``None`` if the base is fixed."""
    found = planar_joints(model, int(model.joint(joint).id))
    if found is None:
        return None
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    dofs = [int(model.jnt_dofadr[one]) for one in found]
    inertias = [float(full[dof, dof]) for dof in dofs]
    weight = float(np.linalg.norm(model.opt.gravity)) * inertias[0]
    limits = [_actuator_limits(model, one) for one in found]
    speeds = [limit[0] for limit in limits]
    forces = [limit[1] for limit in limits]
    names = tuple(str(model.joint(one).name) for one in found)
    return MobileBase(
        (names[0], names[1], names[2]),
        min(speeds[:2]) or SPEED,
        speeds[2] or TURNING,
        min(forces[:2]) or GRIP * weight,
        forces[2] or GRIP * weight * LEVER,
        all((*speeds, *forces)),
        tuple((FREQUENCY**2 * inertia, 2 * RATIO * FREQUENCY * inertia) for inertia in inertias),
    )


def _actuator_limits(model: Any, joint: int) -> tuple[float, float]:
    """Return the largest speed (m/s, rad/s) and force (N, N m) of a joint's actuator; 0 if it has none."""
    speed = force = 0.0
    for number in range(model.nu):
        if model.actuator_trntype[number] != int(mujoco.mjtTrn.mjTRN_JOINT):
            continue
        if int(model.actuator_trnid[number, 0]) != joint:
            continue
        gain, bias = float(model.actuator_gainprm[number, 0]), model.actuator_biasprm[number]
        is_velocity = bias[1] == 0.0 and abs(gain + bias[2]) <= LEVEL * abs(gain)
        if is_velocity and model.actuator_ctrllimited[number]:
            speed = float(model.actuator_ctrlrange[number, 1])
        if model.actuator_forcelimited[number]:
            force = float(model.actuator_forcerange[number, 1] * abs(model.actuator_gear[number, 0]))
    return speed, force


@cache
def base_of(robot: RobotModel) -> MobileBase | None:
    """Return the mobile base of a robot, ``None`` if its base is fixed. Raises ``SceneError`` for a broken file."""
    return read_base(load_robot(robot).compile(), robot.joints[0])


def lowest_point(robot: RobotModel) -> float:
    """Return the height (m) of the lowest part of a robot above the origin of its frame, in the posture of its file."""
    model = load_robot(robot).compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    axes = data.geom_xmat.reshape(-1, 3, 3)[:, 2]
    boxes = model.geom_aabb.reshape(-1, 6)
    middles = data.geom_xpos[:, 2] + np.einsum("ij,ij->i", axes, boxes[:, :3])
    heights = np.einsum("ij,ij->i", np.abs(axes), boxes[:, 3:])
    return float(np.min(middles - heights))


def drive_by_servos(child: Any, base: MobileBase) -> None:
    """Give the joints of a base servos with its force limits, in place of the actuators of its file.

    Between driving, a servo holds the base in place, as brakes do.
    """
    for actuator in list(child.actuators):
        if actuator.target in base.joints:
            child.delete(actuator)
    forces = (base.force, base.force, base.torque)
    for joint, force, (stiffness, damping) in zip(base.joints, forces, base.gains, strict=True):
        servo = child.add_actuator(name=f"{joint}-servo", target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.set_to_position(kp=stiffness, kv=damping)
        servo.forcerange, servo.forcelimited = [-force, force], True


class BaseState:
    """The joints of one mobile base in the engine's arrays of a compiled world.

    ``joints`` (3,) are indices of joint positions, ``motors`` (3,) of controls, ``targets`` (3,) of servo targets.
    A target leads by the time ``lead`` (s). ``start`` is the pose of the arm's frame with all joints at 0.
    """

    def __init__(self, model: Any, name: str, base: MobileBase, start: Pose) -> None:
        self.limits = base
        self.start = start
        numbers = [int(model.joint(f"{name}/{joint}").id) for joint in base.joints]
        self.joints = np.array([model.jnt_qposadr[number] for number in numbers])
        self.motors = np.array([int(model.actuator(f"{name}/{joint}-servo").id) for joint in base.joints])
        self.targets = model.actuator_actadr[self.motors]
        self.lead = 2 * RATIO / FREQUENCY
        data: Any = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self._axes: FloatArray = data.xaxis[numbers[:2], :2].copy()
        self._sense = 1.0 if data.xaxis[numbers[2], 2] > 0.0 else -1.0
        self._pivot: FloatArray = data.xanchor[numbers[2], :2].copy()

    def pose_at(self, positions: FloatArray) -> FloatArray:
        """Return the pose of the base, (x m, y m, yaw rad) of its turning axis, for joint positions (3,)."""
        place = self._pivot + positions[:2] @ self._axes
        return np.array([*place, self.start.yaw + self._sense * positions[2]])

    def positions_at(self, pose: FloatArray) -> FloatArray:
        """Return the joint positions (3,) for a pose (3,) of the base."""
        return np.array([*(self._axes @ (pose[:2] - self._pivot)), self._sense * (pose[2] - self.start.yaw)])

    def frame_at(self, positions: FloatArray) -> Pose:
        """Return the pose of the arm's frame for joint positions (3,)."""
        x, y, yaw = self.pose_at(positions).tolist()
        turn = yaw - self.start.yaw
        c, s = np.cos(turn), np.sin(turn)
        dx, dy = self.start.position[0] - self._pivot[0], self.start.position[1] - self._pivot[1]
        return Pose((float(x + c * dx - s * dy), float(y + s * dx + c * dy), self.start.position[2]), yaw)
