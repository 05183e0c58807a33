"""Mobile bases drive to workspaces, around what they see, and carry what the arm holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import cos, hypot, pi, sin
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.api import RobotModel
from robbdd_tools.catalog.executable import Implementation, ModelSource, Origin, Realisation
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from robbdd_tools.world.base_routes import RouteSearch, cost
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.placement import FLOOR
from robbdd_tools.world.reaching import NONE, ReachSampler
from robbdd_tools.world.robot_files import robot_from
from robbdd_tools.world.staging import Staging
from robbdd_tools.world.tilted_base import Tilt
from world import strangers
from world.test_staging import instance, link
from world.worlds import PANDA, SCENE, scenario

ROVER, NEAR, FAR, CUBE, BIN, CRATE = "env:rover", "env:table1", "env:table2", "env:cube1", "env:bin1", "env:bin2"
NEAR_WS, FAR_WS, BIN_WS = "env:near_ws", "env:far_ws", "env:bin_ws"
EVENTS = {"t:there": "t:a move-end", "t:picked": "t:b pick-end", "t:back": "t:c move-end", "t:put": "t:d place-end"}
TASK = (
    Call("move-to", {"agent": ROVER, "workspace": NEAR_WS}, "t:a", iteration=1),
    Call("pick", {"agent": ROVER, "object": CUBE}, "t:b", iteration=1),
    Call("move-to", {"agent": ROVER, "workspace": BIN_WS}, "t:c", iteration=1),
    Call("place", {"agent": ROVER, "object": CUBE, "workspace": BIN_WS}, "t:d", iteration=1),
)


def room(x: float, y: float) -> RouteSearch:
    """Return the search for a round base of 0.3 m radius in a room with a wall from (1, -1) to (1, 1)."""

    def is_free(pose: np.ndarray) -> bool:
        return hypot(pose[0] - 1.0, max(0.0, abs(pose[1]) - 1.0)) > 0.3

    return RouteSearch(is_free, (-x, -y), (x, y))


def test_a_free_way_is_one_straight_line() -> None:
    route = room(3.0, 3.0).around(np.zeros(3), np.array([0.5, 0.5, pi / 2]))
    assert route is not None
    assert len(route) == 4
    assert cost(route) == pytest.approx(hypot(0.5, 0.5) + 0.3 * pi / 2)


def test_a_base_backs_off_where_that_is_shorter() -> None:
    route = room(3.0, 3.0).around(np.zeros(3), np.array([-0.5, 0.0, 0.0]))
    assert route is not None
    assert [float(pose[2]) % (2 * pi) for pose in route] == pytest.approx([0.0] * 4)
    assert cost(route) == pytest.approx(0.75)


def test_a_route_leads_around_a_wall_in_free_poses() -> None:
    search = room(3.0, 3.0)
    route = search.around(np.zeros(3), np.array([2.0, 0.0, 0.0]))
    assert route is not None
    assert max(abs(float(pose[1])) for pose in route) > 1.0
    assert cost(route) < 6.0
    for one, other in pairwise(route):
        ahead = other[:2] - one[:2]
        if ahead.any():
            assert abs(cos(one[2]) * ahead[1] - sin(one[2]) * ahead[0]) < 1e-6


def test_no_route_leads_through_a_wall() -> None:
    assert room(3.0, 1.2).around(np.zeros(3), np.array([2.0, 0.0, 0.0])) is None


def test_the_platform_states_its_speeds_and_forces_and_other_arms_do_not_drive() -> None:
    robots = load_catalog().robots
    base = base_of(robots["mobile-panda"])
    assert base is not None
    assert (base.speed, base.turning, base.force, base.torque, base.stated) == (0.8, 1.5, 300.0, 60.0, True)
    assert base_of(robots["franka-panda"]) is None


def catalog(element: str, name: str, body: str) -> Realisation:
    """Return the catalog's model for an element, placed by a body of the scene."""
    source = ModelSource(f"x:{body}", "mjcf", "catalog", name, bodies=((f"x:g.{body}", ""),))
    return Realisation(element, (source,), is_agent=element == ROVER)


def fetched(
    crate: tuple[float, ...] = (),
    config: Sequence[ConfigSpec] = (),
    calls: Sequence[Call] = TASK,
    rover: Realisation | None = None,
) -> Execution:
    """Return an execution in which the rover fetches a cube, with a crate on the floor."""
    placed = [
        catalog(NEAR, "table", "near"),
        catalog(FAR, "table", "far"),
        rover or catalog(ROVER, "mobile-panda", "base"),
        *([catalog(CRATE, "bin", "crate")] if crate else []),
    ]
    staged = instance(
        link("x:g.near.foot", (1.5, 0.0, 0.1)),
        link("x:g.far.foot", (-1.5, 0.0, 0.1)),
        link("x:g.base.foot", (0.0, -0.5, -0.65)),
        *([link("x:g.crate.foot", crate)] if crate else []),
        elements=tuple(placed),
    )
    scene = SceneSpec(
        objects=(CUBE, NEAR, FAR, BIN, *([CRATE] if crate else [])),
        agents=(ROVER,),
        workspaces={NEAR_WS: (NEAR,), FAR_WS: (FAR,), BIN_WS: (BIN,)},
        contains={FAR_WS: (BIN_WS,)},
        places={CUBE: NEAR_WS},
        config=tuple(config),
    )
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    run = Execution(replace(scenario(scene, 1, events=EVENTS), execution=how), calls)
    run.advance_until(lambda _: False)
    return run


