"""Workspaces whose boxes are turned in the frame of the object that carries them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import cos, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike

from monitor.traces import trace_of
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.api import Region
from robbdd_tools.catalog.executable import Implementation, WorkspaceBox
from robbdd_tools.catalog.objects.bin import BIN as CATALOG_BIN
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import During
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.drawn_shapes import geometry
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.extent import with_walls
from robbdd_tools.world.placement import footprint
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.put_down import targets
from robbdd_tools.world.region_frames import along_edges, bounds_of_box, box_of, matrix_of, pose_along_edges
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.standing_places import standing_places
from robbdd_tools.world.user_behaviour import AgentWorld
from robbdd_tools.world.working_area import area_of, is_on
from world.scene_instances import catalog, file, instance, link
from world.worlds import BIN, BIN_WS, CUBE, PANDA, SCENE, pick_place, scenario

TRAY, TRAY_WS = "env:tray1", "env:tray1_ws"
FIXTURE, FIXTURE_WS, ON = "env:fixture", "env:fixture_ws", ("x:g.fixture", "fixture")
BOX = Region((0.1, 0.0, 0.2), (0.3, 0.1, 0.05))


def about_z(degrees: float) -> tuple[float, ...]:
    return (cos(radians(degrees) / 2), 0.0, 0.0, sin(radians(degrees) / 2))


def about_x(degrees: float) -> tuple[float, ...]:
    return (cos(radians(degrees) / 2), sin(radians(degrees) / 2), 0.0, 0.0)


@pytest.mark.parametrize(
    ("turn", "point", "margin"),
    [
        ((), (0.39, 0.0, 0.2), 0.01),
        (about_z(90.0), (0.39, 0.0, 0.2), -0.19),
        (about_z(90.0), (0.1, 0.29, 0.2), 0.01),
        # The corner of the box around the turned box is outside of it.
        (about_z(45.0), (0.1 + 0.27, -0.27, 0.2), -(0.54 / 2**0.5 - 0.1)),
        (about_z(45.0), (0.1 + 0.2, 0.2, 0.2), 0.3 - 0.4 / 2**0.5),
        (about_x(90.0), (0.1, 0.0, 0.29), 0.01),
        (about_x(90.0), (0.1, 0.06, 0.2), -0.01),
    ],
)
@pytest.mark.parametrize("carrier", [(1.0, 0.0, 0.0, 0.0), about_z(120.0)])
def test_the_margin_is_that_of_the_turned_box(
    turn: tuple[float, ...], point: tuple[float, float, float], margin: float, carrier: tuple[float, ...]
) -> None:
    place = (np.array([0.4, 0.5, 0.1]) + matrix_of(carrier) @ np.array(point)).tolist()
    trace = trace_of({"rig": [[0.4, 0.5, 0.1]] * 2, "ball": [place] * 2}, {"start": 0.0, "end": 0.1})
    trace = replace(trace, orientations=np.array([[carrier, about_z(10.0)]] * 2))
    regions = {"rig_ws": (("rig", replace(BOX, turn=turn)),)}
    located = load_catalog().predicates["located-at"]
    found = judge(located, {"object": "ball", "workspace": "rig_ws"}, During("start", "end"), trace, regions)
    assert found.robustness == pytest.approx(margin, abs=1e-9)


@pytest.mark.parametrize("turn", [about_z(30.0), about_z(-100.0), about_x(40.0)])
def test_a_turned_frame_gives_the_corners_of_the_turned_box(turn: tuple[float, ...]) -> None:
    region, place, carrier = replace(BOX, turn=turn), np.array([1.0, 2.0, 3.0]), about_z(70.0)
    center, half = np.array(BOX.center), np.array(BOX.half)
    position, rotation = along_edges((place, matrix_of(carrier)), region)
    pose = pose_along_edges(Pose((1.0, 2.0, 3.0), radians(70.0)), region)
    for signs in product((-1.0, 1.0), repeat=3):
        corner = place + matrix_of(carrier) @ (center + matrix_of(turn) @ (np.array(signs) * half))
        found = center + np.array(signs) * half
        assert position + rotation @ found == pytest.approx(corner)
        assert pose.at((float(found[0]), float(found[1]), float(found[2]))).position == pytest.approx(corner)


def test_a_box_that_is_not_turned_keeps_the_frame_of_its_carrier() -> None:
    place, pose = (np.ones(3), np.eye(3)), Pose((1.0, 2.0, 3.0), 0.3)
    assert along_edges(place, BOX) is place
    assert pose_along_edges(pose, BOX) is pose
    assert bounds_of_box(BOX).tolist() == list(BOX.half)


def test_the_box_around_a_turned_box_has_its_corners() -> None:
    assert bounds_of_box(replace(BOX, turn=about_z(90.0))) == pytest.approx([0.1, 0.3, 0.05])


@pytest.mark.parametrize(
    ("rotation", "half", "turn"),
    [
        (np.eye(3), (0.3, 0.1, 0.05), ()),
        (matrix_of(about_z(90.0)), (0.1, 0.3, 0.05), ()),
        (matrix_of(about_x(-90.0)), (0.3, 0.05, 0.1), ()),
        (matrix_of(about_z(30.0)), (0.3, 0.1, 0.05), about_z(30.0)),
        (matrix_of(about_z(30.0)) @ matrix_of(about_x(180.0)), (0.3, 0.1, 0.05), about_z(30.0)),
    ],
    ids=["straight", "quarter", "rolled", "turned", "turned and upside down"],
)
def test_the_box_of_a_site_stands_upright(
    rotation: np.ndarray, half: tuple[float, ...], turn: tuple[float, ...]
) -> None:
    edges, found = box_of(np.array([0.3, 0.1, 0.05]), rotation)
    assert edges == pytest.approx(half)
    assert found == pytest.approx(turn)


def test_a_site_whose_third_axis_is_horizontal_has_its_floor_below() -> None:
    rotation = matrix_of(about_z(30.0)) @ matrix_of(about_x(90.0))
    half, turn = box_of(np.array([0.3, 0.1, 0.05]), rotation)
    assert half[2] == pytest.approx(0.1)
    matrix = matrix_of(turn)
    assert matrix[:, 2] == pytest.approx([0.0, 0.0, 1.0])
    # The same box, whatever the order of its edges is.
    assert np.abs(matrix) @ half == pytest.approx(np.abs(rotation) @ [0.3, 0.1, 0.05])


def test_an_area_turns_with_its_box() -> None:
    table, region = Pose((1.0, 0.0, 0.0), pi / 4), replace(BOX, turn=about_z(45.0))
    (x, y), half = area_of(table, region)
    assert (x, y) == pytest.approx((1.0 + 0.1 * cos(pi / 4), 0.1 * sin(pi / 4)))
    assert half == pytest.approx((0.1, 0.3))
    assert is_on(table, region, x + 0.09, y + 0.29)
    assert not is_on(table, region, x + 0.29, y + 0.09)


PLATE = '<geom type="box" size="0.2 0.2 0.01"/>'


def fixture(folder: Path, site: str, seed: int, carried: bool) -> Execution:
    """Return an execution in which a Panda brings a cube to or moves it within a fixture with a turned workspace."""
    body = f'<mujoco><worldbody><body name="fixture">{PLATE}{site}</body></worldbody></mujoco>'
    model = file(folder, FIXTURE, body, ON)
    scene = SceneSpec((CUBE, FIXTURE, "env:bench"), (PANDA,), {FIXTURE_WS: (FIXTURE,)}, {})
    if carried:
        scene = replace(scene, places={CUBE: FIXTURE_WS})
    cell = instance(link("x:g.fixture.top", (0.5, 0.1, 0.11)), elements=(model,))
    execution = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), cell)
    return Execution(replace(scenario(scene, seed), execution=execution), [pick_place(CUBE, FIXTURE_WS)])


SITE = '<site name="workspace" type="box" size="0.15 0.03 0.1" pos="0 0 0.11" euler="0 0 35"/>'


def test_every_place_of_a_turned_workspace_is_inside_of_it(tmp_path: Path) -> None:
    run = fixture(tmp_path, SITE, 1, False)
    simulation = run.simulation
    ((carrier, region),) = simulation.world.cast.regions[FIXTURE_WS]
    assert region.half == pytest.approx((0.15, 0.03, 0.1))
    position, rotation = along_edges(simulation.seen_place(carrier), region)
    found = list(targets(simulation, simulation.robots[PANDA], CUBE, FIXTURE_WS))
    assert found
    for target in found:
        local = rotation.T @ (np.array(target.position) - position) - region.center
        assert np.all(np.abs(local[:2]) <= np.array(region.half[:2]) + 1e-9)


@pytest.mark.physics
def test_things_are_laid_out_and_put_into_a_turned_workspace(tmp_path: Path) -> None:
    runs = [fixture(tmp_path, SITE, seed, True) for seed in range(1, 5)]
    for run in runs:
        assert _inside(run.simulation)
    assert runs[0].run_behaviour(0), runs[0].trace.remark
    assert _inside(runs[0].simulation)


def _inside(simulation: Simulation) -> bool:
    ((carrier, region),) = simulation.world.cast.regions[FIXTURE_WS]
    position, rotation = along_edges(simulation.seen_place(carrier), region)
    local = rotation.T @ (simulation.pose(CUBE)[0] - position) - region.center
    return bool(np.all(np.abs(local) <= np.array(region.half)))


def boxed(scene: SceneSpec, *boxes: WorkspaceBox, seed: int = 1) -> Simulation:
    """Return a world whose workspaces are boxes that an executable scene states."""
    return Simulation(build_world(scene, seed, None, replace(instance(), boxes=boxes)))


@pytest.mark.parametrize(
    ("offset", "size", "turn", "message"),
    [
        ((0.0, 0.0), (0.1, 0.1, 0.1), (), "needs 3 numbers for its centre and 3 edges greater than 0"),
        ((0.0, 0.0, 0.0), (0.1, 0.1), (), "needs 3 numbers for its centre and 3 edges greater than 0"),
        ((0.0, 0.0, 0.0), (0.1, 0.0, 0.1), (), "needs 3 numbers for its centre and 3 edges greater than 0"),
        ((0.0, 0.0, 0.0), (0.1, 0.1, 0.1), (0.0, 0.0, 0.0, 0.0), "needs an orientation that is a rotation"),
        ((0.0, 0.0, 0.0), (0.1, 0.1, 0.1), (1.0, 0.0, 0.0), "needs an orientation that is a rotation"),
    ],
)
def test_an_impossible_box_is_refused_instead_of_ignored(
    offset: tuple[float, ...], size: tuple[float, ...], turn: tuple[float, ...], message: str
) -> None:
    with pytest.raises(SceneError, match=message):
        boxed(SCENE, WorkspaceBox(BIN_WS, offset, size, turn))


def inside_of(simulation: Simulation, workspace: str, point: ArrayLike) -> np.ndarray:
    """Return how far (m) a point is inside each pair of a box's vertical faces."""
    ((carrier, region),) = simulation.world.cast.regions[workspace]
    position, rotation = along_edges(simulation.pose(carrier), region)
    local = rotation.T @ (np.array(point) - position) - region.center
    return (np.array(region.half) - np.abs(local))[:2]


