"""Joints of an arm that follow others of its joints, as the rods of a palletizer make them do: mimic joints of URDF."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, inf
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource

RIGID = (0.006, 1.0)
"""Time constant and damping of rigid ties. With the engine's 0.02 s, the wrist of a palletizer tilts by 1.2 degrees."""


@dataclass(frozen=True, slots=True)
class CoupledJoints:
    """Joints with the position ``ratio`` times that of their leader plus ``offset``; all arrays have the shape (n,).

    ``places`` and ``leaders`` are indices of joint positions, ``speeds`` and ``leading`` of velocities.
    """

    places: NDArray[np.intp]
    leaders: NDArray[np.intp]
    speeds: NDArray[np.intp]
    leading: NDArray[np.intp]
    ratios: FloatArray
    offsets: FloatArray

    def place(self, positions: FloatArray) -> None:
        """Put the joints where their leaders move them, in the joint positions of the engine."""
        if len(self.ratios):
            positions[self.places] = self.offsets + self.ratios * positions[self.leaders]

    def reduce(self, jacobian: FloatArray) -> None:
        """Add the columns of the joints to those of their leaders in a Jacobian (m, velocities)."""
        for follower, leader, ratio in zip(self.speeds, self.leading, self.ratios, strict=True):
            jacobian[:, leader] += ratio * jacobian[:, follower]

    def inertia(self, full: FloatArray, speed: int) -> float:
        """Return the inertia that a leader moves, with its followers, from the engine's full mass matrix."""
        own = self.leading == speed
        columns = np.array([speed, *self.speeds[own]], dtype=int)
        ratios = np.array([1.0, *self.ratios[own]])
        return float(ratios @ full[np.ix_(columns, columns)] @ ratios)


def coupled_joints(model: Any, leaders: Sequence[int]) -> CoupledJoints:
    """Return the joints that follow some joints of a compiled model, by their numbers, directly or through others."""
    direct = {one: (other, ratio, offset) for one, other, ratio, offset in _lines(model)}
    found: list[tuple[int, int, float, float]] = []
    for follower in direct:
        leader, ratio, offset = follower, 1.0, 0.0
        for _ in direct:
            if leader not in direct:
                break
            leader, factor, shift = direct[leader]
            ratio, offset = ratio * factor, offset + ratio * shift
        if leader in leaders:
            found.append((follower, leader, ratio, offset))
    followers, own = [one[0] for one in found], [one[1] for one in found]
    return CoupledJoints(
        np.array(model.jnt_qposadr[followers], dtype=np.intp),
        np.array(model.jnt_qposadr[own], dtype=np.intp),
        np.array(model.jnt_dofadr[followers], dtype=np.intp),
        np.array(model.jnt_dofadr[own], dtype=np.intp),
        np.array([one[2] for one in found]),
        np.array([one[3] for one in found]),
    )


def coupled_by_name(model: Any, leaders: Sequence[str]) -> CoupledJoints:
    """Return the joints that follow some joints of a compiled model, by their names."""
    return coupled_joints(model, [int(model.joint(name).id) for name in leaders])


def followers_among(spec: Any, joints: Sequence[str]) -> tuple[str, ...]:
    """Return those of an arm's joints that follow others of them."""
    ties = {str(one.name1): str(one.name2) for one in _ties(spec)}
    return tuple(joint for joint in joints if ties.get(joint) in joints)


