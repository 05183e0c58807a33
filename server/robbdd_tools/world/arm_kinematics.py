"""Forward and inverse kinematics of one arm, on a model that contains only the arm."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property, lru_cache
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.coupled_joints import coupled_by_name
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.hanging_arms import is_hung, slides_sideways
from robbdd_tools.world.robot_files import prepared_robot
from robbdd_tools.world.robot_specs import load_robot
from robbdd_tools.world.shoulders import shoulder_aside
from robbdd_tools.world.tilted_base import UPRIGHT, tilt_model

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, RobotModel

CLOSE = 5e-5
"""A solution is accepted if its pose error is below this (m and rad)."""
VISIBLE = 1e-3
"""If the tool misses its goal by at least this distance (m), an error names the distance, else the orientation."""
ROUNDS = 60
MIN_DAMPING, DAMPING = 1e-6, 0.01
"""Damping of the least squares: a minimum, and a share of the squared pose error.

Damping fades near the goal, because with it the pull towards the home posture changes the tool pose.
"""
POSTURE = 0.2
"""Share of the way back to the home posture that a redundant arm moves in each iteration."""
ARMS = 16
"""Size of the cache of arms; every configured robot is a separate entry."""
TURNS = 2 * np.pi
"""Limit (rad) of joints without limits in their file: the cables of real arms do not allow more either."""
VERTICAL, AHEAD = 0.999, 0.05
"""An axis is vertical from this cosine of its tilt on; a tool is straight ahead up to this bearing (rad)."""
LEVEL = 1e-3
"""A joint that changes the tool's height by less than this (m per rad or m) moves it horizontally."""
STRIDE = 0.3
"""Largest change of a joint in one iteration, rad."""
SEEDS = 12
"""Number of random postures from which more searches start; they are the same in every run."""


class Unreachable(BehaviourError):
    """No joint positions within the limits reach the tool pose; ``short`` is the smallest error (m or rad) found."""

    def __init__(self, place: float, turn: float) -> None:
        """Describe the remaining errors of place (m) and orientation (rad)."""
        angle = f"{degrees(turn):.1f}°" if degrees(turn) >= 0.05 else "less than 0.1°"
        super().__init__(f"{1000 * place:.0f} mm short" if place >= VISIBLE else f"turned {angle} away")
        self.short = max(place, turn)


