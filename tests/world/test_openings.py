"""Drawers, doors and levers from files: their joints, workspaces inside them, and when they are open or closed."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, ModelSource, OpeningModel, Origin, Realisation
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import After
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.configured_values import read_back
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.overlaps import refuse_overlaps
from robbdd_tools.world.passive_joints import opening_records
from robbdd_tools.world.simulation import Simulation
from world.test_staging import instance, link
from world.worlds import CUBE, PANDA, scenario

CHEST, UPPER, LOWER, UPPER_WS = "env:chest", "env:upper", "env:lower", "env:upper_ws"
CHEST_XML = """<mujoco><worldbody><body name="chest">
  <geom type="box" size=".01 .15 .1" pos="-.12 0 .1"/><geom type="box" size=".01 .15 .1" pos=".12 0 .1"/>
  <geom type="box" size=".1 .01 .1" pos="0 .14 .1"/>
  <body name="lower" pos="0 -.02 .02">
    <joint name="lower_slide" type="slide" axis="0 -1 0" range="0 .2" damping="5" frictionloss="1"/>
    <geom type="box" size=".1 .11 .004" mass=".4"/><geom type="box" size=".1 .004 .03" pos="0 -.11 .03" mass=".2"/>
  </body>
  <body name="upper" pos="0 -.02 .12">
    <joint name="upper_slide" type="slide" axis="0 -1 0" range="0 .2" damping="5" frictionloss="1"/>
    <geom type="box" size=".1 .11 .004" mass=".4"/><geom type="box" size=".1 .004 .03" pos="0 -.11 .03" mass=".2"/>
    <site name="upper_workspace" type="box" size=".09 .1 .03" pos="0 0 .035"/>
  </body>
</body></worldbody></mujoco>"""
DOOR_XML = """<mujoco><worldbody><body name="frame"><geom type="box" size=".01 .01 .2" pos="0 0 .2"/>
  <body name="door" pos="0 0 .2"><joint name="hinge" axis="0 0 1" range="-5 95" damping=".2" pos="0 .01 0"/>
    <geom type="box" size=".01 .12 .15" pos="0 .14 0" mass="1"/></body>
</body></worldbody></mujoco>"""
LEVER_XML = """<mujoco><worldbody><body name="base"><geom type="box" size=".05 .05 .02" pos="0 0 .02"/>
  <body name="stick" pos="0 0 .05"><joint name="tilt" axis="0 1 0" range="-40 40" stiffness="2" damping=".1"/>
    <geom type="box" size=".01 .01 .08" pos="0 0 .08" mass=".1"/></body>
