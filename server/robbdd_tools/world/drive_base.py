"""Controller that drives a mobile base to a workspace."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil, hypot
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.base_routes import Route, RouteSearch, angle, cost
from robbdd_tools.world.base_space import BaseSpace
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.motion import PEAK_ACCELERATION, PEAK_SPEED, present_pose
from robbdd_tools.world.standing_places import standing_places

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.arm_control import ArmControl
    from robbdd_tools.world.gripper import Step
    from robbdd_tools.world.mobile_base import BaseState

ACCELERATION, ANGULAR = 0.8, 2.0
"""Largest accelerations of a base, m/s² and rad/s²."""
ROOM = (0.05, 0.02, 0.0)
"""The robot keeps the first of these distances (m) from everything that leaves it a route."""
MARGIN = 1.0
"""Routes are also searched this far (m) around the scene."""
BEHIND, TWISTED = 0.05, 0.1
"""A base is blocked if it is farther (m, rad) than this from its planned pose on the route."""
ARRIVED, AIMED = 0.02, 0.03
"""A base has arrived if it deviates from its goal by at most this much (m, rad)."""
SETTLING = 0.3
"""At its goal, the base settles for this time (s) before its pose is checked."""
LOST = 3
"""The gripper has lost the object after this many ticks in a row without grip."""


class DriveBase:
    """Drives the mobile base of one arm. ``emit`` is called with the name of each event when it occurs."""

    def __init__(self, hand: ArmControl, emit: Callable[[str], None]) -> None:
        self._hand = hand
        self._emit = emit
        self._simulation = hand.simulation
        self._robot = hand.robot
        self._missing = 0

    def move_to(self, workspaces: Sequence[str]) -> Step:
        """Drive to a place from which the arm reaches one of the workspaces; raises ``BehaviourError``.

        The arm first takes its home posture, with the object in its gripper. The route is planned once.
        """
        self._emit("move-start")
        hand = self._hand
        home = present_pose(hand.arm, hand.arm.home)
        yield from hand.move(replace(home, height=max(hand.at_travel(home).height, hand.tool.height)))
        since = self._simulation.forces.row
        route = self._route(workspaces)
        pose = route[0]
        for one, other in pairwise(route):
            way = np.array([other[0] - one[0], other[1] - one[1], angle(float(other[2] - one[2]))])
            yield from self._leg(pose, way, since)
            # The angle may exceed half a turn, as the joint's angle does.
            pose = pose + way
        yield from hand.wait(round(SETTLING / TICK))
        self._check(pose, ARRIVED, AIMED, since)
        self._emit("move-end")

    def _route(self, workspaces: Sequence[str]) -> Route:
        """Return the shortest route to a standing place at one of the workspaces; raises ``BehaviourError``."""
        blocked: dict[str, None] = {}
        for room in ROOM:
            space = BaseSpace(self._simulation, self._robot, self._hand.held, room)
            search = RouteSearch(space.is_free, *space.bounds(MARGIN))
            places = [
                place
                for workspace in workspaces
                for place in standing_places(self._simulation, self._robot, workspace, space.is_free)
            ]
            direct = [route for place in places if (route := search.direct(space.start, place)) is not None]
            if direct:
                return min(direct, key=cost)
            for place in sorted(places, key=lambda place: float(np.hypot(*(place - space.start)[:2]))):
                route = search.around(space.start, place)
                if route is not None:
                    return route
            blocked = space.touched
        where = " or ".join(workspaces)
        reason = f": in the way are {', '.join(blocked)}" if blocked else ": it is out of the arm's reach"
        raise BehaviourError(f"{self._robot.name} finds no way to {where}{reason}")

    def _leg(self, start: FloatArray, way: FloatArray, since: int) -> Step:
        """Turn on the spot or drive straight from a pose to the next one on the route."""
        limits = self._limits()
        length, turn = hypot(way[0], way[1]), float(way[2])
        duration = max(
            PEAK_SPEED * length / limits[0],
            PEAK_SPEED * abs(turn) / limits[1],
            (PEAK_ACCELERATION * length / ACCELERATION) ** 0.5,
            (PEAK_ACCELERATION * abs(turn) / ANGULAR) ** 0.5,
        )
        ticks = ceil(duration / TICK)
        for tick in range(1, ticks + 1):
            time = tick / ticks
            progress = time**3 * (10.0 + time * (6.0 * time - 15.0))
            speed = 30.0 * time**2 * (1.0 - time) ** 2 / (ticks * TICK)
            yield from self._tick(start + progress * way, speed * way, since)

    def _limits(self) -> tuple[float, float]:
        """Return the largest speeds (m/s, rad/s)."""
        base = self._mobile.limits
        return base.speed * self._simulation.pace, base.turning * self._simulation.pace

    @property
    def _mobile(self) -> BaseState:
        assert self._robot.mobile is not None, "only mobile bases drive"
        return self._robot.mobile

    def _tick(self, pose: FloatArray, velocity: FloatArray, since: int) -> Step:
        """Move the base for one tick; raises ``BehaviourError`` if it is blocked or if the arm loses its object."""
        hand, simulation = self._hand, self._simulation
        simulation.drive(self._robot, pose + self._mobile.lead * velocity)
        simulation.command(self._robot, hand.joints, hand.control)
        yield
        self._check(pose, BEHIND, TWISTED, since)
        self._missing = 0 if hand.held is None or hand.senses_object(hand.held) else self._missing + 1
        if self._missing == LOST:
            raise hand.lost()

    def _check(self, pose: FloatArray, distance: float, turn: float, since: int) -> None:
        """Stop the base and raise ``BehaviourError`` if it is farther (m, rad) from a pose than given."""
        gap = pose - self._here
        if hypot(gap[0], gap[1]) > distance or abs(gap[2]) > turn:
            self._simulation.drive(self._robot, self._here)
            raise BehaviourError(f"{self._robot.name} is blocked{self._by(since)} at {self._hand.time:.2f} s")

    @property
    def _here(self) -> FloatArray:
        return self._mobile.pose_at(self._simulation.state[self._mobile.joints])

    def _by(self, since: int) -> str:
        touched = self._simulation.forces.touched_since(since, self._robot.name)
        others = [one for one in touched if one != self._hand.held]
        return f" by {', '.join(others)}" if others else ""
