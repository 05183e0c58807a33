"""The behaviour that the paper tested: a state machine whose phases last for fixed times and check nothing.

Targets jump or blend between fixed points. The tool follows them as under the target attractor of RMPflow: a spring
that pulls with limited acceleration, and damping. The other policies of RMPflow (joint posture, obstacles) are left
out.
The orientation of the tool is constant: straight down, fingers along the y axis of the robot's base.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import cos, exp, pi
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.catalog.timetables import STEPS_PER_SECOND, timetable_of
from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.finger_motion import finger_motion

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.gripper import Step
    from robbdd_tools.world.simulation import Simulation

ABOVE, LOWER, SETTLE, CLOSE, LIFT, CROSS, LOWER_AT_GOAL, OPEN, RISE, BACK = range(10)
FINGER_SPEED = 0.2
"""Speed (m/s) of one finger: the limit in the Panda hand's public URDF, which the experiment's simulator uses."""
DOWN = np.diag([1.0, -1.0, -1.0])
"""Orientation of the tool in the frame of the robot's base."""


class TimedPickPlace:
    """Executes one robot's pick-and-place by its timetable. ``emit`` is called with the name of each event."""

    def __init__(self, simulation: Simulation, agent: str, emit: Callable[[str], None]) -> None:
        self._simulation = simulation
        self._robot = simulation.robots[agent]
        self._arm = arm_of(self._robot.model)
        self._times = timetable_of(self._robot.model.name)
        self._emit = emit
        model = self._robot.model
        self._opening = model.gripper_open
        self._speed = simulation.world.cast.chosen.get((agent, "follow_speed"), (self._times.follow_speed,))[0]
        self._limits: FloatArray = np.array(model.velocity_limits) * TICK
        self._joints: FloatArray = self._arm.home.copy()
        self._ahead: FloatArray = self._joints
        self._velocity: FloatArray = np.zeros(3)
        turn = self._robot.base.yaw
        self._base: FloatArray = np.array(self._robot.base.position)
        self._from_base: FloatArray = np.array(
            [[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]]
        )

    def pick_place(self, name: str, workspaces: Sequence[str]) -> Step:
        """Execute all phases. The goal is the middle of the first workspace that has a carrier in the scene."""
        goal = self._middle(workspaces) + self._times.offset
        self._emit("pick-start")
        part = self._part(name)
        for phase in range(len(self._times.shares)):
            if phase == CROSS:
                self._emit("pick-end")
                self._emit("place-start")
            closed = CLOSE <= phase < OPEN
            for share in self._progress(phase):
                if phase <= LOWER:
                    part = self._part(name)
                self._follow(self._target(phase, share, part, goal))
                self._grip(closed=closed)
                self._simulation.command(self._robot, self._ahead, self._opening)
                yield
        self._emit("place-end")

    def _progress(self, phase: int) -> Iterator[float]:
        """Yield the blend of a phase, from 0 to 1, in each control tick; a phase takes at least one tick."""
        ticks = max(1, round(1.0 / self._times.shares[phase] / STEPS_PER_SECOND / TICK))
        for tick in range(ticks):
            yield (1.0 - cos(pi * (tick + 1) / ticks)) / 2.0

    def _target(self, phase: int, share: float, part: FloatArray, goal: FloatArray) -> FloatArray:
        """Return the position (3,) m, world frame, of the tool's target."""
        travel = self._robot.travel_height
        heights = {
            ABOVE: (travel, travel),
            LOWER: (travel, part[2]),
            SETTLE: (part[2], part[2]),
            CLOSE: (part[2], part[2]),
            LIFT: (part[2], travel),
            LOWER_AT_GOAL: (travel, goal[2]),
            OPEN: (goal[2], goal[2]),
            RISE: (goal[2], travel),
        }
        low, high = heights.get(phase, (travel, travel))
        across = 0.0 if phase < CROSS else 1.0
        if phase in (CROSS, BACK):
            across = share if phase == CROSS else 1.0 - share
        x, y = (part + across * (goal - part))[:2]
        return np.array([x, y, low + share * (high - low)])

    def _follow(self, target: FloatArray) -> None:
        """Move the joints for one tick towards the tool's next position. If it is out of reach, they stay."""
        position, _ = self._arm.forward(self._joints)
        gap = self._from_base.T @ (target - self._base) - position
        pull = self._simulation.pace * self._speed * gap / (float(np.linalg.norm(gap)) + self._times.near)
        kept = exp(-self._times.damping * TICK)
        self._velocity = kept * self._velocity + (1.0 - kept) * pull
        self._ahead = self._joints
        try:
            found = self._arm.solve(self._joints, position + TICK * self._velocity, DOWN)
        except Unreachable:
            self._velocity = np.zeros(3)
            return
        step = found - self._joints
        step /= max(1.0, float((np.abs(step) / self._limits).max()))
        self._joints = self._joints + step
        self._ahead = self._joints + self._robot.lead * step / TICK

    def _grip(self, *, closed: bool) -> None:
        """Switch the vacuum, or move the fingers by one tick."""
        model = self._robot.model
        wanted = model.gripper_closed if closed else model.gripper_open
        step = FINGER_SPEED * TICK * finger_motion(model).rate
        if model.gripper is GripperKind.SUCTION:
            step = abs(model.gripper_closed - model.gripper_open)
        self._opening += min(step, max(-step, wanted - self._opening))

    def _part(self, name: str) -> FloatArray:
        return self._simulation.seen(name)[0] + self._times.offset

    def _middle(self, workspaces: Sequence[str]) -> FloatArray:
        """Return the middle (3,) m of a workspace in the world frame; raises ``SceneError``."""
        for workspace in workspaces:
            for carrier, region in self._simulation.world.cast.regions.get(workspace, ()):
                position, rotation = self._simulation.seen_place(carrier)
                return position + rotation @ np.array(region.center)
        raise SceneError(f"nothing in the scene carries {' or '.join(workspaces)}")
