"""Tool poses that put a held object down, turned so that it fits its place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi, remainder, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.arm_kinematics import Unreachable
from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.extent import half_sides
from robbdd_tools.world.motion import ToolPose, tool_pose, yaw_of
from robbdd_tools.world.put_down import has_room, targets
from robbdd_tools.world.reaching import Obstruction, either_way, is_high, joints_at
from robbdd_tools.world.travel_clearance import height_over, is_roofed

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.arm_control import ArmControl
    from robbdd_tools.world.grasp import Grasp
    from robbdd_tools.world.put_down import Target

ROOM = 0.02
"""Room (m) below an object that is carried from or to a high support (``reaching.HIGH``)."""
ASIDE = 2e-3
"""If the tool grips an object at most this far (m) from its position, it puts it down as if there were no distance."""
STEP = 0.02
"""The hand is lowered this much (m) less where it has no room."""


@dataclass(frozen=True, slots=True)
class Grip:
    """How an arm holds an object.

    ``tool`` is the tool's pose at the grasp and ``rotation`` (3, 3) the object's there, world frame.
    """

    name: str
    grasp: Grasp
    tool: ToolPose
    rotation: FloatArray


@dataclass(frozen=True, slots=True)
class PutDown:
    """A tool pose that puts an object down; ``is_snug`` if it is released just above its place."""

    pose: ToolPose
    is_snug: bool


class PutPoses:
    """Finds the poses at which an arm puts down the object that it holds, or would hold by a grip."""

    def __init__(self, control: ArmControl, grip: Grip) -> None:
        self._control = control
        self.grip = grip
        simulation, robot = control.simulation, control.robot
        self._model = simulation.world.cast.objects[grip.name]
        self._clearance = Clearance(simulation, robot, grip.name, simulation.data)
        self._yaw = yaw_of(robot.base, grip.tool)
        self._from_high = is_high(robot, grip.tool, grip.grasp.below)

    def at_one_of(self, workspaces: Sequence[str], note_choice: Callable[[str], None]) -> PutDown:
        """Return a pose at the first workspace with room for the object, else at the first that the arm reaches.

        ``note_choice`` is called with the workspace if there are several. Raises ``BehaviourError``.
        """
        if len(workspaces) == 1:
            return self.at(workspaces[0])
        simulation, robot = self._control.simulation, self._control.robot
        # Sorting is stable: workspaces with room keep their order, and so do those without.
        for workspace in sorted(workspaces, key=lambda one: not has_room(simulation, robot, self.grip.name, one)):
            try:
                found = self.at(workspace)
            except BehaviourError:
                continue
            note_choice(workspace)
            return found
        raise BehaviourError(f"{robot.name} cannot reach a free place at any of {', '.join(workspaces)}")

    def at(self, workspace: str) -> PutDown:
        """Return the lowest pose over the first place that the object fits and that the arm reaches, else over any.

        Raises ``BehaviourError``.
        """
        simulation, robot, missed = self._control.simulation, self._control.robot, Obstruction()
        places = targets(simulation, robot, self.grip.name, workspace)
        # Sorting is stable: places with most room stay first.
        for target in sorted(places, key=lambda one: not any(self._fits(turn, one) for turn in self._closings(one))):
            found = self.onto(target, missed)
            if found is not None:
                return found
        raise BehaviourError(f"{robot.name} cannot reach a free place at {workspace}{missed}")

    def onto(self, target: Target, missed: Obstruction) -> PutDown | None:
        """Return the lowest pose over a place, or ``None`` if the arm does not reach it; ``missed`` records why.

        The object is turned if it does not fit as it comes, or if the hand has no room beside it there.
        """
        usual, *_ = closings = self._closings(target)
        first: PutDown | None = None
        for closing in [closing for closing in closings if self._fits(closing, target)] or [usual]:
            found = self._lowered(closing, target, missed)
            if found is not None and found.is_snug:
                return found
            first = first or found
        return first

    def carried_to(self, pose: ToolPose) -> ToolPose:
        """Return the pose above ``pose`` to which the tool carries the object, high enough to clear shapes below."""
        over, below = self._control.at_travel(pose), self.grip.grasp.below
        simulation, robot, name = self._control.simulation, self._control.robot, self.grip.name
        room = robot.model.carry_clearance
        if not room and (self._from_high or is_high(robot, pose, below)):
            room = 0.0 if is_roofed(simulation, robot, name, pose) else ROOM
        if not room:
            return over
        needed = height_over(simulation, robot, name, self._control.tool, pose) + room + below
        return replace(over, height=max(over.height, needed))

    def _lowered(self, closing: float, target: Target, missed: Obstruction) -> PutDown | None:
        x, y, surface = target.position
        lowest = height = surface + self.grip.grasp.below + target.gap
        top = max(self._control.robot.travel_height, height)
        while height <= top:
            found = self._reached(np.array([x, y, height]), closing, missed)
            if found is None:
                return None
            pose, joints = found
            hit = self._clearance.hit(joints)
            if hit.depth == 0.0:
                return PutDown(pose, is_snug=height == lowest)
            missed.touched[hit.owner] = None
            height += STEP
        return None

    def _reached(self, place: FloatArray, closing: float, missed: Obstruction) -> tuple[ToolPose, FloatArray] | None:
        """Return a tool pose that brings the object to a place (m), and the joint positions (rad) there."""
        for pose in self._bringing(place, closing):
            try:
                return pose, joints_at(self._control.arm, self.carried_to(pose), pose)
            except Unreachable as error:
                missed.note(error)
        return None

    def _bringing(self, place: FloatArray, closing: float) -> tuple[ToolPose, ...]:
        """Return the tool poses, with either finger on either side, for the object at a place (m)."""
        base, arm, aside = self._control.robot.base, self._control.arm, self.grip.grasp.aside
        if hypot(*aside) < ASIDE:
            return either_way(arm, tool_pose(base, place, closing))
        found: list[ToolPose] = []
        for yaw in (closing - pi / 2, closing + pi / 2):
            c, s = cos(yaw - self._yaw), sin(yaw - self._yaw)
            x, y = aside
            tool = place - np.array([c * x - s * y, s * x + c * y, 0.0])
            both = either_way(arm, tool_pose(base, tool, closing))
            found += [pose for pose in both if abs(remainder(yaw_of(base, pose) - yaw, 2 * pi)) < pi / 2]
        return tuple(found)

    def _closings(self, target: Target) -> tuple[float, float, float]:
        """Return closing directions (rad): the usual one, and those with the object's sides along the place's edges."""
        usual = self.grip.grasp.closing if target.closing is None else target.closing
        side = int(np.argmin(np.abs(self.grip.rotation[2])))
        yaw = atan2(self.grip.rotation[1, side], self.grip.rotation[0, side])
        along = self.grip.grasp.closing + target.floor.yaw - yaw
        return usual, along, along + pi / 2

    def _fits(self, closing: float, target: Target) -> bool:
        """Return whether the object at a place is above its floor, if the fingers close along ``closing`` (rad)."""
        turn = closing - self.grip.grasp.closing - target.floor.yaw
        c, s = cos(turn), sin(turn)
        rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ self.grip.rotation
        half = half_sides(self._model, rotation)
        return all(
            abs(middle) + extent <= room
            for middle, extent, room in zip(target.floor.at(target.position), half, target.floor.half, strict=True)
        )
