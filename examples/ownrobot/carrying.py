"""Our own behaviour: above, down, close, up, across, down, open, up."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.own_behaviour import BehaviourFailed, World

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, FloatArray

TRAVEL = 0.35
"""Height at which objects are carried, m, world frame."""
PACE = 0.01
"""Largest change of a joint per tick, rad."""


class Carry:
    """Picks a cube and places it; see ``robbdd_tools.catalog.own_behaviour.UserBehaviour``."""

    def reset(self, world: World, behaviour: str, arguments: Arguments) -> None:
        """Store the arguments and start the motion."""
        if behaviour != "pick-place":
            raise BehaviourFailed(f"this arm does not know how to {behaviour}")
        self._world = world
        self._target = world.joints
        self._opening = 1.0
        place = arguments["workspace"]
        # For a set of workspaces, use the first one.
        self._ticks = self._carry(str(arguments["object"]), place if isinstance(place, str) else place[0])

    def step(self) -> bool:
        """Execute one tick; return whether the behaviour is over."""
        try:
            next(self._ticks)
        except StopIteration:
            return True
        self._world.command(self._target, self._opening)
        return False

    def _carry(self, name: str, workspace: str) -> Iterator[None]:
        world = self._world
        world.emit("pick-start")
        position, rotation = world.pose(name)
        closing = _across(rotation)
        yield from self._to(np.array([position[0], position[1], TRAVEL]), closing)
        yield from self._to(position, closing)
        yield from self._grip(0.0)
        if not world.holds(name):
            raise BehaviourFailed(f"the fingers closed beside {name}")
        yield from self._to(np.array([position[0], position[1], TRAVEL]), closing)
        world.emit("pick-end")
        world.emit("place-start")
        goal = world.place(workspace)
        # A hand fits into the bin along its length, which here is across the table.
        yield from self._to(np.array([goal[0], goal[1], TRAVEL]), np.pi / 2)
        yield from self._to(goal + np.array([0.0, 0.0, 0.05]), np.pi / 2)
        yield from self._grip(1.0)
        yield from self._to(np.array([goal[0], goal[1], TRAVEL]), np.pi / 2)
        world.emit("place-end")

    def _to(self, position: FloatArray, closing: float) -> Iterator[None]:
        """Move the joints evenly until the tool is at a position."""
        goal = self._world.solve(position, closing)
        start = self._target
        count = max(1, int(np.ceil(np.abs(goal - start).max() / PACE)))
        for number in range(1, count + 1):
            self._target = start + (goal - start) * number / count
            yield

    def _grip(self, opening: float) -> Iterator[None]:
        """Open or close the fingers within 50 ticks, and wait until they hold."""
        start = self._opening
        for number in range(1, 71):
            self._opening = start + (opening - start) * min(1.0, number / 50)
            yield


def _across(rotation: FloatArray) -> float:
    """Return a direction (rad) across a cube: that of its most horizontal axis."""
    flattest = int(np.argmin(np.abs(rotation[2])))
    return atan2(rotation[1, flattest], rotation[0, flattest])
