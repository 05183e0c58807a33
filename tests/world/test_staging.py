"""Executable scenes: files and entries of the catalog as elements, their poses, and their errors."""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, Law, Realisation, SceneInstance
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from robbdd_tools.world.composition import World, build_world
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.put_down import ALONG
from world.scene_instances import BLOCK, BRACKET, SAMPLED, TRAY, catalog, file, instance, link
from world.worlds import BENCH_WS, BIN, BIN_WS, CUBE, PANDA, SCENE, pick_place, scenario


def world(staged: SceneInstance, seed: int = 1, scene: SceneSpec = SCENE) -> World:
    return build_world(scene, seed, None, staged)


def test_elements_stand_where_the_scene_says() -> None:
    staged = instance(
        link("x:g.cube.mid", (0.5, 0.1, 0.2)),
        link("x:g.bin.mid", (0.4, -0.3, 0.1)),
        link("x:g.foot.mid", (0.0, 0.2, 0.15)),
        elements=(
            catalog(CUBE, "cube", "x:g.cube"),
            catalog(BIN, "bin", "x:g.bin"),
            catalog(PANDA, "franka-panda", "x:g.foot"),
        ),
    )
    made = world(staged)
    assert made.poses[CUBE].position == pytest.approx((0.5, 0.1, 0.2))
    # Its frame is at its bottom, its middle 75 mm higher.
    assert made.poses[BIN].position == pytest.approx((0.4, -0.3, 0.175))
    assert made.bases[PANDA].position == pytest.approx((0.0, 0.2, 0.15))


def test_position_range_goes_before_the_pose_of_the_scene() -> None:
    staged = instance(link("x:g.cube.mid", (0.5, 0.1, 0.2)), elements=(catalog(CUBE, "cube", "x:g.cube"),))
    config = ConfigSpec(CUBE, "position_range", "0.3 0.31 0.1 0.11")
    x, y, _ = world(staged, scene=replace(SCENE, config=(config,))).poses[CUBE].position
    assert 0.3 <= x <= 0.31
    assert 0.1 <= y <= 0.11


def test_members_of_a_set_that_are_drawn_onto_one_another_are_drawn_again() -> None:
    near = Law("x:spread", "uniform", (40.0, -15.0, 20.0), (55.0, 15.0, 20.0))
    cubes = (CUBE, "env:cube2", "env:cube3")
    scene = replace(SCENE, objects=(*SCENE.objects, *cubes[1:]))
    staged = instance(SAMPLED, laws=(near,), elements=tuple(catalog(name, "cube", "x:g.cube") for name in cubes))
    for seed in range(20):
        poses = [np.array(world(staged, seed, scene).poses[name].position) for name in cubes]
        distances = [np.linalg.norm((poses[a] - poses[b])[:2]) for a, b in ((0, 1), (0, 2), (1, 2))]
        assert min(distances) > 0.03


@pytest.mark.physics
def test_an_object_from_a_file_is_picked_and_placed(tmp_path: Path) -> None:
    thing = file(tmp_path, CUBE, BLOCK, ("x:g.cube", "block"))
    staged = instance(link("x:g.cube.mid", (0.45, 0.1, 0.14)), elements=(thing,))
    spec = scenario()
    run = Execution(replace(spec, execution=None), [])
    assert run.simulation.world.cast.objects[CUBE].mass == pytest.approx(0.031)
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    run = Execution(replace(spec, execution=how), [pick_place(CUBE, BIN_WS)])
    model = run.simulation.world.cast.objects[CUBE]
    assert (model.mass, model.friction, model.free) == (pytest.approx(0.05), pytest.approx(0.7), True)
    assert model.shapes[0].size == pytest.approx((0.012, 0.02, 0.03))
    assert run.simulation.pose(CUBE)[0] == pytest.approx((0.45, 0.1, 0.13), abs=0.002)
    assert run.run_behaviour(0), run.trace.remark


def test_a_file_says_where_a_workspace_is(tmp_path: Path) -> None:
    staged = instance(
        link("x:g.tray.mid", (0.5, 0.0, 0.11)), elements=(file(tmp_path, BIN, TRAY, ("x:g.tray", "tray")),)
    )
    ((carrier, region),) = world(staged).cast.regions[BIN_WS]
    assert carrier == BIN
    assert region.center == pytest.approx((0.0, 0.0, 0.06))
    assert region.half == pytest.approx((0.09, 0.14, 0.05))
    assert BENCH_WS in world(staged).cast.regions


