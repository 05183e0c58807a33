"""Nests and vises: a part fits only if its sides are along their edges, and a hand only beside their walls."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, hypot, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, Origin, Realisation
from robbdd_tools.catalog.objects.box import BOX as CARTON
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.extent import half_sides, outline_of
from robbdd_tools.world.free_places import Field
from robbdd_tools.world.placement import footprint
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.put_down import Floor, targets
from robbdd_tools.world.reaching import approaches
from robbdd_tools.world.region_frames import along_edges
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.space_remarks import space_remarks
from world.scene_instances import catalog, file, instance, link
from world.worlds import BIN, BIN_WS, CUBE, PANDA, pick_place, scenario

BOX, NEST, NEST_WS, BENCH, BENCH_WS = "env:box1", "env:nest", "env:nest_ws", "env:bench", "env:bench_ws"
SECOND, OTHER, OTHER_WS = "env:box2", "env:other", "env:other_ws"
SITE = '<site name="workspace" type="box" size="{} {} .04" pos="0 0 .06"/>'
BED = '<geom type="box" size=".06 .06 .01" pos="0 0 .01"/>'
WALLS = """
<geom type="box" size=".01 .05 .006" pos=".045 0 .026"/><geom type="box" size=".01 .05 .006" pos="-.045 0 .026"/>
<geom type="box" size=".06 .01 .006" pos="0 .037 .026"/><geom type="box" size=".06 .01 .006" pos="0 -.037 .026"/>"""
JAWS = """
<geom type="box" size=".01 .06 .025" pos=".036 0 .045"/><geom type="box" size=".01 .06 .025" pos="-.036 0 .045"/>"""
POCKET = BED + WALLS + SITE.format(0.035, 0.027)
"""A pocket of 70 × 54 mm, 12 mm deep, for the box of 60 × 44 mm."""
VISE = BED + JAWS + SITE.format(0.026, 0.06)
"""Two jaws of 50 mm height, 52 mm apart."""
WIDE_VISE = BED + JAWS.replace(".036", ".044") + SITE.format(0.034, 0.025)
"""Two jaws that are 68 mm apart, with a place for the longer side of the box between them."""
BUILT_IN = Implementation("x:own", "catalog", "pick-place")


def cell(
    folder: Path,
    nest: str,
    degrees: float,
    seed: int,
    arm: str = "franka-panda",
    unload: bool = False,
    goal: str = "",
    beside: tuple[float, float, float] | None = None,
    config: tuple[ConfigSpec, ...] = (),
) -> Execution:
    """Return an execution in which an arm puts a box into a nest that is turned, or takes it out of there.

    ``goal`` is another nest into which it is put from the first one; ``beside`` is the place (m) of a second box.
    """
    half = radians(degrees) / 2
    links = [link("x:g.nest.foot", (0.45, -0.15, 0.1), turn=(cos(half), 0.0, 0.0, sin(half)))]
    elements = [nest_of(folder, NEST, nest, "nest"), catalog(PANDA, arm)]
    carriers = {NEST_WS: (NEST,), BENCH_WS: (BENCH,)}
    start, end = (NEST_WS, BENCH_WS) if unload else (BENCH_WS, NEST_WS)
    objects = [BOX, NEST, BENCH]
    if goal:
        links.append(link("x:g.other.foot", (0.45, 0.25, 0.1)))
        elements.append(nest_of(folder, OTHER, goal, "other"))
        carriers[OTHER_WS] = (OTHER,)
        start, end = NEST_WS, OTHER_WS
        objects.append(OTHER)
    if beside is not None:
        links.append(link("x:g.second.foot", beside))
        elements.append(catalog(SECOND, "box", "x:g.second"))
        objects.append(SECOND)
    scene = SceneSpec(tuple(objects), (PANDA,), carriers, {}, config=config, places={BOX: start})
    spec = ExecutionSpec("x:run", "x:run", BUILT_IN, instance(*links, elements=tuple(elements)))
    return Execution(replace(scenario(scene, seed), execution=spec), [pick_place(BOX, end)])


def nest_of(folder: Path, element: str, shapes: str, name: str) -> Realisation:
    """Write a fixed body with these shapes, and return it as the model of an element."""
    (folder / name).mkdir(exist_ok=True)
    text = f'<mujoco><worldbody><body name="{name}">{shapes}</body></worldbody></mujoco>'
    (made,) = file(folder / name, element, text, (f"x:g.{name}", name)).models
    origin = Origin(str(folder / "cell.scenex"), 7, 11)
    return Realisation(element, (replace(made, iri=f"x:{name}", name=f"{name}/{made.name}", origin=origin),))


def room(simulation: Simulation) -> float:
    """Return the distance (m) of the box from the sides and the bottom of the nest, negative outside."""
    ((carrier, region),) = simulation.world.cast.regions[NEST_WS]
    (at, turn), (origin, edges) = simulation.pose(BOX), along_edges(simulation.seen_place(carrier), region)
    corners = np.array([point for point, _ in outline_of(simulation.world.cast.objects[BOX])])
    local = (corners @ turn.T + at - origin) @ edges - region.center
    sides = np.array(region.half) - np.abs(local)
    return float(min(sides[:, :2].min(), (local[:, 2] + region.half[2]).min() + 1e-3))


@pytest.mark.physics
@pytest.mark.parametrize("arm", ["franka-panda", "ur10"])
@pytest.mark.parametrize("degrees", [0.0, 30.0, 90.0])
@pytest.mark.parametrize("nest", [POCKET, VISE], ids=["pocket", "vise"])
def test_a_part_is_put_into_a_nest(tmp_path: Path, nest: str, degrees: float, arm: str) -> None:
    run = cell(tmp_path, nest, degrees, 1, arm)
    assert run.run_behaviour(0), run.trace.remark
    assert room(run.simulation) > 0.0
    assert run.simulation.pose(BOX)[1][2, 2] > 0.999


@pytest.mark.physics
@pytest.mark.parametrize("nest", [POCKET, VISE], ids=["pocket", "vise"])
def test_a_part_that_is_in_a_nest_is_taken_out(tmp_path: Path, nest: str) -> None:
    run = cell(tmp_path, nest, 30.0, 1, unload=True)
    assert room(run.simulation) > 0.0
    assert run.run_behaviour(0), run.trace.remark
    assert room(run.simulation) < -0.05


@pytest.mark.parametrize("nest", [POCKET, VISE], ids=["pocket", "vise"])
def test_a_part_is_laid_out_in_a_nest_as_it_fits(tmp_path: Path, nest: str) -> None:
    starts = [cell(tmp_path, nest, 30.0, seed, unload=True).simulation for seed in range(1, 6)]
    assert all(room(one) > 0.0 for one in starts)
    places = {round(float(one.pose(BOX)[0][0]), 6) for one in starts}
    assert len(places) == len(starts), "the room that is left is used"


def test_all_of_a_small_place_is_tried(tmp_path: Path) -> None:
    """The usual area of an arm begins 0.25 m ahead of it; the pocket is at 0.24 m."""
    text = f'<mujoco><worldbody><body name="nest">{VISE}</body></worldbody></mujoco>'
    element = file(tmp_path, NEST, text, ("x:g.nest", "nest"))
    scene = SceneSpec((BOX, NEST, BENCH), (PANDA,), {NEST_WS: (NEST,), BENCH_WS: (BENCH,)}, {})
    spec = ExecutionSpec(
        "x:run",
        "x:run",
        BUILT_IN,
        instance(link("x:g.nest.foot", (0.24, 0.0, 0.1)), elements=(element,)),
    )
    simulation = Execution(replace(scenario(scene, 1), execution=spec), [pick_place(BOX, NEST_WS)]).simulation
    (first, *_) = targets(simulation, simulation.robots[PANDA], BOX, NEST_WS)
    assert first.position[:2] == pytest.approx((0.24, 0.0))


def test_the_sides_of_an_object_turn_with_it() -> None:
    (long, wide), (first, second) = half_sides(CARTON, np.eye(3)), (0.03, 0.022)
    assert (long, wide) == pytest.approx((first, second))
    c, s = cos(0.5), sin(0.5)
    turned = half_sides(CARTON, np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]))
    assert turned == pytest.approx((c * first + s * second, s * first + c * second))


def test_the_floor_of_a_place_has_its_own_axes() -> None:
    floor = Floor((1.0, 2.0), (0.3, 0.1), pi / 6)
    assert floor.at((1.0 + cos(pi / 6), 2.0 + sin(pi / 6), 0.0)) == pytest.approx((1.0, 0.0))
    assert floor.at((1.0 - sin(pi / 6), 2.0 + cos(pi / 6), 0.0)) == pytest.approx((0.0, 1.0))


def test_a_field_may_be_turned() -> None:
    field = Field((1.0, 2.0), (0.3, 0.1), 0.0, 0.0, 0.0, None, Pose((0.0, 0.0, 0.0)), yaw=pi / 2)
    assert field.at(1.0, -1.0) == pytest.approx((1.1, 2.3))
    assert hypot(*np.subtract(field.at(0.0, 1.0), (1.0, 2.0))) == pytest.approx(0.1)


SLOTS, BOXES = ("env:slot_1", "env:slot_2", "env:slot_10"), ("env:box1", "env:box2", "env:box3")
MAGAZINE, PITCH = "env:magazine", 0.06
SLOTTED = SceneSpec((), (), dict.fromkeys(SLOTS, (MAGAZINE,)), {})


def magazine(suffix: str, count: int = 3) -> str:
    """Return a magazine with three pockets of 68 × 51 mm, 12 mm deep, and sites for some of its slots."""
    walls = "".join(f'<geom type="box" size=".034 .0045 .006" pos="0 {PITCH * (n - 1.5)} .026"/>' for n in range(4))
    ends = "".join(f'<geom type="box" size=".01 .1 .006" pos="{x} 0 .026"/>' for x in (0.044, -0.044))
    sites = "".join(
        f'<site name="{one[4:]}{suffix}" type="box" size=".034 .0255 .04" pos="0 {PITCH * (n - 1)} .06"/>'
        for n, one in enumerate(SLOTS[:count])
    )
    return f"""<mujoco><worldbody><body name="magazine"><geom type="box" size=".054 .1 .01" pos="0 0 .01"/>
    {walls}{ends}{sites}</body></worldbody></mujoco>"""


def filled(folder: Path, suffix: str = "", count: int = 3, starts: tuple[str, ...] = SLOTS) -> Execution:
    """Return an execution that moves a box of a magazine with three boxes to any of its slots."""
    element = file(folder, MAGAZINE, magazine(suffix, count), ("x:g.magazine", "magazine"))
    place = link("x:g.magazine.foot", (0.5, 0.1, 0.1), turn=(cos(0.2), 0.0, 0.0, sin(0.2)))
    slots = dict.fromkeys(SLOTS, (MAGAZINE,))
    places = dict(zip(BOXES, starts, strict=False))
    scene = SceneSpec((*places, MAGAZINE, BENCH), (PANDA,), {**slots, BENCH_WS: (BENCH,)}, {}, places=places)
    execution = ExecutionSpec("x:run", "x:run", BUILT_IN, instance(place, elements=(element,)))
    call = replace(pick_place(BOXES[0]), arguments={"agent": PANDA, "object": BOXES[0], "workspace": SLOTS})
    return Execution(replace(scenario(scene), execution=execution), [call])


@pytest.mark.parametrize("suffix", ["", "_workspace"])
def test_the_slots_of_a_magazine_are_sites_with_the_names_of_its_workspaces(tmp_path: Path, suffix: str) -> None:
    cast = filled(tmp_path, suffix).simulation.world.cast
    for n, slot in enumerate(SLOTS):
        ((carrier, region),) = cast.regions[slot]
        assert carrier == MAGAZINE
        assert region.center[1] == pytest.approx(PITCH * (n - 1))
    assert not dict(space_remarks(SLOTTED, cast))


def test_each_slot_of_a_magazine_takes_a_part(tmp_path: Path) -> None:
    simulation = filled(tmp_path).simulation
    along = [
        simulation.pose(MAGAZINE)[1][:, 1] @ (simulation.pose(box)[0] - simulation.pose(MAGAZINE)[0]) for box in BOXES
    ]
    assert along == pytest.approx([-PITCH, 0.0, PITCH], abs=0.01)


@pytest.mark.physics
def test_a_part_is_put_into_the_slot_that_is_free(tmp_path: Path) -> None:
    run = filled(tmp_path, starts=(BENCH_WS, SLOTS[0], SLOTS[2]))
    assert run.run_behaviour(0), run.trace.remark
    (magazine_at, turn), (box, _) = run.simulation.pose(MAGAZINE), run.simulation.pose(BOXES[0])
    assert (turn.T @ (box - magazine_at))[:2] == pytest.approx((0.0, 0.0), abs=0.01)


def test_a_run_says_which_workspaces_are_one_space(tmp_path: Path) -> None:
    cast = filled(tmp_path, count=1, starts=(BENCH_WS,)).simulation.world.cast
    remarks = dict(space_remarks(SLOTTED, cast))
    assert remarks.keys() == set(SLOTS)
    assert remarks[SLOTS[1]].startswith("the same space of 'env:magazine', so what is at one of them is at each;")


def test_a_run_says_which_workspace_is_all_spaces_of_an_object(tmp_path: Path) -> None:
    cast = filled(tmp_path, count=2, starts=(BENCH_WS,)).simulation.world.cast
    remarks = dict(space_remarks(SLOTTED, cast))
    assert remarks == {SLOTS[2]: "all workspaces of 'env:magazine', as no site of its model has this name"}


def test_a_site_that_is_no_box_is_no_workspace(tmp_path: Path) -> None:
    text = magazine("").replace('name="slot_1" type="box"', 'name="slot_1" type="sphere"')
    element = file(tmp_path, MAGAZINE, text, ("x:g.magazine", "magazine"))
    spec = ExecutionSpec(
        "x:run", "x:run", BUILT_IN, instance(link("x:g.magazine.foot", (0.5, 0.1, 0.1)), elements=(element,))
    )
    scene = SceneSpec((MAGAZINE, BENCH), (PANDA,), dict(SLOTTED.workspaces), {})
    cast = Execution(replace(scenario(scene), execution=spec), []).simulation.world.cast
    assert [len(cast.regions[slot]) for slot in SLOTS] == [2, 1, 1]


def test_a_run_says_nothing_of_workspaces_inside_of_one_another_and_of_the_boards_of_a_shelf() -> None:
    shelf = {"env:shelf_ws": ("env:shelf1",), "env:board_ws": ("env:shelf1",)}
    scene = SceneSpec(("env:shelf1", BENCH), (PANDA,), shelf, {"env:shelf_ws": ("env:board_ws",)})
    assert not dict(space_remarks(scene, Execution(scenario(scene), []).simulation.world.cast))


def test_a_table_with_several_workspaces_carries_what_has_no_place_of_its_own(tmp_path: Path) -> None:
    text = """<mujoco><worldbody><body name="bench"><geom type="box" size=".3 .6 .02"/>
    <site name="left_ws" type="box" size=".3 .3 .1" pos="0 .3 .12"/>
    <site name="right_ws" type="box" size=".3 .3 .1" pos="0 -.3 .12"/></body></worldbody></mujoco>"""
    element = file(tmp_path, BENCH, text, ("x:g.bench", "bench"))
    spec = ExecutionSpec(
        "x:run", "x:run", BUILT_IN, instance(link("x:g.bench.foot", (0.5, 0.0, 0.1)), elements=(element,))
    )
    scene = SceneSpec((BOX, BENCH), (PANDA,), {"env:left_ws": (BENCH,), "env:right_ws": (BENCH,)}, {})
    simulation = Execution(replace(scenario(scene), execution=spec), []).simulation
    assert simulation.pose(BOX)[0][2] == pytest.approx(0.14, abs=2e-3)
    ((_, left),), ((_, right),) = (simulation.world.cast.regions[one] for one in scene.workspaces)
    assert (left.center[1], right.center[1]) == pytest.approx((0.3, -0.3))


@pytest.mark.physics
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_a_part_is_gripped_so_that_the_hand_has_room_at_its_goal(tmp_path: Path, seed: int) -> None:
    """Between the jaws there is no room for fingers: the part is gripped by its other sides, and not dropped."""
    run = cell(tmp_path, VISE, 30.0, seed)
    assert run.run_behaviour(0), run.trace.remark
    begun = next(event.time for event in run.trace.events if event.name == "t:place-start")
    tool = run.trace.positions[run.trace.times >= begun, run.trace.names.index(PANDA)]
    assert tool[:, 2].min() < 0.16, "the jaws are 0.17 m high"


@pytest.mark.physics
def test_where_the_hand_has_no_room_at_the_start_it_does_not_grip_for_the_goal(tmp_path: Path) -> None:
    run = cell(tmp_path, VISE, 0.0, 1, goal=WIDE_VISE)
    assert run.run_behaviour(0), run.trace.remark


@pytest.mark.physics
def test_a_part_is_put_into_the_middle_of_a_nest_even_if_there_is_more_room_beside_it(tmp_path: Path) -> None:
    run = cell(tmp_path, POCKET, 0.0, 1, beside=(0.55, -0.15, 0.12))
    assert run.run_behaviour(0), run.trace.remark
    assert room(run.simulation) > 0.0


def test_things_in_a_turned_bin_lie_along_its_edges() -> None:
    half = radians(30.0) / 2
    place = link("x:g.bin.foot", (0.5, 0.1, 0.1), turn=(cos(half), 0.0, 0.0, sin(half)))
    spec = ExecutionSpec("x:run", "x:run", BUILT_IN, instance(place, elements=(catalog(BIN, "bin", "x:g.bin"),)))
    scene = SceneSpec((CUBE, BIN, BENCH), (PANDA,), {BIN_WS: (BIN,)}, {}, places={CUBE: BIN_WS})
    for seed in range(1, 6):
        simulation = Execution(replace(scenario(scene, seed), execution=spec), []).simulation
        (_, cube), (_, bin_turn) = simulation.pose(CUBE), simulation.pose(BIN)
        along = bin_turn.T @ cube
        yaw = atan2(along[1, 0], along[0, 0])
        assert abs(yaw - pi / 2 * round(yaw / (pi / 2))) < 0.21


def test_a_range_takes_precedence_over_a_nest(tmp_path: Path) -> None:
    config = (ConfigSpec(BOX, "position_range", "0.30 0.34 0.10 0.14"),)
    with pytest.raises(SceneError, match="no part of 'env:nest', where 'env:box1' should be, is within reach"):
        cell(tmp_path, VISE, 0.0, 1, unload=True, config=config)


def test_a_grasp_that_is_free_at_no_height_stays_the_deepest(tmp_path: Path) -> None:
    deep = POCKET.replace(".006", ".018").replace(".026", ".038")
    simulation = cell(tmp_path, deep, 0.0, 1, unload=True).simulation
    found = list(approaches(simulation, simulation.robots[PANDA], BOX))
    assert found
    assert all(one.depth > 0.0 and one.grasp.depth == pytest.approx(0.02) for one in found)


def test_a_workspace_without_a_site_of_its_name_is_the_site_workspace(tmp_path: Path) -> None:
    whole = '<site name="workspace" type="box" size=".05 .09 .05" pos="0 0 .07"/></body>'
    text = magazine("", 2).replace("</body>", whole)
    element = file(tmp_path, MAGAZINE, text, ("x:g.magazine", "magazine"))
    place = link("x:g.magazine.foot", (0.5, 0.1, 0.1))
    spec = ExecutionSpec("x:run", "x:run", BUILT_IN, instance(place, elements=(element,)))
    scene = SceneSpec((MAGAZINE, BENCH), (PANDA,), dict(SLOTTED.workspaces), {})
    cast = Execution(replace(scenario(scene), execution=spec), []).simulation.world.cast
    found = {slot: [region.half[1] for _, region in cast.regions[slot]] for slot in SLOTS}
    assert found == {SLOTS[0]: [0.0255], SLOTS[1]: [0.0255], SLOTS[2]: [0.09]}
    assert not dict(space_remarks(SLOTTED, cast))


def test_on_a_small_place_a_part_does_not_stick_out_where_another_one_stands_beside_it(tmp_path: Path) -> None:
    """The pan is 0.11 m wide and the box fits on it in any direction; a second box leaves the hand no room there."""
    pan = BED + SITE.format(0.055, 0.055)
    run = cell(tmp_path, pan, 0.0, 1, beside=(0.55, -0.15, 0.12))
    places = [one.position for one in targets(run.simulation, run.simulation.robots[PANDA], BOX, NEST_WS)]
    assert places
    radius = footprint(run.simulation.world.cast.objects[BOX])
    for x, y, _ in places:
        assert max(abs(x - 0.45), abs(y + 0.15)) <= 0.055 - radius + 1e-9
