"""Poses of bases, tables and bins, and the part of a table in front of a robot, in numbers."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind
from robbdd_tools.catalog.objects.bin import BIN as BIN_MODEL
from robbdd_tools.catalog.objects.cube import CUBE as CUBE_MODEL
from robbdd_tools.catalog.objects.table import TABLE
from robbdd_tools.protocol.specs import ConfigSpec, SceneSpec
from robbdd_tools.world.cast import Cast
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.free_places import bearing
from robbdd_tools.world.placement import Pose, arrange, field_before, footprint, mounts, surface
from robbdd_tools.world.scene import cast_scene
from world.worlds import BALL, BENCH_WS, BIN, BIN_WS, CUBE, OTHER_BIN, PANDA, SCENE

FRONT = Pose((0.0, 0.0, 0.15))
TOP = Region((0.0, 0.0, 0.1), (0.35, 0.75, 0.1))
DESK = replace(TABLE, region=TOP)
"""A table with a top of 0.7 m by 1.5 m about its origin."""
Field = tuple[tuple[float, float], tuple[float, float]]


def field(base: Pose, table: tuple[float, float] = (0.5, 0.0), **changed: object) -> Field | None:
    """Return centre and half edges in mm of the part of a table before a base."""
    found = field_before(base, Pose((*table, 0.0)), replace(DESK, **changed), (0.25, 0.60, -0.30, 0.40))
    if found is None:
        return None
    (x, y), (dx, dy) = ([round(1000 * value) for value in pair] for pair in found)
    return (x, y), (dx, dy)


@pytest.mark.parametrize(
    ("base", "expected"),
    [
        (FRONT, ((425, 50), (175, 350))),
        (Pose((0.0, 0.5, 0.15)), ((425, 475), (175, 275))),
        (Pose((1.0, 0.0, 0.15), pi), ((575, -50), (175, 350))),
        (Pose((0.5, -0.9, 0.15), pi / 2), ((475, -475), (325, 175))),
        (Pose((0.5, 0.9, 0.15), -pi / 2), ((525, 475), (325, 175))),
        (Pose((0.3, -0.95, 0.15), pi / 2), ((375, -525), (225, 175))),
        (Pose((-0.3, 0.0, 0.15)), ((225, 50), (75, 350))),
        (Pose((-0.6, 0.0, 0.15)), None),
        (Pose((0.5, -1.4, 0.15), pi / 2), None),
        (Pose((2.0, -0.9, 0.15), pi / 2), None),
    ],
)
def test_the_part_of_a_table_before_a_base(base: Pose, expected: Field | None) -> None:
    assert field(base) == expected


def test_the_part_of_a_table_is_that_of_its_region() -> None:
    assert field(FRONT, region=replace(TOP, center=(0.1, 0.2, 0.1))) == ((425, 50), (175, 350))
    assert field(FRONT, region=replace(TOP, center=(-0.3, 0.5, 0.1))) == ((400, 75), (150, 325))
    assert field(FRONT, region=None) is None
    assert field_before(FRONT, Pose((0.5, 0.0, 0.0)), DESK) == (
        pytest.approx((0.425, 0.0)),
        pytest.approx((0.175, 0.4)),
    )


@pytest.mark.parametrize(
    ("base", "x", "y", "expected"),
    [
        (Pose((1.0, 2.0, 0.0)), 2.0, 2.0, 0.0),
        (Pose((1.0, 2.0, 0.0)), 1.0, 3.0, pi / 2),
        (Pose((1.0, 2.0, 0.0)), 1.0, 1.0, -pi / 2),
        (Pose((1.0, 2.0, 0.0), pi / 2), 1.0, 3.0, 0.0),
        (Pose((1.0, 2.0, 0.0), pi / 2), 2.0, 2.0, -pi / 2),
        (Pose((0.0, 0.0, 0.0), -3.0), -1.0, 0.1, -(2 * pi - 3.0) + pi - np.arctan(0.1)),
    ],
)
def test_a_bearing_is_seen_from_the_base(base: Pose, x: float, y: float, expected: float) -> None:
    assert bearing(base, x, y) == pytest.approx(expected)


def shape(kind: ShapeKind, size: tuple[float, float, float], at: tuple[float, float, float]) -> Shape:
    return Shape(kind, size, at)


def test_a_footprint_holds_every_shape() -> None:
    def of(*shapes: Shape) -> float:
        return footprint(replace(CUBE_MODEL, shapes=shapes))

    assert of(shape(ShapeKind.BOX, (0.3, 0.4, 9.0), (0.0, 0.0, 5.0))) == pytest.approx(0.5)
    assert of(shape(ShapeKind.BOX, (0.3, 0.4, 9.0), (0.6, 0.8, 5.0))) == pytest.approx(1.5)
    assert of(shape(ShapeKind.SPHERE, (0.3, 9.0, 0.0), (0.6, 0.8, 5.0))) == pytest.approx(1.3)
    small = shape(ShapeKind.CYLINDER, (0.1, 9.0, 0.0), (0.0, 0.0, 0.0))
    assert of(small, shape(ShapeKind.SPHERE, (0.2, 0.0, 0.0), (0.0, 0.0, 0.0)), small) == pytest.approx(0.2)


def test_a_surface_is_the_bottom_of_the_region() -> None:
    assert surface(DESK) == pytest.approx(0.0)
    assert surface(BIN_MODEL) == pytest.approx(0.005)
    assert surface(CUBE_MODEL) == 0.0


def rounded(poses: dict[str, Pose]) -> dict[str, tuple[float, float, float, float]]:
    """Return positions in mm and rotations in mrad."""
    return {name: _rounded(*pose.position, pose.yaw) for name, pose in poses.items()}


def _rounded(x: float, y: float, z: float, yaw: float) -> tuple[float, float, float, float]:
    return round(1000 * float(x)), round(1000 * float(y)), round(1000 * float(z)), round(1000 * float(yaw))


def test_four_bases_stand_at_the_sides_of_a_table_as_far_from_its_edges() -> None:
    cast = cast_scene(replace(SCENE, agents=tuple(f"t:panda{number}" for number in range(1, 5))))
    assert rounded(mounts(cast)) == {
        "t:panda1": (0, 0, 150, 0),
        "t:panda2": (1000, 0, 150, 3142),
        "t:panda3": (500, -900, 150, 1571),
        "t:panda4": (500, 900, 150, -1571),
    }


def with_table(cast: Cast, **changed: object) -> Cast:
    bench: ObjectModel = replace(cast.objects["env:bench"], **changed)
    return replace(cast, objects={**cast.objects, "env:bench": bench})


def test_bases_at_a_table_without_place_or_region_stand_around_the_mount() -> None:
    cast = cast_scene(replace(SCENE, agents=tuple(f"t:panda{number}" for number in range(1, 5))))
    nowhere = with_table(cast, places=())
    assert rounded(mounts(nowhere))["t:panda2"] == (0, 0, 150, 3142)
    assert rounded(mounts(nowhere))["t:panda3"] == (0, -400, 150, 1571)
    flat = with_table(cast, region=None)
    assert rounded(mounts(flat))["t:panda3"] == (500, -500, 150, 1571)
    assert rounded(mounts(flat))["t:panda4"] == (500, 500, 150, -1571)


def laid_out(scene: SceneSpec, seed: int = 1, base: Pose = FRONT) -> dict[str, tuple[float, float, float, float]]:
    return rounded(arrange(scene, cast_scene(scene), base, np.random.default_rng(seed)).poses)


def test_a_seed_lays_things_out_in_the_same_way_for_ever() -> None:
    assert laid_out(SCENE) == {
        "env:bench": (500, 0, -275, 0),
        BIN: (450, 600, 175, 0),
        OTHER_BIN: (450, -600, 175, 0),
        BALL: (429, 360, 130, -2236),
        CUBE: (582, -151, 116, -482),
    }


def test_a_thing_in_a_bin_lies_in_its_middle_along_its_edges() -> None:
    for seed in range(20):
        x, y, z, yaw = laid_out(replace(SCENE, places={CUBE: BIN_WS}), seed)[CUBE]
        assert abs(x - 450) <= 30
        assert abs(y - 600) <= 30
        assert abs(yaw) <= 200
        assert z == 121


def test_what_does_not_fit_into_the_middle_of_a_bin_lies_anywhere_in_it() -> None:
    things = (CUBE, *(f"t:cube{number}" for number in range(1, 8)))
    scene = replace(SCENE, objects=(*SCENE.objects, *things[1:]), places=dict.fromkeys(things, BIN_WS))
    poses = laid_out(scene)
    inside = [poses[name] for name in things]
    assert max(abs(x - 450) for x, *_ in inside) > 30
    assert max(abs(yaw) for *_, yaw in inside) > 200
    radius = 1000 * footprint(cast_scene(scene).objects[CUBE])
    assert all(abs(x - 450) <= 145 - radius + 1 for x, *_ in inside)
    assert all(abs(y - 600) <= 95 - radius + 1 for _, y, *_ in inside)


def test_a_range_of_positions_is_that_of_its_thing() -> None:
    ranged = ConfigSpec(CUBE, "position_range", "0.5 0.52 0.1 0.12")
    scene = replace(SCENE, config=(ranged,))
    x, y, *_ = laid_out(scene)[CUBE]
    assert 500 <= x <= 520
    assert 100 <= y <= 120


def test_a_table_without_workspace_or_out_of_reach_is_explained() -> None:
    cast = cast_scene(SCENE)
    with pytest.raises(SceneError, match=r"^'env:ball1' .* 'env:bench', which has no workspace$"):
        arrange(SCENE, with_table(cast, region=None), FRONT, np.random.default_rng(1))
    far = Pose((-3.0, 0.0, 0.15))
    with pytest.raises(SceneError, match=r"^no part of 'env:bench', where 'env:ball1' "):
        arrange(SCENE, cast, far, np.random.default_rng(1))


def test_a_thing_at_a_workspace_of_the_table_lies_on_it() -> None:
    assert laid_out(replace(SCENE, places={CUBE: BENCH_WS}))[CUBE][2] == 116
    assert laid_out(replace(SCENE, agents=(PANDA,)), base=Pose((1.0, 0.0, 0.15), pi))[CUBE][0] > 400