CRATE = """<mujoco><worldbody><body name="crate"><freejoint/>
  <geom type="box" size=".15 .1 .004" pos="0 0 .004" mass=".4"/>
  <geom type="cylinder" size=".01 .05" pos=".14 .09 .05" mass=".1"/>
  <geom type="cylinder" size=".01 .05" pos="-.14 -.09 .05" mass=".1"/>
  <site name="workspace" type="box" size=".13 .08 .05" pos="0 0 .058"/></body></worldbody></mujoco>"""
BOARD = """<mujoco><worldbody><body name="board">
  <geom type="box" size=".35 .75 .02" pos="0 0 .02"/></body></worldbody></mujoco>"""


@pytest.mark.physics
@pytest.mark.parametrize("factor", ["1", "1.5"])
def test_a_users_bin_takes_things_and_has_a_height(tmp_path: Path, factor: str) -> None:
    crate = file(tmp_path, BIN, CRATE, ("x:g.crate", "crate"))
    staged = instance(link("x:g.crate.foot", (0.45, 0.4, 0.1)), elements=(crate,))
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    taller = replace(SCENE, config=(ConfigSpec(BIN, "height_scale", factor),))
    run = Execution(replace(scenario(taller), execution=how), [pick_place(CUBE, BIN_WS)])
    assert float(run.course.settings[BIN, "height_scale"]) == pytest.approx(float(factor))
    middle = 0.1 + 0.05 * float(factor)
    assert run.simulation.pose(BIN)[0] == pytest.approx((0.45, 0.4, middle), abs=0.002)
    assert run.run_behaviour(0), run.trace.remark
    place = run.simulation.pose(CUBE)[0] - run.simulation.pose(BIN)[0]
    assert np.abs(place[:2]).max() < 0.13


@pytest.mark.physics
def test_things_stand_on_a_users_table_wherever_its_origin_is(tmp_path: Path) -> None:
    """The top of this one is 0.04 m above its origin."""
    board = file(tmp_path, "env:bench", BOARD, ("x:g.board", "board"))
    staged = instance(link("x:g.board.foot", (0.5, 0.0, 0.06)), elements=(board,))
    found = world(staged)
    assert found.poses[CUBE].position[2] == pytest.approx(0.1 + 0.01575)
    assert found.poses[BIN].position[2] == pytest.approx(0.1 + 0.075)
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    run = Execution(replace(scenario(), execution=how), [pick_place(CUBE, BIN_WS)])
    assert run.run_behaviour(0), run.trace.remark


def test_a_fixed_thing_without_workspace_is_not_taken_for_the_table(tmp_path: Path) -> None:
    post = file(tmp_path, "env:a_post", BOARD.replace(".35 .75", ".02 .02"), ("x:g.post", "board"))
    staged = instance(link("x:g.post.foot", (0.9, 0.6, 0.1)), elements=(post,))
    found = world(staged, scene=replace(SCENE, objects=("env:a_post", *SCENE.objects)))
    assert found.cast.tables == ("env:bench", "env:a_post")
    assert found.poses[BIN].position == world(instance()).poses[BIN].position


def test_a_users_table_without_a_pose_is_reported(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"'env:bench' has no pose: place it in the \.scenex"):
        world(instance(elements=(file(tmp_path, "env:bench", BOARD),)))


@pytest.mark.physics
@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_where_a_file_has_its_origin_does_not_matter(tmp_path: Path, yaw: float) -> None:
    found: list[Any] = []
    for number, (x, y, z) in enumerate(((0.0, 0.0, 0.0), (0.0, 0.0, 0.03), (0.1, -0.2, 0.3))):
        folder = tmp_path / str(number)
        folder.mkdir()
        block = BLOCK.replace('size=".012 .02 .03"', f'size=".012 .02 .03" pos="{x} {y} {z}"')
        frame = (0.45 - x * cos(yaw) + y * sin(yaw), 0.1 - x * sin(yaw) - y * cos(yaw), 0.13 - z)
        place = link("x:g.cube.foot", frame, turn=(cos(yaw / 2), 0.0, 0.0, sin(yaw / 2)))
        staged = instance(place, elements=(file(folder, CUBE, block, ("x:g.cube", "block")),))
        how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
        run = Execution(replace(scenario(), execution=how), [pick_place(CUBE, BIN_WS)])
        assert run.simulation.pose(CUBE)[0] == pytest.approx((0.45, 0.1, 0.13), abs=5e-4)
        assert run.run_behaviour(0), run.trace.remark
        found.append(run.simulation.pose(CUBE)[0])
    assert all(place == pytest.approx(found[0], abs=1e-4) for place in found)


