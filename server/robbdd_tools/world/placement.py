"""Initial places: tables and bins are at the catalog's places, graspable objects at random ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from math import hypot, pi
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.api import ObjectModel, Region, RobotModel, ShapeKind, Vector
from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.catalog.objects.table import HEIGHT
from robbdd_tools.catalog.settings import NORMAL
from robbdd_tools.catalog.standard_places import SIDES, NoRoom, at_places
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.dropping import Ball, drop
from robbdd_tools.world.errors import NoRoomLeft, SceneError
from robbdd_tools.world.extent import half_sides
from robbdd_tools.world.fixed_obstacles import fixed_obstacles
from robbdd_tools.world.free_places import TOUCHING, TRIES, Field, Size, Taken, Wall, draw_place, place_above
from robbdd_tools.world.passive_joints import initial_pose, ways_of_parts
from robbdd_tools.world.pose import Pose as Pose
from robbdd_tools.world.region_frames import pose_along_edges
from robbdd_tools.world.scene import carriers
from robbdd_tools.world.table_rise import TABLE_TOP as TABLE_TOP
from robbdd_tools.world.working_area import area_within, place_before
from robbdd_tools.world.working_area import field_before as field_before

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import SceneSpec
    from robbdd_tools.world.cast import Cast

FLOOR = TABLE_TOP - HEIGHT
"""Height of the floor, m, world frame."""
FINGER_GAP = 0.04
"""Room (m) for a finger around an object on a table."""
HAND_GAP = 0.08
"""Room (m) for a hand next to a bin's wall."""
BIN_SKEW = 0.2
"""Largest rotation (rad) of objects in a bin relative to the bin's edges: a hand fits only along its length."""
BIN_ROOM = 0.03
"""A hand can work in a square in a bin's middle; this is half its edge (m)."""
SQUARE = 1e-3
"""Edges count as parallel to the world's axes up to this share of a quarter turn."""


@dataclass(frozen=True, slots=True)
class Arrangement:
    """The pose of every object's centre, and the number of places that were resampled because of overlaps."""

    poses: dict[str, Pose]
    resampled: int


def footprint(model: ObjectModel) -> float:
    """Return the radius (m) of the upright cylinder about the origin that encloses the object."""
    return max(_reach(model, index) for index in range(len(model.shapes)))


def surface(model: ObjectModel) -> float:
    """Return how high (m) above an object's origin its surface for other objects is, 0 if it has none."""
    return 0.0 if model.region is None else model.region.center[2] - model.region.half[2]


def mounts(cast: Cast) -> dict[str, Pose]:
    """Return the pose of each agent's base; raises ``SceneError`` if there is no room for one.

    Agents without a place in an executable scene are at the table: the first at its model's mount, the others at the
    opposite side and at the ends.
    """
    placed = {name: pose for name in cast.agents if (pose := cast.base(name)) is not None}
    table = next(iter(cast.tables))
    free = list(range(SIDES))
    poses: dict[str, Pose] = {}
    for name, robot in cast.agents.items():
        if name not in placed and not free:
            others = [other for other in cast.agents if other not in poses]
            room = f"there is room for {SIDES} agents around '{table}', one at each side"
            raise SceneError(f"{room}; place {', '.join(others)} in a .scenex")
        poses[name] = placed[name] if name in placed else _beside(cast.objects[table], robot, free.pop(0))
    return poses


def _beside(table: ObjectModel, robot: RobotModel, side: int) -> Pose:
    """Return a base at a side of a table: 0 the front, 1 opposite, 2 and 3 the ends. All have the front's distance.

    The base of an arm with a vertical stroke is so low that the tool reaches the table.
    """
    x, y, z = robot.mount
    z = min(z, TABLE_TOP - arm_of(robot).stroke[0])
    # A user's own table has no standard place: its pose counts, and only the front is known.
    middle = table.places[0][0] if table.places else x
    half = (0.0, 0.0) if table.region is None else table.region.half[:2]
    end = half[1] + (middle - half[0] - x)
    return (
        Pose((x, y, z)),
        Pose((2 * middle - x, -y, z), pi),
        Pose((middle, -end, z), pi / 2),
        Pose((middle, end, z), -pi / 2),
    )[side]


