"""Routes of a mobile base: turns on the spot and straight lines, forwards or backwards, around obstacles."""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappop, heappush
from itertools import count, pairwise
from math import atan2, ceil, cos, hypot, pi, sin
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robbdd_tools.catalog.api import FloatArray

CELL = 0.10
"""Distance (m) between neighbouring places of a search."""
HEADINGS = 8
"""Number of headings at each place of a search."""
STEP, TURN_STEP = 0.05, 0.2
"""Distance (m) and angle (rad) between the poses of a route that are checked for collisions."""
TURN_COST, BACK_COST = 0.3, 1.5
"""A turn costs this much (m) per rad; driving backwards costs this many times as much as driving forwards."""
MOST = 8000
"""A search gives up after it has examined the neighbours of this many poses."""
SAME = 1e-9
Node = tuple[int, int, int]
"""The numbers of the column, the row and the heading of a pose in a search."""

Route = list["FloatArray"]
"""Poses (x m, y m, yaw rad). From each pose to the next, the base turns on the spot or drives straight."""


def angle(value: float) -> float:
    """Return an angle (rad) in (-π, π]."""
    return atan2(sin(value), cos(value))


def cost(route: Route) -> float:
    """Return the length of a route in m, plus the costs of turns and of driving backwards."""
    total = 0.0
    for one, other in pairwise(route):
        length = hypot(other[0] - one[0], other[1] - one[1])
        is_back = length > 0.0 and cos(atan2(other[1] - one[1], other[0] - one[0]) - one[2]) < 0.0
        total += length * (BACK_COST if is_back else 1.0) + TURN_COST * abs(angle(other[2] - one[2]))
    return total


class RouteSearch:
    """Finds routes. ``is_free`` returns whether a pose (3,) is free of collisions; ``low`` and ``high`` are bounds."""

    def __init__(
        self, is_free: Callable[[FloatArray], bool], low: tuple[float, float], high: tuple[float, float]
    ) -> None:
        self._is_free = is_free
        self._low, self._high = low, high

    def direct(self, start: FloatArray, goal: FloatArray) -> Route | None:
        """Return the route with one straight line, forwards or backwards; ``None`` if it is not free."""
        length = hypot(goal[0] - start[0], goal[1] - start[1])
        if length < SAME:
            return self._checked([start, goal])
        heading = atan2(goal[1] - start[1], goal[0] - start[0])
        found = (self._checked(_straight(start, goal, turn)) for turn in (heading, heading + pi))
        return min((route for route in found if route is not None), key=cost, default=None)

    def around(self, start: FloatArray, goal: FloatArray) -> Route | None:
        """Return a short route around obstacles; ``None`` if the search finds none."""
        direct = self.direct(start, goal)
        if direct is not None:
            return direct
        found = self._search(start, goal)
        return None if found is None else self._shortened(found)

    def _checked(self, route: Route) -> Route | None:
        """Return a route if all poses on it are free, except the first: it is where the base is now."""
        return route if all(self._is_free(pose) for pose in _poses_on(route)) else None

    def _search(self, start: FloatArray, goal: FloatArray) -> Route | None:
        """Return a route over a lattice of places and headings around the start (A*)."""
        begin: Node = (0, 0, round(angle(float(start[2])) / (2 * pi / HEADINGS)) % HEADINGS)
        if self._checked([start, self._pose(start, begin)]) is None:
            return None
        number = count()
        costs: dict[Node, float] = {begin: 0.0}
        parents: dict[Node, Node] = {}
        waiting: list[tuple[float, int, Node]] = [(0.0, next(number), begin)]
        done: set[Node] = set()
        while waiting and len(done) < MOST:
            node = heappop(waiting)[2]
            if node in done:
                continue
            done.add(node)
            pose = self._pose(start, node)
            if hypot(goal[0] - pose[0], goal[1] - pose[1]) < 1.5 * CELL:
                last = self.direct(pose, goal)
                if last is not None:
                    nodes = [node]
                    while nodes[-1] in parents:
                        nodes.append(parents[nodes[-1]])
                    return [start, *(self._pose(start, one) for one in reversed(nodes)), *last[1:]]
            for after, way in self._neighbours(node):
                total = costs[node] + way
                if total >= costs.get(after, np.inf):
                    continue
                there = self._pose(start, after)
                if self._is_inside(there) and self._checked([pose, there]) is not None:
                    costs[after], parents[after] = total, node
                    left = hypot(goal[0] - there[0], goal[1] - there[1])
                    heappush(waiting, (total + left, next(number), after))
        return None

    def _neighbours(self, node: Node) -> Iterator[tuple[Node, float]]:
        x, y, heading = node
        for turn in (-1, 1):
            yield (x, y, (heading + turn) % HEADINGS), TURN_COST * 2 * pi / HEADINGS
        dx, dy = round(cos(2 * pi * heading / HEADINGS)), round(sin(2 * pi * heading / HEADINGS))
        for sense, factor in ((1, 1.0), (-1, BACK_COST)):
            yield (x + sense * dx, y + sense * dy, heading), factor * CELL * hypot(dx, dy)

    def _pose(self, start: FloatArray, node: Node) -> FloatArray:
        return np.array([start[0] + CELL * node[0], start[1] + CELL * node[1], 2 * pi * node[2] / HEADINGS])

    def _is_inside(self, pose: FloatArray) -> bool:
        return self._low[0] <= pose[0] <= self._high[0] and self._low[1] <= pose[1] <= self._high[1]

    def _shortened(self, route: Route) -> Route:
        """Return a route with straight lines in place of detours."""
        found, index = [route[0]], 0
        while index < len(route) - 1:
            for later in range(len(route) - 1, index, -1):
                between = self.direct(route[index], route[later])
                if between is not None and (later == index + 1 or cost(between) <= cost(route[index : later + 1])):
                    found += between[1:]
                    index = later
                    break
            else:
                found.append(route[index + 1])
                index += 1
        return found


def _straight(start: FloatArray, goal: FloatArray, heading: float) -> Route:
    there = np.array([start[0], start[1], heading])
    return [start, there, np.array([goal[0], goal[1], heading]), goal]


def _poses_on(route: Route) -> Iterator[FloatArray]:
    """Yield the poses after the first one at which a route is checked."""
    for one, other in pairwise(route):
        turn = angle(float(other[2] - one[2]))
        length = hypot(other[0] - one[0], other[1] - one[1])
        steps = max(1, ceil(length / STEP), ceil(abs(turn) / TURN_STEP))
        for step in range(1, steps + 1):
            share = step / steps
            yield np.array([*(one[:2] + share * (other[:2] - one[:2])), one[2] + share * turn])
