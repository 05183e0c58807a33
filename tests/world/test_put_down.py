"""Places where a behaviour may put an object down, in a world that is not stepped."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, pi, sqrt

import numpy as np
import pytest

from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world import put_down
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.placement import HAND_GAP, TABLE_TOP, footprint
from robbdd_tools.world.put_down import Target, has_room, targets
from robbdd_tools.world.simulation import Simulation
from world.worlds import BALL, BENCH_WS, BIN, BIN_WS, CUBE, PANDA, SCENE

TRAY, TRAY_WS = "env:tray1", "env:tray1_ws"
WITH_TRAY = SceneSpec(
    objects=(CUBE, BALL, TRAY, "env:bench"),
    agents=(PANDA,),
    workspaces={BENCH_WS: ("env:bench",), TRAY_WS: (TRAY,)},
    contains={BENCH_WS: (TRAY_WS,)},
)
AWAY = (0.0, 2.0, 0.0)
CLEAR = {"bin1": (0.0, 3.0, 0.0), "bin2": (0.0, -3.0, 0.0)}
"""Bins that leave a table to other objects."""
TURNED = (sqrt(0.5), 0.0, 0.0, sqrt(0.5))
"""A quarter turn to the left, as a quaternion (w, x, y, z)."""
Place = tuple[float, float, float]


def world(
    scene: SceneSpec = SCENE, turned: tuple[str, ...] = (), /, **places: tuple[float, float, float]
) -> Simulation:
    """Create a world with objects at given places (m): cube, ball, bin1 or tray1; by default the ball is far away."""
    simulation = Simulation(build_world(scene, 1))
    for name, place in ({"ball1": AWAY} | places).items():
        address = simulation.model.jnt_qposadr[simulation.model.body(f"env:{name}").jntadr[0]]
        simulation.data.qpos[address : address + 3] = place
        if name in turned:
            simulation.data.qpos[address + 3 : address + 7] = TURNED
    mujoco.mj_kinematics(simulation.model, simulation.data)
    return simulation


def found(simulation: Simulation, workspace: str, name: str = CUBE) -> list[Target]:
    return list(targets(simulation, simulation.robots[PANDA], name, workspace))


def places(simulation: Simulation, workspace: str) -> list[Place]:
    """Return the positions in mm."""
    rounded = ([round(1000 * value) for value in target.position] for target in found(simulation, workspace))
    return [(x, y, z) for x, y, z in rounded]


def test_a_bin_has_three_places_along_its_length_and_those_away_from_the_other_bin_come_first() -> None:
    simulation = world()
    assert places(simulation, BIN_WS) == [(420, 600, 105), (480, 600, 105), (450, 600, 105)]
    assert {(target.gap, target.closing) for target in found(simulation, BIN_WS)} == {(0.02, 0.0)}


def test_the_places_of_a_bin_turn_with_it() -> None:
    simulation = world(SCENE, ("bin1",), bin1=(0.4, 0.5, 0.175))
    assert places(simulation, BIN_WS) == [(400, 530, 105), (400, 500, 105), (400, 470, 105)]
    assert [target.closing for target in found(simulation, BIN_WS)] == pytest.approx([pi / 2] * 3)


def test_the_place_of_a_bin_with_the_most_room_comes_first() -> None:
    assert places(world(ball1=(0.47, 0.61, 0.14)), BIN_WS) == [(420, 600, 105), (450, 600, 105), (480, 600, 105)]
    assert places(world(ball1=(0.42, 0.59, 0.14)), BIN_WS) == [(480, 600, 105), (450, 600, 105), (420, 600, 105)]


def test_neither_the_thing_itself_nor_the_bin_takes_room() -> None:
    simulation = world(cube1=(0.48, 0.6, 0.12))
    assert places(simulation, BIN_WS) == places(world(), BIN_WS)
    assert has_room(simulation, simulation.robots[PANDA], CUBE, BIN_WS)
    assert [target.position[0] for target in found(simulation, BIN_WS, BALL)] == pytest.approx([0.42, 0.45, 0.48])


def test_a_thing_has_room_where_the_nearest_one_leaves_it() -> None:
    reach = footprint(world().world.cast.objects[CUBE]) + footprint(world().world.cast.objects[BALL])
    for offset, expected in ((0.99 * reach, False), (1.01 * reach, True)):
        simulation = world(ball1=(0.42 + offset, 0.6, 0.14))
        assert has_room(simulation, simulation.robots[PANDA], CUBE, BIN_WS) is expected
    assert not has_room(simulation, simulation.robots[PANDA], CUBE, "env:nowhere_ws")


def test_a_tray_has_places_all_over_it_and_its_middle_comes_first() -> None:
    simulation = world(WITH_TRAY)
    middle, *rest = places(simulation, TRAY_WS)
    assert middle == (690, 0, 105)
    radius = 1000 * footprint(simulation.world.cast.objects[CUBE])
    x, y = 145 - radius, 105 - radius
    corners = {(round(690 + sx * x), round(sy * y), 105) for sx in (-1, 1) for sy in (-1, 1)}
    assert set(rest[-4:]) == corners
    assert len({middle, *rest}) == 49
    away = [hypot(px - 690, py) for px, py, _ in rest]
    assert away == pytest.approx(sorted(away), abs=2)
    assert {(target.gap, target.closing) for target in found(simulation, TRAY_WS)} == {(0.005, 0.0)}


def test_places_on_a_tray_with_room_for_a_hand_come_first() -> None:
    simulation = world(WITH_TRAY, ball1=(0.69, 0.0, 0.14))
    objects = simulation.world.cast.objects
    wanted = 1000 * (footprint(objects[CUBE]) + footprint(objects[BALL]) + HAND_GAP)
    roomy = [hypot(x - 690, y) >= wanted for x, y, _ in places(simulation, TRAY_WS)]
    assert roomy == sorted(roomy, reverse=True)
    assert 0 < sum(roomy) < 49


def test_the_places_of_a_tray_turn_with_it() -> None:
    simulation = world(WITH_TRAY, ("tray1",), tray1=(0.5, 0.1, 0.115))
    assert [target.closing for target in found(simulation, TRAY_WS)] == pytest.approx([pi / 2] * 49)
    radius = 1000 * footprint(simulation.world.cast.objects[CUBE])
    assert {round(y - 100) for _, y, _ in places(simulation, TRAY_WS)} >= {round(145 - radius), round(radius - 145)}
    assert max(x for x, _, _ in places(simulation, TRAY_WS)) == round(500 + 105 - radius)


def test_a_table_has_places_within_reach_of_the_robot_and_the_middle_of_these_comes_first() -> None:
    simulation = world(**CLEAR)
    middle, *rest = places(simulation, BENCH_WS)
    assert middle == (425, 0, 100)
    assert TABLE_TOP == 0.10
    every = {middle, *rest}
    assert len(every) == 49
    assert (min(x for x, _, _ in every), max(x for x, _, _ in every)) == (250, 600)
    assert (min(y for _, y, _ in every), max(y for _, y, _ in every)) == (-400, 400)
    away = [hypot(x - 425, y) for x, y, _ in rest]
    assert away == pytest.approx(sorted(away), abs=2)
    assert {(target.gap, target.closing) for target in found(simulation, BENCH_WS)} == {(0.005, None)}


def test_places_on_a_table_without_room_for_a_hand_are_left_out() -> None:
    simulation = world(**CLEAR, ball1=(0.425, 0.05, 0.13))
    objects = simulation.world.cast.objects
    wanted = 1000 * (footprint(objects[CUBE]) + footprint(objects[BALL]) + HAND_GAP)
    away = [hypot(x - 425, y - 50) for x, y, _ in places(simulation, BENCH_WS)]
    assert min(away) >= wanted - 1
    assert 30 < len(away) < 49


def test_without_a_roomy_place_on_a_table_any_is_taken() -> None:
    rows = [(0.25 + 0.117 * row, -0.4 + 0.16 * column) for row in range(4) for column in range(6)]
    balls = {f"ball{number}": (x, y, 0.13) for number, (x, y) in enumerate(rows, start=2)}
    crowd = replace(SCENE, objects=(*SCENE.objects, *(f"env:{name}" for name in balls)))
    assert len(places(world(crowd, **balls), BENCH_WS)) == 49


def test_whether_a_far_place_is_reached_is_up_to_the_arm() -> None:
    """The usual area before a robot ends 0.6 m ahead of it; here, the table begins 0.65 m ahead."""
    simulation = world(**CLEAR)
    robot = simulation.robots[PANDA]
    robot.base = replace(robot.base, position=(-0.65, 0.0, 0.15))
    found = [target.position for target in targets(simulation, robot, CUBE, BENCH_WS)]
    assert len(set(found)) == 49
    assert min(x for x, _, _ in found) - robot.base.position[0] > 0.6


def test_places_behind_a_robot_are_left_out() -> None:
    simulation = world()
    robot = simulation.robots[PANDA]
    robot.base = replace(robot.base, yaw=pi)
    assert all(abs(target.position[1]) > 0.2 for target in targets(simulation, robot, CUBE, BENCH_WS))


def test_a_workspace_that_nothing_carries_is_an_error() -> None:
    with pytest.raises(BehaviourError, match="nothing in the scene carries env:nowhere_ws"):
        found(world(), "env:nowhere_ws")


def test_positions_are_numbers_that_json_takes() -> None:
    for scene, workspace in ((SCENE, BIN_WS), (WITH_TRAY, TRAY_WS), (SCENE, BENCH_WS)):
        assert {type(value) for target in found(world(scene), workspace) for value in target.position} == {float}


def test_the_surface_is_that_of_the_bin_where_it_stands() -> None:
    simulation = world(bin1=(0.45, 0.6, 0.475))
    assert np.array(places(simulation, BIN_WS))[:, 2].tolist() == [405] * 3
    assert simulation.pose(BIN)[0][2] == pytest.approx(0.475)


def test_an_object_without_a_region_carries_a_workspace_above_it() -> None:
    scene = replace(
        WITH_TRAY, objects=("env:box", CUBE, "env:bench"), workspaces={"env:on_box": ("env:box",)}, contains={}
    )
    simulation = Simulation(build_world(scene, 1))
    ((carrier, region),) = simulation.world.cast.regions["env:on_box"]
    box = simulation.world.cast.objects["env:box"]
    assert carrier == "env:box"
    assert region.center[2] - region.half[2] == pytest.approx(box.rest_height)
    assert "env:bench_top" not in simulation.world.cast.regions
    place = next(targets(simulation, simulation.robots[PANDA], CUBE, "env:on_box"))
    body = simulation.data.xpos[simulation.model.body("env:box").id]
    assert hypot(*(place.position[:2] - body[:2])) < 0.05
    assert place.position[2] == pytest.approx(body[2] + box.rest_height, abs=1e-3)


@pytest.mark.parametrize("where", [TRAY_WS, BENCH_WS])
def test_without_room_for_a_hand_an_object_is_put_next_to_another_and_not_onto_it(
    where: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(put_down, "HAND_GAP", 10.0)
    at = (0.69, 0.0, 0.14) if where == TRAY_WS else (0.425, 0.0, 0.13)
    simulation = world(WITH_TRAY, ball1=at) if where == TRAY_WS else world(**CLEAR, ball1=at)
    objects = simulation.world.cast.objects
    wanted = 1000 * (footprint(objects[CUBE]) + footprint(objects[BALL]))
    away = [hypot(x - 1000 * at[0], y) for x, y, _ in places(simulation, where)]
    free = [distance >= wanted - 1 for distance in away]
    assert free == sorted(free, reverse=True)
    assert 0 < sum(free) < 49
