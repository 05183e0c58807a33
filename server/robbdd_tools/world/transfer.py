"""Controller of two arms: one gives an object to the other at a place on a table."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.arm_kinematics import Unreachable
from robbdd_tools.world.grasp import ROUND
from robbdd_tools.world.motion import tool_pose
from robbdd_tools.world.reaching import joints_at

if TYPE_CHECKING:
    from robbdd_tools.world.grasp import Grasp
    from robbdd_tools.world.gripper import Step
    from robbdd_tools.world.pick_place import PickPlace
    from robbdd_tools.world.put_down import Target


class HandOver:
    """Gives objects from one arm to another. ``emit`` is called with the name of each event when it occurs."""

    def __init__(self, giver: PickPlace, receiver: PickPlace, emit: Callable[[str], None]) -> None:
        self._giver = giver
        self._receiver = receiver
        self._emit = emit

    def hand_over(self, name: str) -> Step:
        """Hand over an object; the giver picks it first if it does not hold it. Raises ``BehaviourError``."""
        self._emit("hand-over-start")
        if self._giver.held != name:
            yield from self._receiver.park()
            yield from self._giver.grasp(name)
        yield from self._giver.lay_down(name, self._is_in_reach)
        self._emit("laid-down")
        yield from self._giver.park()
        yield from self._receiver.grasp(name)
        self._emit("hand-over-end")

    def _is_in_reach(self, target: Target, grasp: Grasp) -> bool:
        """Return whether the receiver reaches an object at a place with some direction of its fingers."""
        robot, arm = self._receiver.robot, self._receiver.arm
        place = np.add(target.position, (0.0, 0.0, grasp.below))
        for step in range(ROUND):
            pose = tool_pose(robot.base, place, pi * step / ROUND)
            try:
                joints_at(arm, self._receiver.at_travel(pose), pose)
            except Unreachable:
                continue
            return True
        return False
