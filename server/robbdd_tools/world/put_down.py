"""Places in a workspace where an object can be put down."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import atan2, cos, hypot, sin
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.free_places import BEARING, bearing
from robbdd_tools.world.placement import HAND_GAP, Pose, field_before, footprint
from robbdd_tools.world.region_frames import along_edges
from robbdd_tools.world.working_area import area_of, is_on

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, Region, Vector
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation

ALONG = (0.0, -0.03, 0.03)
"""A hand fits into a bin at these distances (m) along its length from its centre."""
GRID = 7
"""Number of places tried along each side of a table."""
SMALL = 0.15
"""Of a place whose sides are at most twice as long (m), all of it is tried, also what is not in front of the robot."""
INTO_BIN, ONTO_TABLE = 0.02, 0.005
"""An object is released at this height (m) above the surface."""


@dataclass(frozen=True, slots=True)
class Floor:
    """The bottom of a workspace, world frame: its middle, half its sides (m), and the direction (rad) of the first."""

    center: tuple[float, float]
    half: tuple[float, float]
    yaw: float

    def at(self, position: Vector) -> tuple[float, float]:
        """Return how far (m) a point is from the middle, along both sides."""
        x, y, c, s = position[0] - self.center[0], position[1] - self.center[1], cos(self.yaw), sin(self.yaw)
        return c * x + s * y, c * y - s * x

    def has(self, x: float, y: float) -> bool:
        """Return whether a point (m) is above the floor."""
        return all(abs(way) <= half for way, half in zip(self.at((x, y, 0.0)), self.half, strict=True))


@dataclass(frozen=True, slots=True)
class Target:
    """A place to put an object: a point on the surface (m, world frame) and the release height (m) above it.

    ``closing`` is the usual closing direction (rad) of the fingers there, ``None`` for any direction.
    """

    position: Vector
    gap: float
    closing: float | None
    floor: Floor


def targets(simulation: Simulation, robot: Robot, name: str, workspace: str) -> Iterator[Target]:
    """Yield places for an object at a workspace, most room first; raises ``BehaviourError`` if there are none."""
    regions = simulation.world.cast.regions.get(workspace)
    if not regions:
        raise BehaviourError(f"nothing in the scene carries {workspace}")
    for carrier, region in regions:
        if region.walled:
            yield from _in_bin(simulation, name, carrier, region)
        elif can_move(simulation.world.cast.objects[carrier]):
            yield from _on_board(simulation, name, carrier, region)
        else:
            yield from _on_table(simulation, robot, name, carrier, region)


def on_tables(simulation: Simulation, robot: Robot, name: str) -> Iterator[Target]:
    """Yield places for an object on the tables in front of an arm, most room first."""
    for table in simulation.world.cast.tables:
        region = simulation.world.cast.objects[table].region
        if region is not None:
            yield from _on_table(simulation, robot, name, table, region)


def has_room(simulation: Simulation, robot: Robot, name: str, workspace: str) -> bool:
    """Return whether an object has room between the loose objects at some place of a workspace.

    In a place that is too narrow to turn the object, such as a nest, what is beside the place is not in the way.
    """
    radius = footprint(simulation.world.cast.objects[name])
    for carrier, _ in simulation.world.cast.regions.get(workspace, ()):
        others = _others(simulation, name, carrier)
        for place in targets(simulation, robot, name, workspace):
            is_nest = radius > min(place.floor.half)
            near = [one for one in others if place.floor.has(*one[:2])] if is_nest else others
            if _room(*place.position[:2], near) >= radius:
                return True
    return False


def _in_bin(simulation: Simulation, name: str, carrier: str, region: Region) -> Iterator[Target]:
    position, rotation = along_edges(simulation.seen_place(carrier), region)
    bottom = np.array(region.center) - [0.0, 0.0, region.half[2]]
    others = _others(simulation, name, carrier)
    longest = int(np.argmax(region.half[:2]))
    axis = rotation[:, longest]
    points = [position + rotation @ bottom + along * axis for along in ALONG]
    for point in sorted(points, key=lambda point: -_room(point[0], point[1], others)):
        place = (float(point[0]), float(point[1]), float(point[2]))
        yield Target(place, INTO_BIN, atan2(axis[1], axis[0]), _floor(position, rotation, region))


def _on_board(simulation: Simulation, name: str, carrier: str, region: Region) -> Iterator[Target]:
    """Yield places on a board or tray, most room first, then by distance from the centre."""
    position, rotation = along_edges(simulation.seen_place(carrier), region)
    radius = footprint(simulation.world.cast.objects[name])
    others = _others(simulation, name, carrier)
    longest = int(np.argmax(region.half[:2]))
    shares = np.linspace(-1.0, 1.0, GRID)
    inner = np.maximum(np.array(region.half[:2]) - radius, 0.0)
    offsets = sorted((np.array([sx, sy]) * inner for sx in shares for sy in shares), key=lambda one: float(one @ one))
    x, y, z = region.center
    points = [position + rotation @ np.array([x + dx, y + dy, z - region.half[2]]) for dx, dy in offsets]
    closing = atan2(rotation[1, longest], rotation[0, longest])
    # Sorting is stable: places with equal room stay ordered by distance from the centre.
    for point in sorted(points, key=lambda point: _crowding(point[0], point[1], others, radius)):
        place = (float(point[0]), float(point[1]), float(point[2]))
        yield Target(place, ONTO_TABLE, closing, _floor(position, rotation, region))


def _on_table(simulation: Simulation, robot: Robot, name: str, carrier: str, region: Region) -> Iterator[Target]:
    position, rotation = simulation.seen_place(carrier)
    model = simulation.world.cast.objects[carrier]
    yaw = atan2(float(rotation[1, 0]), float(rotation[0, 0]))
    table = Pose((float(position[0]), float(position[1]), float(position[2])), yaw)
    # Whether an arm reaches a user's own place is up to the arm. A part may fit only into the middle of a small one.
    field = field_before(robot.base, table, replace(model, region=region)) if max(region.half[:2]) > SMALL else None
    radius = footprint(simulation.world.cast.objects[name])
    (cx, cy), (hx, hy) = field or area_of(table, region)
    if field is None:
        # At the border of a pan, the object would stick out and might topple off.
        hx, hy = max(hx - radius, 0.0), max(hy - radius, 0.0)
    shares = np.linspace(-1.0, 1.0, GRID)
    others = _others(simulation, name, carrier)
    grid = [(float(cx + sx * hx), float(cy + sy * hy)) for sx in shares for sy in shares]
    points = [one for one in grid if is_on(table, region, *one) and abs(bearing(robot.base, *one)) <= BEARING]
    crowding = {point: _crowding(*point, others, radius) for point in points}
    roomy = [point for point in points if not crowding[point]]
    surface = float(position[2]) + region.center[2] - region.half[2]
    floor = _floor(*along_edges((position, rotation), region), region)
    for x, y in sorted(roomy or points, key=lambda point: (crowding[point], hypot(point[0] - cx, point[1] - cy))):
        yield Target((x, y, surface), ONTO_TABLE, None, floor)


def _floor(position: FloatArray, rotation: FloatArray, region: Region) -> Floor:
    """Return the bottom of a region whose edges are along the axes of its carrier's frame."""
    x, y, _ = (position + rotation @ np.array(region.center)).tolist()
    return Floor((x, y), region.half[:2], atan2(rotation[1, 0], rotation[0, 0]))


def _others(simulation: Simulation, name: str, carrier: str) -> list[tuple[float, float, float]]:
    """Return place (m) and radius (m) of all loose objects except this one and the carrier of the workspace."""
    found: list[tuple[float, float, float]] = []
    for other, model in simulation.world.cast.objects.items():
        if model.free and other not in (name, carrier):
            position, _ = simulation.seen(other)
            found.append((float(position[0]), float(position[1]), footprint(model)))
    return found


def _crowding(x: float, y: float, others: list[tuple[float, float, float]], radius: float) -> int:
    """Return 0 if an object and a hand have room at a point, 1 if only the object has, 2 if it would touch another."""
    room = _room(x, y, others)
    return (room < radius + HAND_GAP) + (room < radius)


def _room(x: float, y: float, others: list[tuple[float, float, float]]) -> float:
    """Return the distance (m) from a point to the nearest of the others; large if there are none."""
    return min((hypot(x - ox, y - oy) - radius for ox, oy, radius in others), default=1.0)