@pytest.mark.physics
def test_a_mobile_robot_fetches_a_cube_from_one_table_and_brings_it_to_another() -> None:
    run = fetched()
    assert run.completed == 4, run.course.failures
    trace = run.complete(run.trace)
    held = trace.grips[ROVER][:, trace.column(CUBE)]
    picked, back = (trace.last_at_or_before(trace.event_time(name) or 0.0) for name in ("t:picked", "t:back"))
    assert held[picked : back + 1].all()
    way = np.diff(trace.positions[picked : back + 1, trace.column(CUBE)], axis=0)
    # It is carried, at the speed of the platform and of the arm, and never jumps.
    assert np.linalg.norm(way, axis=1).max() < 0.016 * 1.6
    assert not [one for one in trace.contacts if one.other in (NEAR, FAR)]
    # Reach is judged from where the base was at that time, not from where it is now.
    reach = ReachSampler(run.course.simulation)
    there = trace.last_at_or_before(trace.event_time("t:there") or 0.0)
    reach.sample(ROVER, CUBE, range(1))
    reach.sample(ROVER, CUBE, range(there, there + 1))
    margins = reach.record(len(trace.times))[ROVER, CUBE]
    assert margins[0] == NONE
    assert margins[there] > 0.0


def own(folder: Path, text: str) -> Realisation:
    """Return a mobile robot from a file."""
    (folder / "rover.xml").write_text(text, encoding="utf-8")
    origin = Origin(str(folder / "hall.scenex"), 3, 7)
    source = ModelSource("x:rover", "mjcf", "file", "rover.xml", bodies=(("x:g.base", ""),), origin=origin)
    return Realisation(ROVER, (source,), is_agent=True)


@pytest.mark.physics
def test_a_mobile_robot_from_a_file_does_the_same(tmp_path: Path) -> None:
    run = fetched(rover=own(tmp_path, strangers.ROVER))
    assert run.completed == 4, run.course.failures
    (cube, _), (container, _) = run.simulation.pose(CUBE), run.simulation.pose(BIN)
    assert abs(cube[:2] - container[:2]).max() < 0.15


def test_wheels_and_joints_of_the_base_are_not_those_of_the_arm(tmp_path: Path) -> None:
    model = own(tmp_path, strangers.ROVER).models[0]
    found = robot_from(model, ROVER)
    assert found.joints == ("q1", "q2", "q3", "q4", "q5", "q6")
    assert found.mount[2] == FLOOR
    base = base_of(found)
    assert base is not None
    assert (base.joints, base.stated) == (("east", "north", "heading"), False)


def test_a_base_that_drives_cannot_be_tilted(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="drives on the floor, so its base cannot be tilted"):
        robot_from(own(tmp_path, strangers.ROVER).models[0], ROVER, Tilt((0.0, 1.0, 0.0, 0.0), 1.0))


def robot_at(height: float, rover: Realisation) -> RobotModel | None:
    place = link("x:g.base.foot", (0.0, -0.5, height))
    return Staging(instance(place, elements=(rover,)), 1).robot(ROVER)


def test_a_base_that_drives_is_not_placed_in_the_air(tmp_path: Path) -> None:
    usual, other = catalog(ROVER, "mobile-panda", "base"), own(tmp_path, strangers.ROVER)
    for rover, height, gap in ((usual, -0.6, "0.05"), (usual, 0.1, "0.75"), (other, -0.4, "0.2[0-9]")):
        with pytest.raises(SceneError, match=f"drives on the floor: its lowest part is {gap} m above the floor"):
            robot_at(height, rover)
    assert robot_at(FLOOR, usual) is not None
    assert robot_at(FLOOR, other) is not None


def test_a_gantry_with_short_axes_does_not_drive(tmp_path: Path) -> None:
    short = strangers.ROVER.replace('axis="1 0 0"/>', 'axis="1 0 0" range="-1 1"/>', 1)
    found = robot_from(own(tmp_path, short).models[0], ROVER)
    assert found.joints[:3] == ("east", "north", "heading")
    assert base_of(found) is None


@pytest.mark.physics
def test_a_crate_that_the_scanner_sees_is_left_alone_and_a_low_one_is_pushed() -> None:
    there = TASK[:1]
    ways: list[float] = []
    for height in ("2", "0.8"):
        run = fetched((0.45, -0.25, -0.65), [ConfigSpec(CRATE, "height_scale", height)], there)
        assert run.completed == 1, run.course.failures
        path = run.trace.positions[:, run.trace.column(CRATE), :2]
        ways.append(float(np.linalg.norm(path[-1] - path[0])))
    assert ways[0] < 0.001
    assert ways[1] > 0.05


@pytest.mark.physics
def test_a_base_that_something_heavy_blocks_stops_and_says_what_it_is() -> None:
    heavy = [
        ConfigSpec(CRATE, name, value) for name, value in (("height_scale", "0.8"), ("mass", "50"), ("friction", "2"))
    ]
    run = fetched((0.45, -0.25, -0.65), heavy, TASK[:1])
    assert run.completed == 0
    assert f"{ROVER} is blocked by {CRATE} at" in str(run.course.failures[0])


def test_an_arm_on_a_fixed_base_does_not_drive() -> None:
    move = Call("move-to", {"agent": PANDA, "workspace": "env:bench_ws"}, "t:a", iteration=1)
    with pytest.raises(SceneError, match="'env:panda' has no mobile base: only mobile robots move to a workspace"):
        Execution(scenario(SCENE, 1, events=EVENTS), [move])
