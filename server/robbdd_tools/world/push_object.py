"""Controller that pushes an object over its support with the closed gripper."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import atan2, ceil, pi
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.extent import outline_of
from robbdd_tools.world.motion import tool_path
from robbdd_tools.world.reaching import joints_at
from robbdd_tools.world.region_frames import along_edges

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, Region
    from robbdd_tools.world.arm_control import ArmControl
    from robbdd_tools.world.gripper import Step
    from robbdd_tools.world.motion import ToolPose

SPEED = 0.1
"""Largest speed of the tool while it pushes, m/s."""
STROKES = 8
"""The behaviour gives up after this many pushes; each push corrects the deviation of earlier ones."""
INSIDE = 0.02
"""An object has arrived when it is this far (m) inside the sides of the workspace."""
BEHIND = 0.05
"""Room (m) between the object and the tool when the tool is lowered behind it."""
LOW = 0.02
"""Smallest height (m) of the tool above the support: the tips of the fingers are below the tool."""
ASIDE = 0.03
"""A push ends when the object deviates this far (m) from the line of the push."""
SPACING = 0.01
"""Distance between the points of the tool's path, m."""


class PushObject:
    """Pushes objects with one arm. ``emit`` is called with the name of each event when it occurs."""

    def __init__(self, hand: ArmControl, emit: Callable[[str], None]) -> None:
        self._hand = hand
        self._emit = emit
        self._simulation = hand.simulation

    def push(self, name: str, workspaces: Sequence[str]) -> Step:
        """Push an object into a workspace, and push again if it turns away; raises ``BehaviourError``."""
        if name not in self._simulation.world.cast.objects:
            raise BehaviourError(f"there is no {name} in the scene")
        self._emit("push-start")
        yield from self._hand.gripper.close(self._hand)
        for _ in range(STROKES):
            way = self._way_to(name, workspaces)
            if not way.any():
                break
            yield from self._stroke(name, way)
        if self._way_to(name, workspaces).any():
            raise BehaviourError(f"{name} is not at {' or '.join(workspaces)} after {STROKES} pushes")
        self._emit("push-end")

    def _way_to(self, name: str, workspaces: Sequence[str]) -> FloatArray:
        """Return the shortest horizontal way (2,) m into a workspace; zeros if the object is already inside."""
        position, _ = self._simulation.seen(name)
        regions = self._simulation.world.cast.regions
        ways = [
            self._way_into(position, carrier, region)
            for workspace in workspaces
            for carrier, region in regions.get(workspace, ())
        ]
        return min(ways, key=lambda way: float(np.linalg.norm(way)))

    def _way_into(self, position: FloatArray, carrier: str, region: Region) -> FloatArray:
        place, rotation = along_edges(self._simulation.seen_place(carrier), region)
        local = (rotation.T @ (position - place) - region.center)[:2]
        room = np.maximum(np.array(region.half[:2]) - INSIDE, 0.0)
        if (np.abs(local) <= room).all():
            return np.zeros(2)
        # Aim at the middle half, so that the object does not stop at the limit.
        way: FloatArray = rotation[:2, :2] @ (np.clip(local, -room / 2, room / 2) - local)
        return way

    def _stroke(self, name: str, way: FloatArray) -> Step:
        """Push the object once along a way (2,) m."""
        hand, simulation = self._hand, self._simulation
        length = float(np.linalg.norm(way))
        ahead = np.array([*(way / length), 0.0])
        start, rotation = simulation.seen(name)
        outline = outline_of(simulation.world.cast.objects[name])
        points = [(rotation @ np.array(point), radius) for point, radius in outline]
        back = max(radius - float(ahead @ point) for point, radius in points)
        bottom = min(float(point[2]) - radius for point, radius in points)
        first = start - (back + BEHIND) * ahead + [0.0, 0.0, max(0.0, bottom + LOW)]
        count = ceil((BEHIND + length) / SPACING)
        across = atan2(ahead[1], ahead[0]) + pi / 2
        shares = np.linspace(0.0, 1.0, count + 1).tolist()
        path = tool_path(hand.robot.base, ((first + share * (BEHIND + length) * ahead, across) for share in shares))
        self._refuse_contact(name, path[0])
        yield from hand.move(hand.at_travel(hand.tool))
        yield from hand.move(hand.at_travel(path[0]))
        yield from hand.move(path[0], hand.robot.model.approach_speed)

        def is_over() -> bool:
            moved = (simulation.seen(name)[0] - start)[:2]
            along = float(ahead[:2] @ moved)
            return along >= length or float(np.linalg.norm(moved - along * ahead[:2])) > ASIDE

        yield from hand.move_through(path[1:], SPEED, is_over)
        yield from hand.move(hand.at_travel(hand.tool))

    def _refuse_contact(self, name: str, behind: ToolPose) -> None:
        """Raise ``BehaviourError`` if the arm cannot be lowered behind the object."""
        hand = self._hand
        clearance = Clearance(self._simulation, hand.robot, name, self._simulation.data)
        hit = clearance.hit(joints_at(hand.arm, hand.at_travel(behind), behind))
        if hit.depth > 0.0:
            raise BehaviourError(f"{hand.robot.name} cannot push {name}: behind it, the arm would touch {hit.owner}")