def arrange(
    scene: SceneSpec, cast: Cast, base: Pose, rng: np.random.Generator, *, is_mobile: bool = False
) -> Arrangement:
    """Lay out the objects of a scene for an agent that works at ``base`` or drives from there.

    Raises ``SceneError`` for a place that does not exist or if there is not enough room.
    """
    poses: dict[str, Pose] = {}
    # A configuration may also place graspable objects; it takes precedence.
    fixed = {name: cast.pose(name) for name in cast.objects if name not in cast.ranges}
    placed = {name: pose for name, pose in fixed.items() if pose is not None}
    poses |= {name: pose for name, pose in placed.items() if not cast.objects[name].graspable}
    for name, (x, y, _) in _at_places(cast, tuple(name for name in cast.tables if name not in placed), "the room"):
        poses[name] = Pose((x, y, TABLE_TOP - surface(cast.objects[name])))
    bystanders = tuple(name for name, model in cast.objects.items() if model.bystander and name not in placed)
    for name, (x, y, _) in _at_places(cast, bystanders, "the room"):
        poses[name] = Pose((x, y, FLOOR + cast.objects[name].rest_height))
    for table, names in _stands_on(scene, cast).items():
        left, ahead, z = poses[table].position
        top = z + surface(cast.objects[table])
        for name, (x, y, _) in _at_places(cast, tuple(name for name in names if name not in placed), table):
            poses[name] = Pose((left + x, ahead + y, top + cast.objects[name].rest_height))
    bins = [name for name in poses if cast.objects[name].free]
    for name, model in cast.objects.items():
        if model.joint is not None and model.joint.parent:
            poses[name] = initial_pose(model, cast.objects[model.joint.parent], poses[model.joint.parent])
        elif model.joint is not None and name not in poses:
            raise SceneError(f"'{name}' hangs on a joint: give it a pose in the .scenex", origin=cast.origin(name))
    ways = [Wall(*way) for way in ways_of_parts(cast.objects, poses)]

    def works_at(place: Pose, model: ObjectModel) -> Pose:
        return place_before(base, place, model) if is_mobile and model.region is not None else base

    taken: list[Taken] = []
    dropped: list[Ball] = []
    resampled = 0
    for name in sorted(cast.objects, key=lambda one: not _is_exact(cast, one)):
        model = cast.objects[name]
        if not model.graspable:
            continue
        walls = [Wall(other, poses[other], cast.objects[other]) for other in bins] + ways
        if name in placed:
            pose, rejected = _apart_from(cast, name, placed[name], taken)
        elif name in cast.drops:
            place = partial(
                place_above, next(_fields(scene, cast, poses, works_at, name)), walls, footprint(model), rng
            )
            pose, ball, rejected = drop(name, model, cast.drops[name], place, dropped, rng)
            dropped.append(ball)
        else:
            size = Size(footprint(model), model.rest_height)
            fields = _fields(scene, cast, poses, works_at, name)
            pose, rejected = draw_place(name, _place_of(scene, cast, name), size, fields, taken, walls, rng)
        taken.append(Taken(name, pose.position[0], pose.position[1], footprint(model)))
        poses[name] = pose
        resampled += rejected
    return Arrangement(poses, resampled)


def _place_of(scene: SceneSpec, cast: Cast, name: str) -> str:
    """Return the workspace where the scene has an object, or the table on which it is without one."""
    return scene.places.get(name, cast.tables[0])


def _is_exact(cast: Cast, name: str) -> bool:
    """Return whether a configuration leaves only one place for an object: it is laid out before the others."""
    area = cast.ranges.get(name, NORMAL)
    return area[0] == area[1] and area[2] == area[3]


def _apart_from(cast: Cast, name: str, first: Pose, taken: list[Taken]) -> tuple[Pose, int]:
    """Return an object's pose from the scene, resampled until nothing overlaps it, and the number of resamples."""
    radius, pose = footprint(cast.objects[name]), first
    for attempt in range(1, TRIES):
        if not any(one.is_near(*pose.position[:2], radius + TOUCHING) for one in taken):
            return pose, attempt - 1
        again = cast.pose(name, attempt)
        if again is None or again == pose:
            return pose, attempt - 1
        pose = again
    raise NoRoomLeft(name, f"among {len(taken)} other objects")


def _at_places(cast: Cast, names: tuple[str, ...], where: str) -> Iterator[tuple[str, Vector]]:
    """Yield each object with its standard place; raises ``SceneError`` for an object without one."""
    try:
        yield from at_places(cast.objects, names, where)
    except NoRoom as error:
        raise SceneError(str(error)) from error


