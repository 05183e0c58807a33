"""Kinds of grippers behind one interface: possible grasps, gripping and releasing."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.grasp import PLAY, Grasp, finger_grasps, suction_grasps

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, ObjectModel, RobotModel
    from robbdd_tools.world.motion import ToolPose

CLOSING = 0.05
"""Speed of one finger, m/s."""
PATIENCE = 60
"""The gripper has missed the object if it does not hold it this many ticks after the closing time."""
OFF = 0.002
"""Rotating fingers keep this distance (m) from the support of an object."""
STANDOFF, PRESS = 0.015, 0.010
"""A cup starts its slow descent this high (m) above the object and gives up this deep (m) below the object's top."""
DESCENT = 0.05
"""Speed of a cup just before contact, m/s."""

Step = Iterator[None]
"""Yields once per control tick, when the controls are set and the world may be stepped."""


class Hand(Protocol):
    """The interface between a gripper and the controller that moves it. ``control`` is the gripper's actuator value."""

    control: float

    def move(self, goal: ToolPose, speed: float | None = None, until: Callable[[], bool] | None = None) -> Step:
        """Move the tool, at most at ``speed`` (m/s), until a condition holds; raises ``BehaviourError``."""
        ...

    def wait(self, ticks: int) -> Step:
        """Stay in place."""
        ...

    def senses_object(self, name: str) -> bool:
        """Return whether the gripping faces hold an object."""
        ...

    @property
    def time(self) -> float:
        """Simulated time, s."""
        ...


class Gripper(ABC):
    """How one kind of gripper works; it keeps no state."""

    def __init__(self, robot: RobotModel) -> None:
        self._robot = robot
        self._motion = finger_motion(robot)
        self._firm = max(1, round(robot.grip_time / TICK))

    @abstractmethod
    def grasps(self, name: str, model: ObjectModel, position: FloatArray, rotation: FloatArray) -> list[Grasp]:
        """Return the grasps of an object at a pose; raises ``BehaviourError`` if it does not fit."""

    @abstractmethod
    def take(self, hand: Hand, at: ToolPose, name: str) -> Step:
        """Move down to a grasp and grip; raises ``BehaviourError`` on failure."""

    @abstractmethod
    def release(self, hand: Hand) -> Step:
        """Release everything."""

    @abstractmethod
    def close(self, hand: Hand) -> Step:
        """Close without an object, so that the gripper can push."""

    def control_around(self, width: float) -> float:
        """Return the control value at which the gripper is open just enough for a width (m), where this is known."""
        del width
        return self._robot.gripper_open

    def open_to(self, hand: Hand, control: float) -> Step:
        """Open or close to a control value."""
        del control
        yield from self.release(hand)


class Fingers(Gripper):
    """Two fingers that close on an object and hold it by friction."""

    def grasps(self, name: str, model: ObjectModel, position: FloatArray, rotation: FloatArray) -> list[Grasp]:
        """Return the grasps across the object's sides that are narrow enough."""
        found = finger_grasps(name, model, position, rotation, self._robot.stroke, self._motion.narrowest)
        return [self._off_the_support(grasp) for grasp in found]

    def _off_the_support(self, grasp: Grasp) -> Grasp:
        """Return the grasp, raised if necessary, so that the tips of rotating fingers clear the object's support."""
        reach = self._motion.reach(grasp.width)
        lift = reach + OFF - grasp.below if reach else 0.0
        if lift <= 0.0:
            return grasp
        return replace(grasp, position=grasp.position + np.array([0.0, 0.0, lift]), below=grasp.below + lift)

    def take(self, hand: Hand, at: ToolPose, name: str) -> Step:
        """Move around the object and close until both fingers press on it."""
        yield from hand.move(at, self._robot.approach_speed)
        held = 0
        closed, step = self._robot.gripper_closed, CLOSING * TICK * self._motion.rate
        for _ in range(int(abs(hand.control - closed) / step) + max(PATIENCE, round(self._motion.settling / TICK))):
            hand.control = _towards(closed, hand.control, step)
            yield from hand.wait(1)
            held = held + 1 if hand.senses_object(name) else 0
            if held == self._firm:
                hand.control = closed
                yield from hand.wait(self._firm)
                return
        raise BehaviourError(f"gripper missed {name} at {hand.time:.2f} s")

    def release(self, hand: Hand) -> Step:
        """Open the fingers at their speed."""
        yield from self.open_to(hand, self._robot.gripper_open)

    def close(self, hand: Hand) -> Step:
        """Close the fingers at their speed."""
        yield from self.open_to(hand, self._robot.gripper_closed)

    def control_around(self, width: float) -> float:
        """Return the control value at which the fingers are open just enough for a width (m).

        For fingers from files, whose positions in between are unknown, return the value of the open gripper.
        """
        if self._motion.open_joints:
            return self._robot.gripper_open
        less = max(0.0, self._robot.stroke - width - PLAY) / 2
        return _towards(self._robot.gripper_closed, self._robot.gripper_open, less * self._motion.rate)

    def open_to(self, hand: Hand, control: float) -> Step:
        """Move the fingers to a control value at their speed."""
        while hand.control != control:
            hand.control = _towards(control, hand.control, CLOSING * TICK * self._motion.rate)
            yield from hand.wait(1)


class Cup(Gripper):
    """A suction cup: it must touch the object before it can hold it."""

    def grasps(self, name: str, model: ObjectModel, position: FloatArray, rotation: FloatArray) -> list[Grasp]:
        """Return the grasps on the object's top."""
        return suction_grasps(name, model, position, rotation, self._robot.stroke)

    def take(self, hand: Hand, at: ToolPose, name: str) -> Step:
        """Descend slowly with the vacuum on until the cup touches the object."""
        yield from hand.move(replace(at, height=at.height + STANDOFF), self._robot.approach_speed)
        hand.control = self._robot.gripper_closed
        lowest = replace(at, height=at.height - PRESS)
        yield from hand.move(
            lowest, min(DESCENT, self._robot.approach_speed or DESCENT), lambda: hand.senses_object(name)
        )
        yield from hand.wait(self._firm)
        if not hand.senses_object(name):
            raise BehaviourError(f"suction cup found no hold on {name} at {hand.time:.2f} s")

    def release(self, hand: Hand) -> Step:
        """Switch the vacuum off."""
        hand.control = self._robot.gripper_open
        yield from hand.wait(1)

    def close(self, hand: Hand) -> Step:
        """Push without vacuum."""
        yield from self.release(hand)


def _towards(goal: float, present: float, step: float) -> float:
    """Return a control value one step nearer to a goal."""
    return max(goal, present - step) if goal < present else min(goal, present + step)


def gripper_of(robot: RobotModel) -> Gripper:
    """Return the kind of a robot's gripper."""
    return {GripperKind.PARALLEL: Fingers, GripperKind.SUCTION: Cup}[robot.gripper](robot)