@pytest.mark.physics
@pytest.mark.parametrize("yaw", [0.0, 2.0])
def test_a_bracket_is_gripped_at_its_leg_and_its_middle_is_put_at_the_place(tmp_path: Path, yaw: float) -> None:
    """Its middle is 36 mm beside the leg, above a plate that is too low to grip on a table."""
    place = link("x:g.cube.foot", (0.5, 0.1, 0.101), turn=(cos(yaw / 2), 0.0, 0.0, sin(yaw / 2)))
    staged = instance(place, elements=(file(tmp_path, CUBE, BRACKET, ("x:g.cube", "bracket")),))
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    run = Execution(replace(scenario(), execution=how), [pick_place(CUBE, BIN_WS)])
    simulation = run.simulation
    assert run.run_behaviour(0), run.trace.remark
    bins = simulation.pose(BIN)[0]
    offset = simulation.pose(CUBE)[0][:2] - bins[:2]
    assert min(abs(offset[0] - along) for along in ALONG) < 0.004
    assert abs(offset[1]) < 0.004


def test_a_body_of_a_world_file_is_the_element_of_its_name(tmp_path: Path) -> None:
    text = BLOCK.replace('name="block"', 'name="cube1" pos=".4 .2 .5"')
    whole = replace(file(tmp_path, "", text).models[0], iri="x:world")
    made = world(SceneInstance("x:cell", (whole,)))
    assert made.poses[CUBE].position == pytest.approx((0.4, 0.2, 0.5))
    assert made.cast.objects[CUBE].mass == pytest.approx(0.05)
    assert made.model.body("scenery0/plate").id > 0
    assert "scenery0/cube1" not in {made.model.body(index).name for index in range(made.model.nbody)}


POST = '<body name="post" pos=".6 .2 .5"><geom size=".01"/><site name="top"/></body>'
ROPE = '<tendon><spatial name="rope"><site site="top"/><site site="hook"/></spatial></tendon>'


@pytest.mark.parametrize(
    ("constraint", "words"),
    [
        ('<equality><weld name="glue" body1="cube1"/></equality>', "the weld constraint 'glue' in"),
        ('<equality><connect body1="post" body2="cube1" anchor="0 0 0"/></equality>', "the connect constraint in"),
        ('<equality><weld site1="hook" site2="top"/></equality>', "the weld constraint in"),
        (ROPE, "the tendon 'rope' in"),
    ],
)
def test_an_object_that_a_constraint_of_its_file_holds_is_refused(tmp_path: Path, constraint: str, words: str) -> None:
    """Without the constraint, a part that is welded to its fixture could be lifted."""
    text = BLOCK.replace('name="block">', 'name="cube1" pos=".4 .2 .5"><site name="hook"/>')
    text = text.replace("<worldbody>", f"<worldbody>{POST}").replace("</worldbody>", f"</worldbody>{constraint}")
    whole = replace(file(tmp_path, "", text).models[0], iri="x:world")
    with pytest.raises(SceneError, match=words):
        world(SceneInstance("x:cell", (whole,)))


@pytest.mark.parametrize("tie", ['joint1="left" joint2="right"', 'joint1="left"'], ids=["to another", "where it is"])
def test_parts_of_an_object_that_its_file_couples_are_refused(tmp_path: Path, tie: str) -> None:
    doors = "".join(
        f'<body name="{side}_door" pos="{x} 0 .1"><joint name="{side}" axis="0 0 1" range="0 1.5"/>'
        '<geom type="box" size=".02 .005 .08" mass=".1"/></body>'
        for side, x in (("left", -0.05), ("right", 0.05))
    )
    cabinet = f'<body name="cabinet"><geom type="box" size=".1 .1 .01"/>{doors}</body>'
    text = f"<mujoco><worldbody>{cabinet}</worldbody><equality><joint {tie}/></equality></mujoco>"
    staged = instance(
        link("x:g.bin.mid", (0.5, 0.3, 0.11)), elements=(file(tmp_path, BIN, text, ("x:g.bin", "cabinet")),)
    )
    with pytest.raises(SceneError, match=r"the joint constraint in thing\.xml acts on 'left_door', and cannot"):
        world(staged)


def test_an_inactive_constraint_of_a_file_holds_nothing(tmp_path: Path) -> None:
    text = BLOCK.replace('name="block"', 'name="cube1" pos=".4 .2 .5"')
    weld = '<equality><weld body1="cube1" active="false"/></equality>'
    whole = file(tmp_path, "", text.replace("</worldbody>", f"</worldbody>{weld}")).models[0]
    assert CUBE in world(SceneInstance("x:cell", (replace(whole, iri="x:world"),))).cast.objects


