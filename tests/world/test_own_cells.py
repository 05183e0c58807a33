"""Tables and containers of users: turned, with walls, far from the robot, without a site for their workspace."""

from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, pi, radians, sin
from pathlib import Path

import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.api import Region, Shape, ShapeKind
from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.catalog.objects.bin import BIN as CATALOG_BIN
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.extent import SPACE, own_space, with_walls
from robbdd_tools.world.placement import HAND_GAP
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.working_area import area_of, area_within, field_before, is_on
from world.scene_instances import catalog, file, instance, link
from world.worlds import BIN, BIN_WS, CUBE, PANDA, pick_place, scenario

TABLE, TABLE_WS, ON = "env:table", "env:table_ws", ("x:g.table", "table")
BUILT_IN = Implementation("x:own", "catalog", "pick-place")


def tray(rim: float, sides: str = "news") -> tuple[Shape, ...]:
    """Return a floor of 0.3 m × 0.2 m with walls that rise by ``rim`` (m), 5 mm thick."""
    half = (rim + 0.01) / 2
    every = {
        "n": Shape(ShapeKind.BOX, (0.15, 0.0025, half), (0.0, 0.0975, half)),
        "s": Shape(ShapeKind.BOX, (0.15, 0.0025, half), (0.0, -0.0975, half)),
        "e": Shape(ShapeKind.BOX, (0.0025, 0.1, half), (0.1475, 0.0, half)),
        "w": Shape(ShapeKind.BOX, (0.0025, 0.1, half), (-0.1475, 0.0, half)),
    }
    return (Shape(ShapeKind.BOX, (0.15, 0.1, 0.005), (0.0, 0.0, 0.005)), *(every[side] for side in sides))


@pytest.mark.parametrize(("rim", "height"), [(0.02, SPACE), (0.3, 0.3)])
def test_the_workspace_of_a_container_is_its_inside(rim: float, height: float) -> None:
    found = own_space(tray(rim))
    assert found.walled
    assert found.half == pytest.approx((0.145, 0.095, height / 2))
    assert found.center == pytest.approx((0.0, 0.0, 0.01 + height / 2))


@pytest.mark.parametrize(
    "shapes",
    [tray(0.3, "new"), tray(0.3, "nsw"), tray(0.008), tray(0.3)[:1], tray(0.3)[1:]],
    ids=["no south wall", "no east wall", "a low rim", "a board", "no floor"],
)
def test_without_walls_or_floor_the_workspace_is_above(shapes: tuple[Shape, ...]) -> None:
    top = max(shape.position[2] + shape.size[2] for shape in shapes)
    found = own_space(shapes)
    assert not found.walled
    assert found.center[2] - found.half[2] == pytest.approx(top)


def test_a_wide_table_with_a_rim_is_worked_on_like_a_table_inside_of_its_rim() -> None:
    wide = tuple(
        replace(one, size=(4 * one.size[0], 6 * one.size[1], one.size[2]), position=(4 * x, 6 * y, z))
        for one in tray(0.02)
        for x, y, z in [one.position]
    )
    found = own_space(wide)
    assert not found.walled
    assert found.center[2] - found.half[2] == pytest.approx(0.01)
    assert found.half[:2] == pytest.approx((0.58, 0.57))
    assert with_walls(found, wide) == found


def test_a_closed_box_has_its_workspace_on_its_lid() -> None:
    lid = Shape(ShapeKind.BOX, (0.15, 0.1, 0.005), (0.0, 0.0, 0.32))
    assert own_space((*tray(0.3), lid)).center[2] == pytest.approx(0.325 + SPACE / 2)


def test_a_tube_is_too_narrow_to_put_things_into() -> None:
    walls = [Shape(ShapeKind.BOX, (0.03, 0.0025, 0.1), (0.0, side * 0.01, 0.1)) for side in (1, -1)]
    ends = [Shape(ShapeKind.BOX, (0.0025, 0.01, 0.1), (side * 0.03, 0.0, 0.1)) for side in (1, -1)]
    floor = Shape(ShapeKind.BOX, (0.03, 0.01, 0.002), (0.0, 0.0, 0.002))
    assert not own_space((floor, *walls, *ends)).walled


def test_the_rule_gives_the_bin_of_the_catalog_its_workspace() -> None:
    found, stated = own_space(CATALOG_BIN.shapes), CATALOG_BIN.region
    assert stated is not None
    assert found.half[:2] == pytest.approx(stated.half[:2])
    assert found.center[2] - found.half[2] == pytest.approx(stated.center[2] - stated.half[2])


REGION = Region((0.1, 0.0, 0.1), (0.6, 0.2, 0.1))


@pytest.mark.parametrize(
    ("yaw", "middle", "half"),
    [(0.0, (1.1, 0.0), (0.6, 0.2)), (pi / 2, (1.0, 0.1), (0.2, 0.6)), (-pi, (0.9, 0.0), (0.6, 0.2))],
)
def test_the_area_of_a_table_turns_with_it(yaw: float, middle: tuple[float, float], half: tuple[float, float]) -> None:
    found = area_of(Pose((1.0, 0.0, 0.0), yaw), REGION)
    assert found[0] == pytest.approx(middle)
    assert found[1] == pytest.approx(half)


@pytest.mark.parametrize("yaw", [0.0, 0.7, pi / 2, 2.8])
def test_a_point_is_on_a_table_if_it_is_between_its_edges(yaw: float) -> None:
    table = Pose((1.0, 0.0, 0.0), yaw)
    c, s = cos(yaw), sin(yaw)
    for along, across, expected in ((0.69, 0.19, True), (0.71, 0.0, False), (-0.49, -0.19, True), (0.0, 0.21, False)):
        assert is_on(table, REGION, 1.0 + c * along - s * across, s * along + c * across) is expected