def test_a_hand_lets_go_along_the_longest_edge_of_a_turned_box_in_a_bin() -> None:
    narrow = WorkspaceBox(BIN_WS, (0.0, 0.0, 0.06), (0.14, 0.02, 0.1), about_z(90.0))
    simulation = boxed(SCENE, narrow)
    found = list(targets(simulation, simulation.robots[PANDA], CUBE, BIN_WS))
    assert len(found) == 3
    for target in found:
        assert (inside_of(simulation, BIN_WS, target.position) > 0.0).all()
        assert abs(sin(target.closing or 0.0)) == pytest.approx(1.0)


def test_things_lie_in_a_turned_box_of_a_tray() -> None:
    scene = SceneSpec((CUBE, TRAY, "env:bench"), (PANDA,), {TRAY_WS: (TRAY,)}, {}, places={CUBE: TRAY_WS})
    narrow = WorkspaceBox(TRAY_WS, (0.0, 0.0, 0.06), (0.2, 0.07, 0.1), about_z(90.0))
    away = [boxed(scene, narrow, seed=seed) for seed in range(1, 9)]
    found = [inside_of(simulation, TRAY_WS, simulation.pose(CUBE)[0]) for simulation in away]
    assert np.min(found) > 0.0
    assert np.ptp(found, axis=0)[0] > 0.03, "they lie all along it"