def _stands_on(scene: SceneSpec, cast: Cast) -> dict[str, tuple[str, ...]]:
    """Map each table to the objects at fixed places on it; objects without a table are on the first one."""
    chosen: dict[str, list[str]] = {table: [] for table in cast.tables}
    homes: dict[str, str] = {}
    for outer, inner in scene.contains.items():
        for table in set(scene.workspaces.get(outer, ())) & set(cast.tables):
            homes |= {name: table for part in inner for name in carriers(scene, part)}
    for name, model in cast.objects.items():
        if model.free and not model.graspable:
            chosen[homes.get(name, cast.tables[0])].append(name)
    return {table: tuple(names) for table, names in chosen.items()}


def _fields(
    scene: SceneSpec,
    cast: Cast,
    poses: Mapping[str, Pose],
    works_at: Callable[[Pose, ObjectModel], Pose],
    name: str,
) -> Iterator[Field]:
    """Yield the areas for an object, best first; raises ``SceneError`` if there are none.

    ``works_at`` returns where the robot's base is when it works at an object.
    """
    carrier = cast.tables[0]
    region = cast.objects[carrier].region
    if (workspace := scene.places.get(name)) is not None:
        if workspace not in cast.regions:
            raise SceneError(f"'{name}' should be at '{workspace}', but nothing in the scene carries that workspace")
        carrier, region = cast.regions[workspace][0]
    model, pose = cast.objects[carrier], poses[carrier]
    radius = footprint(cast.objects[name])
    if region is None:
        raise SceneError(f"'{name}' should be at '{carrier}', which has no workspace")
    x, y, z = pose.at(region.center).position
    yaw = pose_along_edges(pose, region).yaw
    half, base = _flat(region.half, yaw), works_at(pose, model)
    bottom = z - region.half[2]
    if radius > min(region.half[:2]) and name not in cast.ranges:
        for turn, room in _along_edges(cast.objects[name], region):
            on = (pose, region)
            yield Field((x, y), room, bottom, 0.0, TOUCHING, None, base, on=on, yaw=yaw + turn, apart=True)
    if can_move(model) or region.walled:
        inner = (half[0] - radius, half[1] - radius)
        if region.walled:
            edge = yaw - pi / 2 * round(yaw / (pi / 2))
            yield Field((x, y), (BIN_ROOM, BIN_ROOM), bottom, BIN_SKEW, FINGER_GAP, None, base, yaw=edge)
        else:
            yield Field((x, y), inner, bottom, pi, FINGER_GAP, None, base)
        yield Field((x, y), inner, bottom, pi, TOUCHING, None, base)
        return
    area = field_before(base, pose, model, cast.ranges.get(name, NORMAL))
    if area is None and name not in cast.ranges:
        area = area_within(base, pose, region)
    if area is None:
        raise SceneError(f"no part of '{carrier}', where '{name}' should be, is within reach")
    obstacles = fixed_obstacles(cast.objects, poses, carrier)
    on = (pose, region)
    yield Field(area[0], area[1], bottom, pi, FINGER_GAP, HAND_GAP, base, obstacles, on)
    yield Field(area[0], area[1], bottom, pi, TOUCHING, TOUCHING, base, obstacles, on)
    if obstacles and name not in scene.unused:
        # Their boxes may be larger than they are. Whether anything overlaps is checked later.
        yield Field(area[0], area[1], bottom, pi, TOUCHING, TOUCHING, base, (), on)


def _along_edges(model: ObjectModel, region: Region) -> Iterator[tuple[float, tuple[float, float]]]:
    """Yield the rotations (rad) at which an object that cannot be turned as it likes fits, and its room (m) there.

    Its sides are along the edges of the region; the room is how far it may be from the middle along its own axes.
    """
    (long, wide), (first, second, _) = half_sides(model, np.eye(3)), region.half
    if long <= first and wide <= second:
        yield 0.0, (first - long, second - wide)
    if long <= second and wide <= first:
        yield pi / 2, (second - long, first - wide)


def _flat(half: Vector, yaw: float) -> Vector:
    """Return the half edges (m), along the world's axes, of a rectangle inside a box turned by ``yaw`` (rad)."""
    quarters = yaw / (pi / 2)
    if abs(quarters - round(quarters)) > SQUARE:
        least = min(half[:2]) / 2**0.5
        return (least, least, half[2])
    return (half[1], half[0], half[2]) if round(quarters) % 2 else half


def _reach(model: ObjectModel, index: int) -> float:
    shape = model.shapes[index]
    corner = hypot(shape.size[0], shape.size[1]) if shape.kind is ShapeKind.BOX else shape.size[0]
    return hypot(shape.position[0], shape.position[1]) + corner