def refuse_uncoupled(spec: Any, source: ModelSource, bodies: Sequence[Any], joints: Sequence[str]) -> None:
    """Refuse the ties of an arm's joints or bodies that are not followed here. Raises ``SceneError``."""
    ties = {str(one.name1): str(one.name2) for one in _ties(spec)}
    for joint in joints:
        leader = joint
        for _ in ties:
            leader = ties.get(leader, leader)
        if leader in ties:
            _refuse(source, f"its joint '{joint}' follows itself")
    kinds, own = mujoco.mjtEq, {str(body.name) for body in bodies[:-1]}
    on_joint = mujoco.mjtWrap.mjWRAP_JOINT
    tendons = {
        str(one.name): {str(wrap.target.name) for wrap in one.path if wrap.type == on_joint} for one in spec.tendons
    }
    for tie in spec.equalities:
        first, second = str(tie.name1), str(tie.name2)
        if tie.type == kinds.mjEQ_JOINT and first in joints:
            if second and second not in joints:
                _refuse(source, f"its joint '{first}' follows '{second}', which is not between its base and its hand")
            if not second or np.abs(tie.data[2:5]).max() > 0.0:
                _refuse(
                    source, f"its joint '{first}' follows no line: the first factor of 'polycoef' may differ from 0"
                )
        if tie.type in (kinds.mjEQ_CONNECT, kinds.mjEQ_WELD) and {first, second} & own:
            _refuse(source, f"its bodies '{first}' and '{second}' close a loop")
        if tie.type == kinds.mjEQ_TENDON and (tendons.get(first, set()) | tendons.get(second, set())) & set(joints):
            _refuse(source, f"the tendon '{first}' ties its joints")


def stiffen(spec: Any, followers: Sequence[str]) -> None:
    """Make the ties of followers as rigid as rods: mimic joints of URDF do not yield."""
    for tie in _ties(spec):
        if tie.name1 in followers:
            tie.solref = RIGID


def tighten(spec: Any, model: Any, joints: Sequence[str]) -> None:
    """Restrict the limits of joints to those at which no joint that follows them leaves its own limits."""
    coupled = coupled_by_name(model, joints)
    for joint in joints:
        number = int(model.joint(joint).id)
        own = np.flatnonzero(coupled.leaders == model.jnt_qposadr[number])
        low, high = (float(end) for end in model.jnt_range[number]) if model.jnt_limited[number] else (-inf, inf)
        for index in own:
            follower = int(np.flatnonzero(model.jnt_qposadr == coupled.places[index])[0])
            if model.jnt_limited[follower] and coupled.ratios[index]:
                ends = sorted((model.jnt_range[follower] - coupled.offsets[index]) / coupled.ratios[index])
                low, high = max(low, float(ends[0])), min(high, float(ends[1]))
        if len(own) and np.isfinite(low) and np.isfinite(high):
            made = spec.joint(joint)
            unit = degrees(1.0) if made.type == mujoco.mjtJoint.mjJNT_HINGE and spec.compiler.degree else 1.0
            made.range, made.limited = [unit * low, unit * high], mujoco.mjtLimited.mjLIMITED_TRUE


def slowest(model: Any, joints: Sequence[str], limits: Sequence[float], others: dict[str, float]) -> tuple[float, ...]:
    """Return the speed limits of joints with which their followers keep theirs, which ``others`` has by name."""
    coupled = coupled_by_name(model, joints)
    found = list(limits)
    for follower, leader, ratio in zip(coupled.speeds, coupled.leading, coupled.ratios, strict=True):
        names = [str(model.joint(int(model.dof_jntid[dof])).name) for dof in (follower, leader)]
        if names[0] in others and ratio:
            index = list(joints).index(names[1])
            found[index] = min(found[index], others[names[0]] / abs(float(ratio)))
    return tuple(found)


def _lines(model: Any) -> Iterator[tuple[int, int, float, float]]:
    """Yield each joint that follows another one along a line: both numbers, factor and offset."""
    for index in range(model.neq):
        one, other = int(model.eq_obj1id[index]), int(model.eq_obj2id[index])
        if model.eq_type[index] != int(mujoco.mjtEq.mjEQ_JOINT) or other < 0 or not model.eq_active0[index]:
            continue
        shift, ratio = (float(value) for value in model.eq_data[index, :2])
        zero, zero_of_other = (float(model.qpos0[model.jnt_qposadr[joint]]) for joint in (one, other))
        yield one, other, ratio, zero + shift - ratio * zero_of_other


def _ties(spec: Any) -> Iterator[Any]:
    return (one for one in spec.equalities if one.type == mujoco.mjtEq.mjEQ_JOINT and one.name2 and one.active)


def _refuse(source: ModelSource, why: str) -> None:
    text = f"the arm in {source.name} cannot be simulated, because {why}"
    raise SceneError(
        f"{text}: state each joint that follows another one with 'mimic' (URDF) or 'equality/joint' (MJCF)",
        origin=source.origin,
    )