def test_bodies_of_a_world_file_whose_shapes_are_all_visual_are_untouchable(tmp_path: Path) -> None:
    shape = '<geom type="box" size=".1 .01 .1" {}/>'
    seen = shape.format('contype="0" conaffinity="0"')
    wall = f'<body name="wall" pos="1 0 1">{seen}<body name="core">{shape.format("")}</body></body>'
    bodies = f'<body name="curtain" pos="1 1 1">{seen}</body>{wall}<body name="mark"/>'
    text = f"<mujoco><worldbody>{bodies}</worldbody></mujoco>"
    whole = replace(file(tmp_path, "", text).models[0], iri="x:world")
    staging = world(SceneInstance("x:cell", (whole,))).cast.staging
    assert staging is not None
    assert staging.untouchable == ("curtain",)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"name": "gone.xml"}, r"cell\.scenex:7:11: there is no model file .*gone\.xml"),
        ({"bodies": (("x:g.cube", "brick"),)}, "thing.xml has no body 'brick'; it has plate, block"),
        ({"format": "usd"}, "'env:cube1' has a USD model only"),
        ({"kind": "ros", "package": "parts"}, "the ROS package 'parts' cannot be found: AMENT_PREFIX_PATH is not set"),
        ({"kind": "python", "name": "no_such_module:make"}, "no_such_module:make failed: ModuleNotFound"),
    ],
)
def test_a_model_that_cannot_be_had_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, change: dict[str, Any], words: str
) -> None:
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    thing = file(tmp_path, CUBE, BLOCK)
    broken = replace(thing.models[0], **change)
    with pytest.raises(SceneError, match=words):
        world(instance(link("x:g.cube.mid", (0, 0, 1)), elements=(replace(thing, models=(broken,)),)))


def test_a_ros_package_is_found_where_the_environment_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    share = tmp_path / "share" / "parts"
    share.mkdir(parents=True)
    thing = file(share, CUBE, BLOCK, ("x:g.cube", "block"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    packaged = replace(thing.models[0], kind="ros", package="parts", origin=None)
    staged = instance(link("x:g.cube.mid", (0.5, 0, 0.2)), elements=(replace(thing, models=(packaged,)),))
    assert world(staged).cast.objects[CUBE].mass == pytest.approx(0.05)


def test_code_makes_a_model(tmp_path: Path) -> None:
    (tmp_path / "maker_of_blocks.py").write_text(f'def block():\n    return """{BLOCK}"""\n', encoding="utf-8")
    thing = file(tmp_path, CUBE, BLOCK, ("x:g.cube", "block"))
    made = replace(thing.models[0], kind="python", name="maker_of_blocks:block")
    staged = instance(link("x:g.cube.mid", (0.5, 0, 0.2)), elements=(replace(thing, models=(made,)),))
    assert world(staged).cast.objects[CUBE].mass == pytest.approx(0.05)


def test_an_object_with_an_inertia_that_no_body_can_have_is_refused(tmp_path: Path) -> None:
    """Only the links of arms, whose drivers never read it, get another one."""
    shape = '<collision><geometry><box size=".03 .03 .03"/></geometry></collision>'
    text = (
        '<robot name="thing"><link name="block"><inertial><mass value="0.05"/>'
        f'<inertia ixx="0.01" iyy="0.01" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial>{shape}</link></robot>'
    )
    made = file(tmp_path, CUBE, text).models[0]
    thing = Realisation(CUBE, (replace(made, format="urdf"),))
    with pytest.raises(SceneError, match=r"cell\.scenex:7:11: .*A \+ B >= C"):
        world(instance(elements=(thing,)))


BEAM = '<mujoco><worldbody><body name="beam"><geom type="box" size=".1 .25 .02"/></body></worldbody></mujoco>'


@pytest.mark.parametrize(("height", "is_apart"), [(0.12, True), (0.40, False)])
def test_a_thing_without_a_place_lies_beside_what_stands_fixed_and_may_lie_below_it(
    height: float, is_apart: bool, tmp_path: Path
) -> None:
    beam = replace(SCENE, objects=(*SCENE.objects, "env:beam"))
    staged = instance(
        link("x:g.beam.mid", (0.45, 0.0, height)), elements=(file(tmp_path, "env:beam", BEAM, ("x:g.beam", "beam")),)
    )
    places = [world(staged, seed, beam).poses[CUBE].position for seed in range(30)]
    outside = [abs(x - 0.45) > 0.1157 or abs(y) > 0.2657 for x, y, _ in places]
    assert all(outside) is is_apart
