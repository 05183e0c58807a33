"""Controller that picks an object from above and places it at a workspace.

It reads the object's pose at the start and then follows its plan; it only senses what its gripper holds.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from math import cos, hypot, pi, remainder, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.arm_control import ArmControl
from robbdd_tools.world.arm_kinematics import Unreachable
from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.motion import ToolPose, tool_pose, yaw_of
from robbdd_tools.world.put_down import Target, has_room, on_tables, targets
from robbdd_tools.world.reaching import (
    Approach,
    Obstruction,
    approaches,
    either_way,
    is_high,
    joints_at,
    over_support,
)
from robbdd_tools.world.travel_clearance import height_over, is_roofed

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.grasp import Grasp
    from robbdd_tools.world.gripper import Step
    from robbdd_tools.world.simulation import Simulation

STILL, STILL_TURN, STILL_FOR = 2e-3, 0.02, 0.3
"""An object on a belt is at rest when it has stayed within this distance (m) and angle (rad) for this time (s).

In this time, the slowest belt moves the object by 3 mm. A belt that slips below it makes it tremble by some tenths
of a millimetre and some milliradians.
"""
PATIENCE = 30.0
"""Maximum wait for an object to come to rest, s."""
ROOM = 0.02
"""Room (m) below an object that is carried from or to a high support (``reaching.HIGH``)."""
ASIDE = 2e-3
"""If the tool grips an object at most this far (m) from its position, it puts it down as if there were no distance."""
RISE = 1e-3
"""If the travelling height is more than this (m) above the tool, it rises first: on a slant it could hit the place."""


class PickPlace(ArmControl):
    """Picks and places with one arm.

    ``emit`` is called with the name of each event when it occurs, ``note_choice`` with the workspace chosen among
    several.
    """

    def __init__(
        self,
        simulation: Simulation,
        agent: str,
        emit: Callable[[str], None],
        note_choice: Callable[[str], None] = lambda _: None,
    ) -> None:
        super().__init__(simulation, agent)
        self._emit = emit
        self._note_choice = note_choice
        self._grasp: Grasp | None = None
        self._yaw = 0.0
        self._from_high = False

    def pick(self, name: str) -> Step:
        """Grasp an object where it lies and lift it to the travelling height; raises ``BehaviourError``.

        If a belt runs, first wait until the object is at rest, and repeat the approach while the object has moved
        during it.
        """
        yield from self._until_at_rest(name)
        self._emit("pick-start")
        yield from self.grasp(name)
        self._emit("pick-end")

    def grasp(self, name: str) -> Step:
        """Grasp an object where it lies and lift it to the travelling height; raises ``BehaviourError``."""
        since = self.simulation.forces.row
        best = yield from self._approach(name)
        yield from self._take(best, name, since)
        self.held, self._grasp = name, best.grasp
        self._yaw = yaw_of(self.robot.base, best.at)
        self._from_high = is_high(self.robot, best.at, best.grasp.below)
        yield from self.move(best.above)

    def place(self, name: str, workspaces: Sequence[str]) -> Step:
        """Carry the held object to a workspace and release it; raises ``BehaviourError``.

        Of several workspaces, choose the first with room for the object, else the first that can be reached.
        """
        if self.held != name or self._grasp is None:
            raise BehaviourError(f"{self.robot.name} does not hold {name}")
        self._emit("place-start")
        down = self._choose_place(name, workspaces, self._grasp)
        yield from self._put(down, name, self._grasp)
        self._emit("place-end")

    def lay_down(self, name: str, suits: Callable[[Target, Grasp], bool]) -> Step:
        """Put the held object down on a table at a place that suits; raises ``BehaviourError``."""
        if self.held != name or self._grasp is None:
            raise BehaviourError(f"{self.robot.name} does not hold {name}")
        clearance, missed = Clearance(self.simulation, self.robot, name, self.simulation.data), Obstruction()
        for target in on_tables(self.simulation, self.robot, name):
            if suits(target, self._grasp):
                pose = self._lower_onto(target, name, self._grasp, clearance, missed)
                if pose is not None:
                    yield from self._put(pose, name, self._grasp)
                    return
        raise BehaviourError(f"{self.robot.name} finds no place on a table that both arms reach{missed}")

    def _put(self, down: ToolPose, name: str, grasp: Grasp) -> Step:
        over, here = self._carried_to(down, name, grasp), self.tool
        if over.height > here.height + RISE:
            yield from self.move(replace(here, height=over.height))
        yield from self.move_above(over, down)
        yield from self.move(down, self.robot.model.approach_speed)
        self.held = None
        yield from self.gripper.release(self)
        yield from self.wait(round(self.robot.model.release_time / TICK))
        yield from self.move(over_support(self.simulation, self.robot, name, down, grasp.below))

    def pick_place(self, name: str, workspaces: Sequence[str]) -> Step:
        """Pick an object and place it at one of some workspaces; raises ``BehaviourError``."""
        yield from self.pick(name)
        yield from self.place(name, workspaces)

    def _approach(self, name: str) -> Generator[None, None, Approach]:
        """Open the gripper and move above the grasp; return the grasp; raises ``BehaviourError``.

        A part that balances with a corner against a belt's stop seems to be at rest for a while and then turns ever
        faster: a grasp that was chosen before would hit its top.
        """
        given_up = self.time + PATIENCE
        while True:
            best = self._choose_grasp(name)
            planned = self.simulation.seen(name)
            yield from self.gripper.release(self)
            yield from self.move_above(best.above, best.at)
            if not self.simulation.belts or not _has_moved(planned, self.simulation.seen(name)):
                return best
            if self.time > given_up:
                raise BehaviourError(f"{name} has not come to rest within {PATIENCE:g} s")
            yield from self._until_at_rest(name)

    def _until_at_rest(self, name: str) -> Step:
        if not self.simulation.belts or name not in self.simulation.world.cast.objects:
            return
        last, since = self.simulation.seen(name), 0
        for _ in range(round(PATIENCE / TICK)):
            yield from self.wait(1)
            here, since = self.simulation.seen(name), since + 1
            if _has_moved(last, here):
                last, since = here, 0
            if since * TICK >= STILL_FOR:
                return
        raise BehaviourError(f"{name} has not come to rest within {PATIENCE:g} s")

    def _choose_grasp(self, name: str) -> Approach:
        """Return the grasp with the most room for the hand, if possible of the part in the object's middle."""
        missed = Obstruction()
        found = approaches(self.simulation, self.robot, name, missed=missed)
        best = min(
            found, key=lambda one: (round(one.depth, 4), one.grasp.part is not None, abs(one.at.turn)), default=None
        )
        if best is None:
            raise BehaviourError(f"{self.robot.name} cannot reach {name}{missed}")
        return best

    def _take(self, best: Approach, name: str, since: int) -> Step:
        """Grip an object; ``since`` is the first sample of the approach. Raises ``BehaviourError``."""
        try:
            yield from self.gripper.take(self, best.at, name)
        except BehaviourError as error:
            if best.touched:
                raise BehaviourError(f"{error}: at the grasp, the arm touches {best.touched}") from error
            touched = [one for one in self.simulation.forces.touched_since(since, self.robot.name) if one != name]
            if not touched:
                raise
            raise BehaviourError(f"{error}: on its way, the arm touched {', '.join(touched)}") from error

    def _choose_place(self, name: str, workspaces: Sequence[str], grasp: Grasp) -> ToolPose:
        if len(workspaces) == 1:
            return self._choose_target(name, workspaces[0], grasp)
        simulation, robot = self.simulation, self.robot
        # Sorting is stable: workspaces with room keep their order, and so do those without.
        for workspace in sorted(workspaces, key=lambda one: not has_room(simulation, robot, name, one)):
            try:
                found = self._choose_target(name, workspace, grasp)
            except BehaviourError:
                continue
            self._note_choice(workspace)
            return found
        raise BehaviourError(f"{robot.name} cannot reach a free place at any of {', '.join(workspaces)}")

    def _choose_target(self, name: str, workspace: str, grasp: Grasp) -> ToolPose:
        """Return the lowest tool pose over the first target that the arm reaches without a collision."""
        simulation, robot = self.simulation, self.robot
        clearance = Clearance(simulation, robot, name, simulation.data)
        missed = Obstruction()
        for target in targets(simulation, robot, name, workspace):
            pose = self._lower_onto(target, name, grasp, clearance, missed)
            if pose is not None:
                return pose
        raise BehaviourError(f"{robot.name} cannot reach a free place at {workspace}{missed}")

    def _lower_onto(
        self, target: Target, name: str, grasp: Grasp, clearance: Clearance, missed: Obstruction
    ) -> ToolPose | None:
        robot = self.robot
        x, y, surface = target.position
        height = surface + grasp.below + target.gap
        top = max(robot.travel_height, height)
        closing = target.closing if target.closing is not None else grasp.closing
        while height <= top:
            found = self._reached(np.array([x, y, height]), closing, name, grasp, missed)
            if found is None:
                return None
            pose, joints = found
            hit = clearance.hit(joints)
            if hit.depth == 0.0:
                return pose
            missed.touched[hit.owner] = None
            height += 0.02
        return None

    def _reached(
        self, place: FloatArray, closing: float, name: str, grasp: Grasp, missed: Obstruction
    ) -> tuple[ToolPose, FloatArray] | None:
        """Return a tool pose that brings an object to a place (m), and the joint positions (rad) there."""
        for pose in self._bringing(place, closing, grasp):
            try:
                return pose, joints_at(self.arm, self._carried_to(pose, name, grasp), pose)
            except Unreachable as error:
                missed.note(error)
        return None

    def _bringing(self, place: FloatArray, closing: float, grasp: Grasp) -> tuple[ToolPose, ...]:
        """Return the tool poses, with either finger on either side, for an object at a place (m)."""
        base = self.robot.base
        if hypot(*grasp.aside) < ASIDE:
            return either_way(self.arm, tool_pose(base, place, closing))
        found: list[ToolPose] = []
        for yaw in (closing - pi / 2, closing + pi / 2):
            c, s = cos(yaw - self._yaw), sin(yaw - self._yaw)
            x, y = grasp.aside
            tool = place - np.array([c * x - s * y, s * x + c * y, 0.0])
            both = either_way(self.arm, tool_pose(base, tool, closing))
            found += [pose for pose in both if abs(remainder(yaw_of(base, pose) - yaw, 2 * pi)) < pi / 2]
        return tuple(found)

    def _carried_to(self, pose: ToolPose, name: str, grasp: Grasp) -> ToolPose:
        """Return the pose above ``pose`` to which the tool carries an object, high enough to clear shapes below."""
        over = self.at_travel(pose)
        room = self.robot.model.carry_clearance
        if not room and (self._from_high or is_high(self.robot, pose, grasp.below)):
            room = 0.0 if is_roofed(self.simulation, self.robot, name, pose) else ROOM
        if not room:
            return over
        here = self.tool
        needed = height_over(self.simulation, self.robot, name, here, pose) + room + grasp.below
        return replace(over, height=max(over.height, needed))


def _has_moved(last: tuple[FloatArray, FloatArray], here: tuple[FloatArray, FloatArray]) -> bool:
    """Return whether two poses (position m, rotation matrix) differ by more than an object at rest trembles."""
    turned = np.arccos(np.clip((np.trace(last[1].T @ here[1]) - 1.0) / 2.0, -1.0, 1.0))
    return bool(np.linalg.norm(here[0] - last[0]) > STILL or turned > STILL_TURN)
