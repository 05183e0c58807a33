"""A fault of the robot in a running simulation: what it perceives, commands and grips differs from the truth."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.world.engine import TICK

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.robot_faults import RobotFault
    from robbdd_tools.world.robot import Robot

FAULTS = 2
"""Number of the random stream of faults: the streams of the scene and of places start from the same seed."""


class Disturbance:
    """One fault in a simulation. Everything random in it is drawn from the scenario's seed."""

    def __init__(
        self, fault: RobotFault, seed: int, robots: Mapping[str, Robot], holds: Callable[[str], bool], model: Any
    ) -> None:
        """Weaken the grippers in the engine's ``model`` if this is the fault.

        ``holds`` returns whether the gripper of a robot holds anything.
        """
        self._fault = fault
        self._robots = robots
        self._holds = holds
        self._draw = np.random.default_rng((seed, FAULTS))
        angle = self._draw.uniform(0.0, 2.0 * np.pi)
        self._beside: FloatArray = 1e-3 * fault.size * np.array([np.cos(angle), np.sin(angle), 0.0])
        self._arms = {name: _Arm() for name in robots}
        if fault.name == "weak-grip":
            for robot in robots.values():
                _weaken(model, robot, fault.size)

    @property
    def pace(self) -> float:
        """The speed of the arm as a multiple of its undisturbed speed."""
        return self._fault.size if self._fault.name in ("slow-arm", "fast-arm") else 1.0

    def seen(self, position: FloatArray) -> FloatArray:
        """Return the position (3,) m at which the robots see something."""
        match self._fault.name:
            case "offset-pose":
                return position + self._beside
            case "sensor-noise":
                return position + 1e-3 * self._fault.size * self._draw.standard_normal(3)
            case _:
                return position

    def seen_place(self, position: FloatArray) -> FloatArray:
        """Return the position (3,) m at which the robots see something that carries a goal."""
        raised = 1e-3 * self._fault.size if self._fault.name == "high-release" else 0.0
        return self.seen(position) + np.array([0.0, 0.0, raised])

    def command(self, robot: Robot, joints: FloatArray, control: float) -> tuple[FloatArray, float]:
        """Return the targets of the joints (rad) and the gripper's control value that replace the given ones."""
        arm, closed, opened = self._arms[robot.name], robot.model.gripper_closed, robot.model.gripper_open
        arm.note(control, closed, opened, holds=self._holds(robot.name))
        arm.commanded = (joints, control)
        match self._fault.name:
            case "backlash":
                return self._with_backlash(arm, joints), control
            case "no-grip":
                return joints, opened
            case "no-release" if arm.tightest is not None:
                return joints, arm.tightest
            case "no-retreat" if arm.opening:
                arm.last = joints if arm.last is None else arm.last
                return arm.last, control
            case "late-release" if arm.opening and arm.tightest is not None:
                arm.waiting.append(np.array([control]))
                late = arm.waiting.popleft()[0] if arm.opening > self._ticks else arm.tightest
                return joints, float(late)
            case "early-release":
                return arm.delayed(joints, self._ticks if arm.tightest is not None and not arm.opening else 0), control
            case _:
                return joints, control

    def end_tick(self, command: Callable[[Robot, FloatArray, float], None]) -> None:
        """Repeat the last command of each arm that has ended its behaviour but still has delayed commands."""
        for name, arm in self._arms.items():
            if arm.commanded is None and arm.last_command is not None and arm.waiting:
                command(self._robots[name], *arm.last_command)
            arm.last_command, arm.commanded = arm.commanded or arm.last_command, None

    @property
    def _ticks(self) -> int:
        return max(1, round(self._fault.size / TICK))

    def _with_backlash(self, arm: _Arm, joints: FloatArray) -> FloatArray:
        """Move the first joint only as far as its target is beyond the play of the gears."""
        half = np.deg2rad(self._fault.size) / 2.0
        last = joints if arm.last is None else arm.last
        arm.last = joints.copy()
        arm.last[0] = np.clip(last[0], joints[0] - half, joints[0] + half)
        return arm.last


class _Arm:
    """State of one robot with a fault.

    ``tightest`` is the gripper's tightest control value since it has held something; ``opening`` counts the ticks since
    it began to open again. ``waiting`` are delayed commands, ``commanded`` is the command of this tick.
    """

    def __init__(self) -> None:
        self.tightest: float | None = None
        self.opening = 0
        self.last: FloatArray | None = None
        self.waiting: deque[FloatArray] = deque()
        self.commanded: tuple[FloatArray, float] | None = None
        self.last_command: tuple[FloatArray, float] | None = None

    def note(self, control: float, closed: float, opened: float, *, holds: bool) -> None:
        """Follow the gripper by its control value, which is between ``closed`` and ``opened``."""
        if self.tightest is None:
            self.tightest = control if holds and control != opened else None
        elif self.opening or abs(control - closed) > abs(self.tightest - closed):
            self.opening += 1
        else:
            self.tightest = control

    def delayed(self, joints: FloatArray, ticks: int) -> FloatArray:
        """Return the targets (rad) of ``ticks`` ago. When a delay ends, the arm catches up while it waits."""
        self.waiting.append(joints)
        first = self.waiting[0]
        if len(self.waiting) > ticks:
            self.waiting.popleft()
        while len(self.waiting) > ticks and np.array_equal(self.waiting[0], first):
            self.waiting.popleft()
        return first


def _weaken(model: Any, robot: Robot, share: float) -> None:
    """Reduce the force of a gripper. A servo keeps its gains, which position its fingers; its limit is reduced."""
    number = robot.gripper
    if robot.model.gripper is GripperKind.PARALLEL and model.actuator_forcelimited[number]:
        model.actuator_forcerange[number] *= share
    else:
        model.actuator_gainprm[number] *= share
        model.actuator_biasprm[number] *= share
