"""Controller that picks an object from above and places it at a workspace.

It reads the object's pose at the start and then follows its plan; it only senses what its gripper holds.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.arm_control import ArmControl
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.put_down import on_tables
from robbdd_tools.world.put_poses import Grip, PutPoses
from robbdd_tools.world.reaching import Approach, Obstruction, approaches, over_support

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.grasp import Grasp
    from robbdd_tools.world.gripper import Step
    from robbdd_tools.world.motion import ToolPose
    from robbdd_tools.world.put_down import Target
    from robbdd_tools.world.simulation import Simulation

STILL, STILL_TURN, STILL_FOR = 2e-3, 0.02, 0.3
"""An object on a belt is at rest when it has stayed within this distance (m) and angle (rad) for this time (s).

In this time, the slowest belt moves the object by 3 mm. A belt that slips below it makes it tremble by some tenths
of a millimetre and some milliradians.
"""
PATIENCE = 30.0
"""Maximum wait for an object to come to rest, s."""
STOPPED = 0.05
"""A tool that is farther than this (m) from where its servos hold it was stopped by something: loads bend it less."""
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
        self._grip: Grip | None = None

    def pick(self, name: str, goals: Sequence[str] = ()) -> Step:
        """Grasp an object where it lies and lift it to the travelling height; raises ``BehaviourError``.

        If a belt runs, first wait until the object is at rest, and repeat the approach while the object has moved
        during it. Of several grasps, one with which the object can be put down at one of the ``goals`` is preferred.
        """
        yield from self._until_at_rest(name)
        self._emit("pick-start")
        yield from self.grasp(name, goals)
        self._emit("pick-end")

    def grasp(self, name: str, goals: Sequence[str] = ()) -> Step:
        """Grasp and lift an object as ``pick`` does, but at once and without events; raises ``BehaviourError``."""
        since = self.simulation.forces.row
        grip, best = yield from self._approach(name, goals)
        yield from self._take(best, name, since)
        self.held, self._grip = name, grip
        yield from self.move(best.above)

    def place(self, name: str, workspaces: Sequence[str]) -> Step:
        """Carry the held object to a workspace and release it; raises ``BehaviourError``.

        Of several workspaces, choose the first with room for the object, else the first that can be reached.
        """
        poses = self._put_poses(name)
        self._emit("place-start")
        yield from self._put(poses.at_one_of(workspaces, self._note_choice).pose, poses)
        self._emit("place-end")

    def lay_down(self, name: str, suits: Callable[[Target, Grasp], bool]) -> Step:
        """Put the held object down on a table at a place that suits; raises ``BehaviourError``."""
        poses, missed = self._put_poses(name), Obstruction()
        for target in on_tables(self.simulation, self.robot, name):
            if suits(target, poses.grip.grasp):
                found = poses.onto(target, missed)
                if found is not None:
                    yield from self._put(found.pose, poses)
                    return
        raise BehaviourError(f"{self.robot.name} finds no place on a table that both arms reach{missed}")

    def _put_poses(self, name: str) -> PutPoses:
        if self.held != name or self._grip is None:
            raise BehaviourError(f"{self.robot.name} does not hold {name}")
        return PutPoses(self, self._grip)

    def _put(self, down: ToolPose, poses: PutPoses) -> Step:
        over, here, since = poses.carried_to(down), self.tool, self.simulation.forces.row
        if over.height > here.height + RISE:
            yield from self.move(replace(here, height=over.height))
        yield from self.move_above(over, down)
        yield from self.move(down, self.robot.model.approach_speed)
        self._check_arrival(since)
        self.held = None
        yield from self.gripper.release(self)
        yield from self.wait(round(self.robot.model.release_time / TICK))
        grip = poses.grip
        yield from self.move(over_support(self.simulation, self.robot, grip.name, down, grip.grasp.below))

    def _check_arrival(self, since: int) -> None:
        """Raise ``BehaviourError`` if something stopped the arm on its way; ``since`` is the way's first sample."""
        off = self.deviation
        if off > STOPPED:
            error = f"{self.robot.name} did not arrive: its tool is {1000 * off:.0f} mm away"
            raise BehaviourError(f"{error}{self._touched(since, self.held)}")

    def pick_place(self, name: str, workspaces: Sequence[str]) -> Step:
        """Pick an object and place it at one of some workspaces; raises ``BehaviourError``."""
        yield from self.pick(name, workspaces)
        yield from self.place(name, workspaces)

    def _approach(self, name: str, goals: Sequence[str]) -> Generator[None, None, tuple[Grip, Approach]]:
        """Open the gripper and move above the grasp; return the grip and its approach; raises ``BehaviourError``.

        A part that balances with a corner against a belt's stop seems to be at rest for a while and then turns ever
        faster: a grasp that was chosen before would hit its top.
        """
        given_up = self.time + PATIENCE
        while True:
            best = self._choose_grasp(name, goals)
            planned = self.simulation.seen(name)
            yield from self.gripper.release(self)
            yield from self.move_above(best.above, best.at)
            if not self.simulation.belts or not _has_moved(planned, self.simulation.seen(name)):
                return Grip(name, best.grasp, best.at, planned[1]), best
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

    def _choose_grasp(self, name: str, goals: Sequence[str]) -> Approach:
        """Return the grasp with the most room for the hand, if possible of the part in the object's middle.

        Where the object would not fit one of the ``goals`` or could not be lowered into it, an equal grasp with which
        it can is preferred.
        """
        missed = Obstruction()
        found = sorted(approaches(self.simulation, self.robot, name, missed=missed), key=_rank)
        if not found:
            raise BehaviourError(f"{self.robot.name} cannot reach {name}{missed}")
        equal = [one for one in found if _rank(one)[:2] == _rank(found[0])[:2]]
        return next((one for one in equal if self._is_snug(name, one, goals)), found[0])

    def _is_snug(self, name: str, approach: Approach, goals: Sequence[str]) -> bool:
        """Return whether an object that is gripped so can be put down at one of the goals without a drop."""
        grip = Grip(name, approach.grasp, approach.at, self.simulation.seen(name)[1])
        try:
            return PutPoses(self, grip).at_one_of(goals, lambda _: None).is_snug
        except BehaviourError:
            return False

    def _take(self, best: Approach, name: str, since: int) -> Step:
        """Grip an object; ``since`` is the first sample of the approach. Raises ``BehaviourError``."""
        try:
            yield from self.gripper.take(self, best.at, name)
        except BehaviourError as error:
            if best.touched:
                raise BehaviourError(f"{error}: at the grasp, the arm touches {best.touched}") from error
            raise BehaviourError(f"{error}{self._touched(since, name)}") from error

    def _touched(self, since: int, part: str | None) -> str:
        """Return in words what the arm touched since a sample, beside the part that it grips."""
        touched = [one for one in self.simulation.forces.touched_since(since, self.robot.name) if one != part]
        return f": on its way, the arm touched {', '.join(touched)}" if touched else ""


def _has_moved(last: tuple[FloatArray, FloatArray], here: tuple[FloatArray, FloatArray]) -> bool:
    """Return whether two poses (position m, rotation matrix) differ by more than an object at rest trembles."""
    turned = np.arccos(np.clip((np.trace(last[1].T @ here[1]) - 1.0) / 2.0, -1.0, 1.0))
    return bool(np.linalg.norm(here[0] - last[0]) > STILL or turned > STILL_TURN)


def _rank(approach: Approach) -> tuple[float, bool, float]:
    return round(approach.depth, 4), approach.grasp.part is not None, abs(approach.at.turn)