def test_an_area_that_no_arm_reaches_is_none() -> None:
    base = Pose((0.0, 0.0, 0.0))
    assert area_within(base, Pose((2.4, 0.0, 0.0)), REGION) is not None
    assert area_within(base, Pose((2.6, 0.0, 0.0)), REGION) is None


def test_the_usual_area_before_a_robot_is_that_part_of_a_turned_table() -> None:
    model = replace(CATALOG_BIN, region=REGION)
    found = field_before(Pose((0.0, 0.0, 0.0)), Pose((0.4, 0.0, 0.0), pi / 2), model)
    assert found is not None
    # The table is 0.2 m to 0.6 m ahead, and the area begins at 0.25 m and is 0.8 m wide.
    assert found[0] == pytest.approx((0.425, 0.0))
    assert found[1] == pytest.approx((0.175, 0.4))


def cell(folder: Path, text: str, place: tuple[float, float, float], degrees: float, seed: int) -> Execution:
    """Return an execution in which a Panda moves a cube from and to a table of a file, turned about the vertical."""
    half = radians(degrees) / 2
    turn = link("x:g.table.top", place, turn=(cos(half), 0.0, 0.0, sin(half)))
    model = file(folder, TABLE, f'<mujoco><worldbody><body name="table">{text}</body></worldbody></mujoco>', ON)
    scene = SceneSpec((CUBE, TABLE), (PANDA,), {TABLE_WS: (TABLE,)}, {}, places={CUBE: TABLE_WS})
    execution = ExecutionSpec("x:run", "x:run", BUILT_IN, instance(turn, elements=(model,)))
    return Execution(replace(scenario(scene, seed), execution=execution), [pick_place(CUBE, TABLE_WS)])


@pytest.mark.parametrize("degrees", [0.0, 90.0])
def test_things_are_laid_out_beside_a_bin_that_is_turned(degrees: float) -> None:
    """The walls of the bin are 0.3 m and 0.2 m long."""
    half = radians(degrees) / 2
    turned = link("x:g.bin.bottom", (0.42, 0.0, 0.1), turn=(cos(half), 0.0, 0.0, sin(half)))
    cell = instance(turned, elements=(catalog(BIN, "bin", "x:g.bin"),))
    scene = SceneSpec((CUBE, BIN, "env:bench"), (PANDA,), {BIN_WS: (BIN,)}, {})
    long, wide = (0.15, 0.1) if degrees == 0.0 else (0.1, 0.15)
    for seed in range(40):
        x, y, _ = build_world(scene, seed, None, cell).poses[CUBE].position
        away = hypot(max(abs(x - 0.42) - long, 0.0), max(abs(y) - wide, 0.0))
        assert away > HAND_GAP


PLANK = '<geom type="box" size="0.7 0.12 0.02" pos="0 0 -0.02"/>'


@pytest.mark.physics
@pytest.mark.parametrize("degrees", [0.0, 35.0, 90.0, 140.0])
def test_things_stand_and_are_put_on_a_turned_table(tmp_path: Path, degrees: float) -> None:
    table, top = Pose((0.45, 0.0, 0.1), radians(degrees)), Region((0.0, 0.0, 0.0), (0.7, 0.12, 1.0))
    runs = [cell(tmp_path, PLANK, (0.45, 0.0, 0.1), degrees, seed) for seed in range(1, 9)]
    for run in runs:
        (x, y, z), _ = run.simulation.pose(CUBE)
        assert is_on(table, top, float(x), float(y))
        assert z == pytest.approx(0.1 + 0.0158, abs=2e-3)
    assert runs[0].run_behaviour(0), runs[0].trace.remark
    (x, y, z), _ = runs[0].simulation.pose(CUBE)
    assert is_on(table, top, float(x), float(y))
    assert z > 0.1


@pytest.mark.physics
def test_a_table_beyond_the_usual_area_is_used(tmp_path: Path) -> None:
    """The usual area ends 0.6 m ahead of a robot."""
    small = '<geom type="box" size="0.06 0.1 0.02" pos="0 0 -0.02"/>'
    run = cell(tmp_path, small, (0.68, 0.1, 0.1), 0.0, 1)
    assert run.run_behaviour(0), run.trace.remark


@pytest.mark.physics
@pytest.mark.parametrize("degrees", [0.0, 25.0])
def test_things_lie_inside_of_a_pallet_without_a_site(tmp_path: Path, degrees: float) -> None:
    walls = "".join(
        f'<geom type="box" size="{size}" pos="{at}"/>'
        for size, at in (
            (".15 .15 .006", "0 0 .006"),
            (".15 .005 .012", "0 .145 .024"),
            (".15 .005 .012", "0 -.145 .024"),
            (".005 .14 .012", ".145 0 .024"),
            (".005 .14 .012", "-.145 0 .024"),
        )
    )
    bench = '<geom type="box" size="0.5 0.6 0.02" pos="0 0 -0.02"/>'
    runs = [cell(tmp_path, bench + walls, (0.5, 0.1, 0.1), degrees, seed) for seed in range(1, 6)]
    for run in runs:
        place, _ = run.simulation.pose(CUBE)
        assert place[2] == pytest.approx(0.112 + 0.0158, abs=2e-3), "it lies on the floor of the pallet"
    assert runs[0].run_behaviour(0), runs[0].trace.remark