class Arm:
    """An arm by itself; tool poses are in the frame of its base.

    ``lower`` and ``upper`` (n,) are the joint limits, ``home`` (n,) the preferred posture, all in rad. ``limited`` says
    which joints have limits, ``turning`` which ones are not sliding. ``is_published`` marks upright arms of the
    catalog: their motions are part of published results, so they take no other path if their own one fails.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._model: Any = load_robot(robot).compile()
        tilt_model(self._model, robot.tilt)
        self._data: Any = mujoco.MjData(self._model)
        self._site = int(self._model.site(robot.tool_site).id)
        joints = [self._model.joint(name) for name in robot.joints]
        self._numbers = [int(joint.id) for joint in joints]
        self._places = np.array([joint.qposadr[0] for joint in joints])
        self._speeds = np.array([joint.dofadr[0] for joint in joints])
        self._coupled = coupled_by_name(self._model, robot.joints)
        limited = [bool(self._model.jnt_limited[joint.id]) for joint in joints]
        self.limited = tuple(limited)
        self.turning = tuple(self._model.jnt_type[joint.id] == int(mujoco.mjtJoint.mjJNT_HINGE) for joint in joints)
        self.lower: FloatArray = np.array(
            [j.range[0] if has else -TURNS for j, has in zip(joints, limited, strict=True)]
        )
        self.upper: FloatArray = np.array(
            [j.range[1] if has else TURNS for j, has in zip(joints, limited, strict=True)]
        )
        self.home: FloatArray = np.array(robot.home)
        self._position: FloatArray = self._data.site_xpos[self._site]
        self._rotation: FloatArray = self._data.site_xmat[self._site]
        self._jacobian: FloatArray = np.zeros((6, self._model.nv))
        self._turns: FloatArray = np.zeros((2, 4))
        self._weights: FloatArray = np.zeros(6)
        # The catalog's results were published with plain rules: one search, and tools straight ahead at home.
        self.is_published = prepared_robot(robot.mjcf) is None and robot.tilt == UPRIGHT
        self._turns_with = (0.0, 1.0) if self.is_published else self._first_joint()

    def forward(self, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position (3,) m and rotation matrix (3, 3) for joint positions (n,) rad."""
        self._data.qpos[self._places] = joints
        self._coupled.place(self._data.qpos)
        mujoco.mj_kinematics(self._model, self._data)
        return self._position.copy(), self._rotation.reshape(3, 3).copy()

    @cached_property
    def hangs(self) -> bool:
        """Whether nothing below the base carries the arm: its second joint is below the base, or it is a gantry.

        The first joint of a gantry slides sideways, and its tool is below its base.
        """
        place, _ = self.forward(self.home)
        is_gantry = slides_sideways(self._model, self._data, self._numbers[0])
        return is_hung(self._data, self._numbers) or (is_gantry and float(place[2]) < 0.0)

    @cached_property
    def aside(self) -> float:
        """How far (m) to the left of the middle of its base the arm turns by its first joint."""
        self.forward(self.home)
        return shoulder_aside(self._model, self._data, self._numbers[0])

    @cached_property
    def stroke(self) -> tuple[float, float]:
        """The lowest and the highest tool above the base (m), if only vertical sliding joints change its height.

        Such arms, SCARAs and gantries, have the same stroke everywhere. It is infinite for all others.
        """
        dice = np.random.default_rng(1)
        others = [self.lower + dice.random(len(self.home)) * (self.upper - self.lower) for _ in range(2)]
        lift = np.array([self._lift(posture) for posture in (self.home, *others)])
        slides = ~np.array(self.turning) & (np.abs(lift) > VERTICAL).all(axis=0)
        if self.is_published or not slides.any() or np.abs(lift[:, ~slides]).max(initial=0.0) > LEVEL:
            return -np.inf, np.inf
        ends = np.where(lift[0] > 0, self.lower, self.upper), np.where(lift[0] > 0, self.upper, self.lower)
        low, high = (float(self.forward(np.where(slides, end, self.home))[0][2]) for end in ends)
        return low, high

    def _lift(self, joints: FloatArray) -> FloatArray:
        """Return the change of the tool's height with each joint, m per rad or per m, shape (n,)."""
        self.forward(joints)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_jacSite(self._model, self._data, self._jacobian[:3], self._jacobian[3:], self._site)
        self._coupled.reduce(self._jacobian)
        return self._jacobian[2, self._speeds].copy()

    def _first_joint(self) -> tuple[float, float] | None:
        """Return the bearing (rad) of the tool at home, 0 straight ahead, and the sense of the first joint.

        ``None`` if this joint does not turn about the vertical.
        """
        place, _ = self.forward(self.home)
        joint = int(self._model.dof_jntid[self._speeds[0]])
        vertical = float(self._data.xaxis[joint, 2])
        if self._model.jnt_type[joint] != int(mujoco.mjtJoint.mjJNT_HINGE) or abs(vertical) < VERTICAL:
            return None
        bearing = float(np.arctan2(place[1], place[0]))
        return bearing if abs(bearing) > AHEAD else 0.0, 1.0 if vertical > 0 else -1.0

    def _turned(self, direction: float) -> float:
        """Return the change (rad) of the first joint that turns the home posture to a direction (rad)."""
        assert self._turns_with is not None
        bearing, sense = self._turns_with
        turn = direction - bearing
        return sense * float(np.arctan2(np.sin(turn), np.cos(turn)))

    def towards(self, position: FloatArray) -> FloatArray:
        """Return the home posture (n,) with the first joint turned towards a position, within its limits."""
        posture = self.home.copy()
        if self._turns_with is not None:
            direction = np.arctan2(position[1], position[0])
            posture[0] += direction if self._turns_with == (0.0, 1.0) else self._turned(direction)
        return np.minimum(np.maximum(posture, self.lower), self.upper)

    def solutions(self, position: FloatArray, rotation: FloatArray) -> Iterator[FloatArray]:
        """Yield joint positions (n,) that put the tool at a pose; raises ``Unreachable`` if there are none.

        The first search starts at the home posture, turned towards the goal. Unless the arm's results are published,
        other searches start at random postures, because a joint limit may be in the way from home.
        """
        missed: Unreachable | None = None
        found = 0
        for seed in self._seeds(position):
            try:
                joints = self.solve(seed, position, rotation)
            except Unreachable as error:
                missed = error if missed is None or error.short < missed.short else missed
                continue
            found += 1
            yield joints
        if missed is not None and not found:
            raise missed

    def _seeds(self, position: FloatArray) -> Iterator[FloatArray]:
        posture = self.towards(position)
        yield posture
        dice = np.random.default_rng(1)
        for _ in range(0 if self.is_published else SEEDS):
            seed = self.lower + dice.random(len(posture)) * (self.upper - self.lower)
            if self._turns_with is not None:
                seed[0] = posture[0]
            yield seed

    def solve(self, seed: FloatArray, position: FloatArray, rotation: FloatArray) -> FloatArray:
        """Return joint positions (n,) near ``seed`` that put the tool at a pose; raises ``Unreachable``.

        Damped least squares. The redundancy pulls towards the home posture, with its first joint turned towards the
        goal. Joints that reach a limit stay there, and the others compensate; those of arms with published results stay
        where they are before it.
        """
        joints = np.minimum(np.maximum(seed, self.lower), self.upper)
        posture = self.towards(position)
        mujoco.mju_mat2Quat(self._turns[0], rotation.ravel())
        gap = np.empty(6)
        error = np.inf
        for _ in range(ROUNDS):
            self._data.qpos[self._places] = joints
            self._coupled.place(self._data.qpos)
            mujoco.mj_kinematics(self._model, self._data)
            np.subtract(position, self._position, out=gap[:3])
            self._turn_left(gap[3:])
            error = _largest(gap)
            if error < CLOSE:
                return joints
            joints = self._improve(joints, gap, posture)
        raise Unreachable(_largest(gap[:3]), _largest(gap[3:]))

    def _turn_left(self, turn: FloatArray) -> None:
        """Write the rotation vector (rad, world frame) from the tool's orientation to the goal's into ``turn`` (3,)."""
        goal, present = self._turns
        mujoco.mju_mat2Quat(present, self._rotation)
        mujoco.mju_subQuat(turn, goal, present)
        mujoco.mju_rotVecQuat(turn, turn.copy(), present)

    def _improve(self, joints: FloatArray, gap: FloatArray, posture: FloatArray) -> FloatArray:
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_jacSite(self._model, self._data, self._jacobian[:3], self._jacobian[3:], self._site)
        self._coupled.reduce(self._jacobian)
        jacobian = self._jacobian[:, self._speeds]
        homewards = posture - joints
        moved = joints + self._step(jacobian, gap, homewards)
        free, ended = np.ones(len(joints)), np.zeros(len(joints))
        for _ in range(len(joints) - 1):
            beyond = ((moved < self.lower) | (moved > self.upper)) & (free > 0.0)
            if not beyond.any():
                break
            free[beyond] = 0.0
            if not self.is_published:
                ended[beyond] = np.minimum(np.maximum(moved, self.lower), self.upper)[beyond] - joints[beyond]
            left = gap - jacobian @ ended if ended.any() else gap
            moved = joints + ended + self._step(jacobian * free, left, homewards * free)
        return np.minimum(np.maximum(moved, self.lower), self.upper)

    def _step(self, jacobian: FloatArray, gap: FloatArray, homewards: FloatArray) -> FloatArray:
        """Return one step of damped least squares with a pull (n,) in the null space of the Jacobian (6, n)."""
        square = jacobian @ jacobian.T
        square.flat[::7] += MIN_DAMPING + DAMPING * float(gap @ gap)
        pull = POSTURE * homewards
        # Six equations: the engine's own solver takes a fraction of the time of a general one.
        mujoco.mju_cholFactor(square, 0.0)
        mujoco.mju_cholSolve(self._weights, square, gap - jacobian @ pull)
        step: FloatArray = pull + self._weights @ jacobian
        return step / max(1.0, _largest(step) / STRIDE)


@lru_cache(maxsize=ARMS)
def arm_of(robot: RobotModel) -> Arm:
    """Return the arm of a robot model, compiled at first use."""
    return Arm(robot)


def _largest(values: FloatArray) -> float:
    """Return the largest magnitude; for a few numbers, plain Python is faster than numpy."""
    numbers: list[float] = values.tolist()
    return max(map(abs, numbers))
