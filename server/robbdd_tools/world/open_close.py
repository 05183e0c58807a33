"""Controller that opens and closes drawers, doors and lids by their handles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import ceil, cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.base.articulation import Opening
from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.engine import TICK, mujoco
from robbdd_tools.world.errors import BehaviourError, SceneError
from robbdd_tools.world.motion import ToolPose, tool_path
from robbdd_tools.world.owners import joint_of_part
from robbdd_tools.world.reaching import Approach, Obstruction, approaches_by

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.arm_control import ArmControl
    from robbdd_tools.world.cast import Cast
    from robbdd_tools.world.gripper import Step

SPEED = 0.15
"""Largest speed (m/s) of the tool while it holds a handle: people close doors and drawers at about this speed."""
SPACING = 0.01
"""Distance (m) between the points of the tool's path with a handle."""


def opening_by_handle(cast: Cast, name: str) -> Opening:
    """Return how a thing opens. Raises ``SceneError`` if this is not known, or if the thing has no handle."""
    opening = cast.openings.get(name)
    if opening is None:
        raise SceneError(f"'{name}' has no joint to open or to close", origin=cast.origin(name))
    if isinstance(opening, str):
        raise SceneError(opening, origin=cast.origin(name))
    joint = cast.objects[opening.part].joint
    if joint is None or joint.handle is None:
        text = f"'{name}' has no handle: name a shape of its moving part '…handle' or '…knob' in its file"
        raise SceneError(text, origin=cast.origin(name))
    return opening


class OpenClose:
    """Opens and closes things with one arm. ``emit`` is called with the name of each event when it occurs."""

    def __init__(self, hand: ArmControl, emit: Callable[[str], None]) -> None:
        self._hand = hand
        self._emit = emit
        self._simulation = hand.simulation

    def open(self, name: str) -> Step:
        """Open a thing; raises ``BehaviourError``. A thing that is open stays as it is."""
        self._emit("open-start")
        opening = opening_by_handle(self._simulation.world.cast, name)
        if not self._is_past(opening, opening.open):
            # Aim short of the joint's stop: a pull against the stop would drag the thing along.
            yield from self._bring(name, opening, (opening.open + opening.ends[1]) / 2)
            if not self._is_past(opening, opening.open):
                raise BehaviourError(f"{name} is not open at {self._hand.time:.2f} s")
        self._emit("open-end")

    def close(self, name: str) -> Step:
        """Close a thing; raises ``BehaviourError``. A thing that is closed stays as it is."""
        self._emit("close-start")
        opening = opening_by_handle(self._simulation.world.cast, name)
        if self._is_past(opening, opening.closed):
            yield from self._bring(name, opening, opening.ends[0])
            if self._is_past(opening, opening.closed):
                raise BehaviourError(f"{name} is not closed at {self._hand.time:.2f} s")
        self._emit("close-end")

    def _is_past(self, opening: Opening, position: float) -> bool:
        """Return whether the joint is beyond a position, seen from the closed end."""
        sense = 1.0 if opening.open > opening.closed else -1.0
        return sense * (self._position(opening) - position) > 0.0

    def _position(self, opening: Opening) -> float:
        joint = self._simulation.model.joint(joint_of_part(opening.part))
        return float(self._simulation.data.qpos[joint.qposadr[0]])

    def _bring(self, name: str, opening: Opening, goal: float) -> Step:
        """Grip the handle, bring the joint to a position, and release it."""
        hand = self._hand
        approach, control = self._choose_grasp(name, opening.part)
        yield from hand.gripper.release(hand)
        yield from hand.move(approach.above)
        yield from hand.gripper.open_to(hand, control)
        try:
            yield from hand.gripper.take(hand, approach.at, opening.part)
            hand.held = opening.part
            yield from hand.move_through(self._path(opening, goal), SPEED)
        except BehaviourError as error:
            raise BehaviourError(str(error).replace(opening.part, f"the handle of {name}")) from error
        hand.held = None
        # Open only as far as before the grip: a finger may be between the handle and the thing.
        yield from hand.gripper.open_to(hand, control)
        yield from hand.wait(round(hand.robot.model.release_time / TICK))
        yield from hand.move(hand.at_travel(hand.tool))

    def _choose_grasp(self, name: str, part: str) -> tuple[Approach, float]:
        """Return a grasp of the handle that has room for the hand, and the control value of the gripper there.

        The gripper is open or, if an open gripper has no room, open just enough for the handle. Raises
        ``BehaviourError``.
        """
        simulation, hand, robot = self._simulation, self._hand, self._hand.robot
        model = simulation.world.cast.objects[part]
        assert model.joint is not None, "a moving part has a joint"
        assert model.joint.handle is not None, "its handle is known"
        handle = replace(model, shapes=(model.shapes[model.joint.handle],))
        grasps = hand.gripper.grasps(f"the handle of {name}", handle, *simulation.seen(part))
        missed = Obstruction()
        narrow = [hand.gripper.control_around(grasp.width) for grasp in grasps]
        for controls in ([robot.model.gripper_open] * len(grasps), narrow):
            free: list[tuple[Approach, float]] = []
            for grasp, control in zip(grasps, controls, strict=True):
                clearance = Clearance(simulation, robot, part, simulation.data, model.joint.handle, control)
                for one in approaches_by(robot, [grasp], clearance, missed):
                    if one.depth == 0.0:
                        free.append((one, control))
                    else:
                        missed.touched[one.touched] = None
            if free:
                return min(free, key=lambda one: abs(one[0].at.turn))
        raise BehaviourError(f"{robot.name} cannot reach the handle of {name}{missed}")

    def _path(self, opening: Opening, goal: float) -> list[ToolPose]:
        """Return the poses of the tool, fixed to the handle, while the joint moves to a position."""
        simulation, robot, start = self._simulation, self._hand.robot, self._hand.tool
        joint = simulation.model.joint(joint_of_part(opening.part)).id
        axis: FloatArray = simulation.data.xaxis[joint].copy()
        anchor: FloatArray = simulation.data.xanchor[joint].copy()
        place = np.array(robot.base.at(_position(start)).position)
        closing = start.turn + start.bearing + robot.base.yaw + pi / 2
        way = goal - self._position(opening)
        hinged = opening.kind == "hinge"
        lever = float(np.linalg.norm(np.cross(axis, place - anchor))) if hinged else 1.0
        count = max(2, ceil(abs(way) * lever / SPACING))
        points: list[tuple[FloatArray, float]] = []
        for share in np.linspace(0.0, 1.0, count + 1)[1:].tolist():
            if hinged:
                there = anchor + _rotated(place - anchor, axis, share * way)
                points.append((there, closing + share * way * float(axis[2])))
            else:
                points.append((place + share * way * axis, closing))
        return tool_path(robot.base, points, start.turn)


def _position(pose: ToolPose) -> tuple[float, float, float]:
    """Return the position (m) of a tool pose in the frame of the robot's base."""
    return (pose.radius * cos(pose.bearing), pose.radius * sin(pose.bearing), pose.height)


def _rotated(vector: FloatArray, axis: FloatArray, angle: float) -> FloatArray:
    """Return a vector (3,) rotated about an axis (3,) by an angle (rad)."""
    turn, found = np.zeros(4), np.zeros(3)
    mujoco.mju_axisAngle2Quat(turn, axis, angle)
    mujoco.mju_rotVecQuat(found, vector, turn)
    return found