def test_the_places_on_a_tray_are_in_its_turned_box() -> None:
    scene = SceneSpec((CUBE, TRAY, "env:bench"), (PANDA,), {TRAY_WS: (TRAY,)}, {})
    simulation = boxed(scene, WorkspaceBox(TRAY_WS, (0.0, 0.0, 0.06), (0.2, 0.06, 0.1), about_z(30.0)))
    found = list(targets(simulation, simulation.robots[PANDA], CUBE, TRAY_WS))
    assert len(found) == 49
    room = footprint(simulation.world.cast.objects[CUBE])
    assert max(float(np.linalg.norm(np.subtract(one.position, found[0].position))) for one in found) > 0.07
    for target in found:
        assert (inside_of(simulation, TRAY_WS, target.position) > min(room, 0.03) - 1e-9).all()


def test_the_place_of_a_workspace_for_own_behaviours_is_the_middle_of_its_bottom() -> None:
    simulation = boxed(SCENE, WorkspaceBox(BIN_WS, (0.0, 0.0, 0.06), (0.1, 0.1, 0.04), about_x(90.0)))
    world = AgentWorld(simulation, PANDA, lambda _: None)
    (position, rotation), frame = simulation.pose(BIN), simulation.world.cast.objects[BIN].frame
    middle = position + rotation @ np.add(frame, (0.0, 0.0, 0.06))
    # Its z axis is along −y of the bin.
    assert world.place(BIN_WS) == pytest.approx(middle + rotation @ [0.0, 0.02, 0.0])