</body></worldbody></mujoco>"""
SCENE = SceneSpec(
    objects=(CUBE, CHEST, UPPER, LOWER, "env:bench"),
    agents=(PANDA,),
    workspaces={"env:bench_ws": ("env:bench",), UPPER_WS: (UPPER,)},
)


def simulation(
    folder: Path, text: str, scene: SceneSpec = SCENE, opening: OpeningModel | None = None, element: str = CHEST
) -> Simulation:
    """Return a world of a file as an element, turned so that drawers open towards the arm."""
    (folder / "thing.xml").write_text(text, encoding="utf-8")
    source = ModelSource(
        "x:thing",
        "mjcf",
        "file",
        "thing.xml",
        bodies=(("x:g.chest", ""),),
        origin=Origin(str(folder / "cell.scenex"), 7, 11),
        opening=opening,
    )
    place = link("x:g.chest.foot", (0.6, 0.3, 0.1), turn=(0.5**0.5, 0.0, 0.0, -(0.5**0.5)))
    staged = instance(place, elements=(Realisation(element, (source,)),))
    made = Simulation(build_world(scene, 1, None, staged))
    refuse_overlaps(made)
    return made


def judged(made: Simulation, name: str, element: str) -> Verdict:
    """Judge a predicate about a thing at the last sample."""
    trace = made.trace((EventStamp("e", made.time),), finished=True, remark="")
    openings = opening_records(made.model, made.world.cast.openings, made.recorder.states)
    predicate = load_catalog().predicates[name]
    return judge(predicate, {"object": element}, After("e"), replace(trace, openings=openings), {})


def pushed(made: Simulation, body: str, force: tuple[float, ...], seconds: float) -> None:
    """Push a body with a force (N) in the world frame, or turn it with a torque (N m) after the force."""
    made.data.xfrc_applied[made.model.body(body).id] = (*force, *(0.0,) * (6 - len(force)))
    for _ in range(round(seconds / 0.016)):
        made.tick()
    made.data.xfrc_applied[:] = 0.0


def test_a_drawer_opens_when_it_is_pulled_and_closes_when_it_is_pushed(tmp_path: Path) -> None:
    made = simulation(tmp_path, CHEST_XML)
    made.settle()
    assert judged(made, "is-closed", UPPER).robustness == pytest.approx(0.02 * 0.2, abs=5e-4)
    assert judged(made, "is-open", UPPER).robustness == pytest.approx(-0.9 * 0.2, abs=5e-4)
    pushed(made, UPPER, (-8.0, 0.0, 0.0), 2.0)
    assert judged(made, "is-open", UPPER).robustness == pytest.approx(0.1 * 0.2, abs=1e-3)
    assert judged(made, "is-closed", UPPER).outcome is Outcome.VIOLATED
    assert judged(made, "is-closed", LOWER).outcome is Outcome.HOLDS
    pushed(made, UPPER, (8.0, 0.0, 0.0), 2.0)
    assert judged(made, "is-closed", UPPER).outcome is Outcome.HOLDS
    assert judged(made, "is-open", UPPER).outcome is Outcome.VIOLATED


def test_a_drawer_that_sticks_does_not_open(tmp_path: Path) -> None:
    made = simulation(tmp_path, CHEST_XML.replace('frictionloss="1"', 'frictionloss="20"'))
    made.settle()
    pushed(made, UPPER, (-8.0, 0.0, 0.0), 2.0)
    assert judged(made, "is-open", UPPER).outcome is Outcome.VIOLATED
    assert judged(made, "is-closed", UPPER).outcome is Outcome.HOLDS


def test_the_workspace_in_a_drawer_moves_with_it_and_takes_the_part_along(tmp_path: Path) -> None:
    made = simulation(tmp_path, CHEST_XML, replace(SCENE, places={CUBE: UPPER_WS}))
    made.settle()
    start = made.pose(CUBE)[0].copy()
    pushed(made, UPPER, (-4.0, 0.0, 0.0), 2.0)
    trace = made.trace((EventStamp("e", made.time),), finished=True, remark="")
    way = trace.positions[-1] - trace.positions[0]
    assert way[trace.column(UPPER)] == pytest.approx([-0.2, 0.0, 0.0], abs=1e-3)
    assert way[trace.column(CHEST)] == pytest.approx([0.0, 0.0, 0.0])
    assert made.pose(CUBE)[0] - start == pytest.approx([-0.2, 0.0, 0.0], abs=0.05)
    located = load_catalog().predicates["located-at"]
    arguments = {"object": CUBE, "workspace": UPPER_WS}
    assert judge(located, arguments, After("e"), trace, made.world.cast.regions).outcome is Outcome.HOLDS
    fixed = {UPPER_WS: [(CHEST, made.world.cast.regions[UPPER_WS][0][1])]}
    assert judge(located, arguments, After("e"), trace, fixed).outcome is Outcome.VIOLATED


def test_a_door_opens_in_degrees_and_from_the_end_at_which_the_file_shows_it(tmp_path: Path) -> None:
    scene = replace(SCENE, objects=(CUBE, CHEST, "env:bench"), workspaces={"env:bench_ws": ("env:bench",)})
    made = simulation(tmp_path, DOOR_XML, scene)
    made.settle()
    found = judged(made, "is-open", CHEST)
    assert (found.robustness, found.unit) == (pytest.approx(-85.0, abs=0.5), "deg")
    assert judged(made, "is-closed", CHEST).robustness == pytest.approx(-3.0, abs=0.5)
    pushed(made, f"{CHEST}/door", (0.0, 0.0, 0.0, 0.0, 0.0, 1.0), 2.0)
    assert judged(made, "is-open", CHEST).robustness == pytest.approx(10.0, abs=1.5)
    center = made.pose(f"{CHEST}/door")[0]
    assert center == pytest.approx(made.data.geom_xpos[made.model.geom(f"{CHEST}/door/shape0").id])


def test_a_scene_instance_states_what_the_file_does_not_show(tmp_path: Path) -> None:
    scene = replace(SCENE, objects=(CUBE, CHEST, "env:bench"), workspaces={"env:bench_ws": ("env:bench",)})
    unknown = judged_at_start(simulation(tmp_path, LEVER_XML, scene), CHEST)
    assert unknown.outcome is Outcome.UNKNOWN
    assert "which end of the joint of env:chest is the closed one is not known" in unknown.reason
    stated = OpeningModel("tilt", "-30 deg", "0.5 rad")
    made = simulation(tmp_path, LEVER_XML, scene, stated)
    assert judged_at_start(made, CHEST).robustness == pytest.approx(-0.5 * 180 / pi, abs=0.1)
    turned = simulation(tmp_path, LEVER_XML, scene, replace(stated, closed="30 deg", open="-10 deg"))
    assert judged_at_start(turned, CHEST).robustness == pytest.approx(-10.0, abs=0.1)


def judged_at_start(made: Simulation, element: str) -> Verdict:
    """Settle a world and judge whether a thing is open."""
    made.settle()
    return judged(made, "is-open", element)


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        (OpeningModel("gear"), "opens with the joint 'gear', but its file has lower_slide, upper_slide"),
        (OpeningModel(closed="5 mm"), "has 2 joints, not one: state them in its model"),
        (OpeningModel("upper_slide", "5 deg"), "is a slide: '5 deg' is an angle, not a length"),
        (OpeningModel("upper_slide", "5 mm", "0.005 m"), "must differ"),
        (OpeningModel("upper_slide", "19 cm"), "counts as open before it no longer counts as closed"),
        (
            OpeningModel("upper_slide", "", "25 cm"),
            "'open' of 'env:chest', 0.25 m, is outside of the range of its joint: 0 to 0.2 m",
        ),
        (
            OpeningModel("upper_slide", "-1 cm", "15 cm"),
            "'closed' of 'env:chest', -0.01 m, is outside of the range of its joint: 0 to 0.2 m",
        ),
    ],
)
def test_data_that_do_not_fit_the_file_are_refused_with_their_place(
    stated: OpeningModel, message: str, tmp_path: Path
) -> None:
    with pytest.raises(SceneError, match=message) as refused:
        simulation(tmp_path, CHEST_XML, SCENE, stated)
    assert "cell.scenex:7:11" in str(refused.value)


def test_of_several_joints_one_is_stated(tmp_path: Path) -> None:
    found = judged_at_start(simulation(tmp_path, CHEST_XML), CHEST)
    assert found.outcome is Outcome.UNKNOWN
    assert "env:chest has several joints" in found.reason
    made = simulation(tmp_path, CHEST_XML, SCENE, OpeningModel("lower_slide", open="10 cm"))
    assert judged_at_start(made, CHEST).robustness == pytest.approx(-0.1, abs=1e-3)
    assert judged(made, "is-open", "env:bench").outcome is Outcome.UNKNOWN


def test_the_stated_positions_of_a_joint_are_those_of_its_part(tmp_path: Path) -> None:
    made = simulation(tmp_path, CHEST_XML, SCENE, OpeningModel("lower_slide", open="10 cm"))
    assert judged_at_start(made, LOWER).robustness == pytest.approx(-0.1, abs=1e-3)
    assert judged(made, "is-open", UPPER).robustness == pytest.approx(-0.18, abs=1e-3)


@pytest.mark.parametrize(("share", "position"), [("0", 0.0), ("0.5", 0.1), ("1", 0.2)])
def test_a_thing_starts_as_far_open_as_it_is_configured(share: str, position: float, tmp_path: Path) -> None:
    scene = replace(SCENE, config=(ConfigSpec(UPPER, "opening", share),))
    made = simulation(tmp_path, CHEST_XML, scene)
    made.settle()
    assert judged(made, "is-open", UPPER).robustness == pytest.approx(position - 0.18, abs=1e-3)
    assert float(read_back(made, scene)[UPPER, "opening"]) == pytest.approx(float(share), abs=0.01)


def test_only_a_thing_with_a_joint_can_be_configured_to_be_open(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="has no opening: it applies to a thing with a joint"):
        simulation(tmp_path, CHEST_XML, replace(SCENE, config=(ConfigSpec(CUBE, "opening", "1"),)))


def test_an_element_that_is_a_part_of_two_things_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thing.xml").write_text(CHEST_XML, encoding="utf-8")
    sources = [
        Realisation(name, (ModelSource(name, "mjcf", "file", str(tmp_path / "thing.xml")),))
        for name in (CHEST, "env:other")
    ]
    with pytest.raises(SceneError, match="'env:lower' has no model, and is a moving part of 'env:chest' and of"):
        build_world(replace(SCENE, objects=(*SCENE.objects, "env:other")), 1, None, instance(elements=tuple(sources)))


def test_parts_with_two_joints_are_refused(tmp_path: Path) -> None:
    two = CHEST_XML.replace('<joint name="upper_slide"', '<joint name="more" axis="1 0 0"/><joint name="upper_slide"')
    with pytest.raises(SceneError, match=r"'upper' of thing\.xml has several joints: only one sliding or rotating"):
        simulation(tmp_path, two)


def test_bodies_of_a_model_of_the_whole_scene_are_parts_of_each_other(tmp_path: Path) -> None:
    (tmp_path / "room.xml").write_text(CHEST_XML.replace('name="chest"', 'name="chest" pos=".6 .3 .1"'))
    staged = replace(instance(), models=(ModelSource("x:room", "mjcf", "file", str(tmp_path / "room.xml")),))
    made = Simulation(build_world(SCENE, 1, None, staged))
    made.settle()
    assert judged(made, "is-closed", LOWER).outcome is Outcome.HOLDS
    pushed(made, LOWER, (0.0, -8.0, 0.0), 2.0)
    assert judged(made, "is-open", LOWER).outcome is Outcome.HOLDS


def test_an_execution_records_how_far_things_are_open(tmp_path: Path) -> None:
    (tmp_path / "thing.xml").write_text(CHEST_XML, encoding="utf-8")
    source = ModelSource("x:t", "mjcf", "file", str(tmp_path / "thing.xml"), bodies=(("x:g.chest", ""),))
    place = link("x:g.chest.foot", (0.6, 0.3, 0.1), turn=(0.5**0.5, 0.0, 0.0, -(0.5**0.5)))
    staged = instance(place, elements=(Realisation(CHEST, (source,)),))
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    run = Execution(replace(scenario(SCENE), execution=how), ())
    trace = run.complete(run.advance_until(lambda found: found.end > 0.1))
    record = trace.openings[UPPER]
    assert not isinstance(record, str)
    assert record.positions.shape == trace.times.shape
    assert np.abs(record.positions).max() < 1e-3
    assert UPPER not in trace.immovable
    assert CHEST in trace.immovable
