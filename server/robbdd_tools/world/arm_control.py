"""Move one arm of a simulation and its gripper. Each behaviour continues from the arm's last command."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.grip_force import slip_force
from robbdd_tools.world.gripper import Step, gripper_of
from robbdd_tools.world.motion import Motion, ToolPose, frame_of, plan, plan_joints, plan_through, present_pose
from robbdd_tools.world.parking import parking_pose
from robbdd_tools.world.reaching import at_travel

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.simulation import Simulation

SLIPPED = 3
"""The gripper has lost the object after this many ticks in a row without grip."""
ACCELERATED = 1.5
"""On its way, a part pulls at the fingers with at most its weight times this."""
HIT_BEFORE = round(0.5 / TICK)
"""A collision at most this many ticks ago may have torn an object out of the gripper."""
DIP = 0.05
"""While the joints move evenly, the tool may sink this far (m) below both ends of its path."""
LONG = 10.0
"""If a motion takes longer (s), an even motion of the joints replaces it if that takes at most half as long."""
TRIED = 40
"""About this many postures of an even motion are checked for collisions."""
ARRIVED = 1e-3
"""An arm is at its parking pose if the tool pose differs from it by at most this much (m, rad)."""


class ArmControl:
    """Moves one arm. Every generator sets the controls for one tick before each ``yield``.

    - ``joints``: the joint positions (rad) that the servos follow.
    - ``control``: the value of the gripper's actuator.
    - ``held``: the element that the gripper holds; a motion ends when the gripper loses it.
    """

    def __init__(self, simulation: Simulation, agent: str) -> None:
        self.simulation = simulation
        self.robot = simulation.robots[agent]
        self.arm = arm_of(self.robot.model)
        self.gripper = gripper_of(self.robot.model)
        self.joints: FloatArray = self.arm.home.copy()
        self.control = self.robot.model.gripper_open
        self.held: str | None = None
        self._limits: FloatArray = np.array(self.robot.model.velocity_limits)

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.simulation.time

    @property
    def tool(self) -> ToolPose:
        """The pose to which the servos move the tool."""
        return present_pose(self.arm, self.joints)

    @property
    def deviation(self) -> float:
        """How far (m) the tool is from where the servos hold it."""
        present = self.simulation.joint_positions(self.robot)
        return float(np.linalg.norm(self.arm.forward(present)[0] - self.arm.forward(self.joints)[0]))

    def senses_object(self, name: str) -> bool:
        """Return whether the gripping faces hold an object."""
        return self.simulation.holds(self.robot.name, name)

    def at_travel(self, pose: ToolPose) -> ToolPose:
        """Return a tool pose raised to the travelling height."""
        return at_travel(self.robot, pose)

    def move(self, goal: ToolPose, speed: float | None = None, until: Callable[[], bool] | None = None) -> Step:
        """Move the tool, at most at ``speed`` (m/s), until a condition holds.

        Raises ``BehaviourError`` if the path exceeds the joint limits or the held object is lost.
        """
        yield from self._follow(lambda limit: plan(self.arm, self.joints, goal, self._limits, limit), speed, until)

    def move_above(self, above: ToolPose, at: ToolPose) -> Step:
        """Move the tool to the pose ``above``, from which it can descend to ``at``. Raises like ``move``.

        If the straight path exceeds the joint limits, or takes long because the posture changes unevenly along it, the
        joints move evenly to another posture, if nothing is in the way. Arms with published results keep their paths.
        """

        def planned(limit: float) -> Motion:
            try:
                motion = plan(self.arm, self.joints, above, self._limits, limit)
                if self.arm.is_published:
                    return motion
                # Raises if the tool cannot descend from the last posture.
                self.arm.solve(motion.joints[-1], *frame_of(at))
                other = self._change_posture(above, at, limit) if len(motion.joints) * TICK > LONG else None
                return motion if other is None or len(other.joints) > len(motion.joints) / 2 else other
            except Unreachable:
                if self.arm.is_published:
                    raise
                motion = self._change_posture(above, at, limit)
                if motion is None:
                    raise
                return motion

        yield from self._follow(planned, None, None)

    def _change_posture(self, above: ToolPose, at: ToolPose, limit: float) -> Motion | None:
        """Return a collision-free motion to the nearest posture from which the tool can descend, if there is one."""
        clearance = Clearance(self.simulation, self.robot, self.held or "", self.simulation.data, control=self.control)
        lowest = min(self.tool.height, above.height) - DIP
        found = list(self.arm.solutions(*frame_of(above)))
        for goal in sorted(found, key=lambda one: float(np.abs(one - self.joints).max())):
            try:
                self.arm.solve(goal, *frame_of(at))
            except Unreachable:
                continue
            motion = plan_joints(self.arm, self.joints, goal, self._limits, limit)
            tried = motion.joints[:: max(1, len(motion.joints) // TRIED)]
            if all(self.arm.forward(one)[0][2] >= lowest and clearance.depth(one) == 0.0 for one in tried):
                return motion
        return None

    def move_through(self, poses: Sequence[ToolPose], speed: float, until: Callable[[], bool] | None = None) -> Step:
        """Move the tool through some poses without a stop. Raises like ``move``."""
        yield from self._follow(
            lambda limit: plan_through(self.arm, self.joints, poses, self._limits, limit), speed, until
        )

    def _follow(
        self, planned: Callable[[float], Motion], speed: float | None, until: Callable[[], bool] | None
    ) -> Step:
        limit = self.robot.model.tool_speed
        try:
            motion = planned(self.simulation.pace * min(limit, speed or limit))
        except Unreachable as error:
            where = f"at {self.time:.2f} s, {error}"
            raise BehaviourError(f"{self.robot.name} cannot follow its path within its joint limits {where}") from error
        missing = 0
        ahead = motion.joints + self.robot.lead * motion.velocities
        for joints, target in zip(motion.joints, ahead, strict=True):
            self.joints = joints
            self.simulation.command(self.robot, target, self.control)
            yield
            if until is not None and until():
                return
            missing = 0 if self.held is None or self.senses_object(self.held) else missing + 1
            if missing == SLIPPED:
                raise self.lost()

    def lost(self) -> BehaviourError:
        """Return the failure of an arm whose object has left the gripper, with what the object hit just before."""
        forces, held = self.simulation.forces, self.held or ""
        hit = forces.hit_since(forces.row - HIT_BEFORE, held)
        after = f" after {held} hit {', '.join(hit)}" if hit else ""
        return BehaviourError(f"gripper lost {held} at {self.time:.2f} s{after}{self._if_heavy(held)}")

    def _if_heavy(self, held: str) -> str:
        """Return in words that an object is too heavy for the friction of the fingers, if this may be so."""
        model, robot = self.simulation.model, self.robot
        if held not in self.simulation.world.cast.objects:
            return ""
        slips = slip_force(model, robot.name, robot.model, held)
        weight = float(model.body(held).mass[0] * np.linalg.norm(model.opt.gravity))
        if slips is None or ACCELERATED * weight < slips:
            return ""
        return f": its weight is {weight:.3g} N, and its friction in the fingers bears {slips:.3g} N"

    def wait(self, ticks: int) -> Step:
        """Stay in place."""
        for _ in range(ticks):
            self.simulation.command(self.robot, self.joints, self.control)
            yield

    def withdraw(self) -> Step:
        """Open the gripper and withdraw upwards after a failure."""
        self.held = None
        yield from self.gripper.release(self)
        try:
            yield from self.move(self.at_travel(self.tool))
        except BehaviourError:
            return

    def park(self) -> Step:
        """Move the tool out of the way of the other arms. The arm stays if it finds no path."""
        # A controller without planning may have moved the arm.
        self.joints = self.simulation.targets(self.robot)
        place = parking_pose(self.simulation, self.robot)
        if place is None or _distance(self.tool, place) <= ARRIVED:
            return
        try:
            yield from self.move(place)
        except BehaviourError:
            return


def _distance(one: ToolPose, other: ToolPose) -> float:
    """Return the largest difference (m, rad) of two tool poses."""
    pairs = (
        (one.radius, other.radius),
        (one.bearing, other.bearing),
        (one.height, other.height),
        (one.turn, other.turn),
    )
    return max(abs(first - second) for first, second in pairs)