def test_a_mobile_base_stands_in_front_of_the_sides_of_a_turned_box() -> None:
    rover, table, table_ws = "env:rover", "env:table", "env:table_ws"
    scene = SceneSpec((table,), (rover,), {table_ws: (table,)}, {})
    cell = instance(
        link("x:g.table.foot", (1.5, 0.0, 0.1)),
        link("x:g.base.foot", (0.0, -0.5, -0.65)),
        elements=(catalog(table, "table", "x:g.table"), catalog(rover, "mobile-panda", "x:g.base")),
    )
    box = WorkspaceBox(table_ws, (0.0, 0.0, 0.1), (0.6, 0.4, 0.2), about_z(30.0))
    simulation = Simulation(build_world(scene, 1, None, replace(cell, boxes=(box,))))
    found = list(standing_places(simulation, simulation.robots[rover], table_ws, lambda _: True))
    assert len(found) == 4
    assert [np.degrees(pose[2]) % 90.0 for pose in found] == pytest.approx([30.0] * 4)


def test_a_drawing_has_the_rotation_of_a_turned_box_only() -> None:
    simulation = boxed(SCENE, WorkspaceBox(BIN_WS, (0.0, 0.0, 0.06), (0.1, 0.1, 0.04), about_z(20.0)))
    drawn = geometry(simulation.model, {}, simulation.world.cast.regions)["workspaces"]
    turned = {one["name"]: one.get("orientation") for one in drawn}
    assert turned == {BIN_WS: pytest.approx(list(about_z(20.0)))} | dict.fromkeys(set(turned) - {BIN_WS})
    assert len(turned) > 1


def test_the_walls_of_a_turned_site_are_beside_the_box_around_it() -> None:
    region = CATALOG_BIN.region
    assert region is not None
    long, wide, high = region.half
    quarter = replace(region, half=(wide, long, high), turn=about_z(90.0))
    assert with_walls(quarter, CATALOG_BIN.shapes).walled
    assert not with_walls(replace(quarter, turn=()), CATALOG_BIN.shapes).walled
