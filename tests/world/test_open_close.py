"""Arms open and close drawers and doors by their handles, in the catalog's model and in files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, ModelSource, Origin, Realisation
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from robbdd_tools.world.errors import SceneError
from world.test_staging import instance, link
from world.worlds import BALL, CUBE, PANDA, scenario

pytestmark = pytest.mark.physics
DRAWER, DRAWER_WS, DOOR = "env:drawer", "env:drawer_ws", "env:door"
SCENE = SceneSpec(
    objects=(CUBE, DRAWER, "env:bench"),
    agents=(PANDA,),
    workspaces={"env:bench_ws": ("env:bench",), DRAWER_WS: (DRAWER,)},
    contains={"env:bench_ws": (DRAWER_WS,)},
)
EVENTS = {"t:open-end": "t:a open-end", "t:close-start": "t:c close-start", "t:close-end": "t:c close-end"}
DOOR_XML = """<mujoco><worldbody><body name="frame"><geom type="box" size=".01 .01 .06" pos="0 0 .06"/>
  <body name="leaf" pos="0 0 .06"><joint name="hinge" axis="0 0 -1" range="0 70" damping=".2" pos="0 .01 0"/>
    <geom type="box" size=".008 .09 .05" pos="0 .11 0" mass=".6"/>
    <geom type="box" size=".025 .006 .006" pos="-.033 .17 .02" mass=".02"/>
    <geom name="knob" type="cylinder" size=".014 .016" pos="-.065 .17 .02" mass=".04"/></body>
</body></worldbody></mujoco>"""

BAR_XML = """<mujoco><worldbody><body name="chest">
  <geom type="box" size=".1 .12 .005" pos="0 0 .005"/><geom type="box" size=".1 .12 .003" pos="0 0 .073"/>
  <geom type="box" size=".1 .005 .03" pos="0 .115 .04"/><geom type="box" size=".1 .005 .03" pos="0 -.115 .04"/>
  <body name="box" pos="-.1 0 .012">
    <joint type="slide" axis="-1 0 0" range="0 .14" damping="5" frictionloss="1"/>
    <geom type="box" size=".09 .1 .003" pos=".09 0 .003" mass=".3"/>
    <geom type="box" size=".005 .12 .03" pos="-.005 0 .03" mass=".2"/>
    <geom type="box" size=".02 .004 .004" pos="-.03 .05 .045" mass=".02"/>
    <geom type="box" size=".02 .004 .004" pos="-.03 -.05 .045" mass=".02"/>
    <geom name="bar_handle" type="box" size=".005 .055 .005" pos="-.045 0 .045" mass=".05"/></body>
</body></worldbody></mujoco>"""


def call(behaviour: str, part: str, agent: str = PANDA, **slots: str) -> Call:
    return Call(behaviour, {"agent": agent, **slots}, part, iteration=1)


def executed(scene: SceneSpec, *calls: Call, seed: int = 1) -> Execution:
    run = Execution(scenario(scene, seed, events=EVENTS), calls)
    run.advance_until(lambda _: False)
    return run


def positions(run: Execution, thing: str = DRAWER) -> np.ndarray:
    record = run.complete(run.trace).openings[thing]
    assert not isinstance(record, str)
    return record.positions


def at(run: Execution, event: str) -> int:
    time = run.trace.event_time(event)
    assert time is not None
    return run.trace.last_at_or_before(time)


@pytest.mark.parametrize("arm", [PANDA, "env:ur10"])
def test_an_arm_opens_a_drawer_puts_a_part_in_and_closes_it(arm: str) -> None:
    put = call("pick-place", "t:b", arm, object=CUBE, workspace=DRAWER_WS)
    run = executed(
        replace(SCENE, agents=(arm,)),
        call("open", "t:a", arm, object=DRAWER),
        put,
        call("close", "t:c", arm, object=DRAWER),
    )
    assert run.completed == 3
    found = positions(run)
    assert found[at(run, "t:open-end")] > 0.9 * 0.16
    assert found[at(run, "t:close-start")] > 0.9 * 0.16
    assert found[-1] < 0.02 * 0.16
    trace, (carrier, region) = run.trace, run.regions[DRAWER_WS][0]
    inside = trace.positions[-1, trace.column(CUBE)] - trace.positions[-1, trace.column(carrier)] - region.center
    assert (np.abs(inside[:2]) < np.array(region.half[:2]) - 0.015).all()
    assert np.abs(trace.positions[-1, trace.column(DRAWER)] - trace.positions[0, trace.column(DRAWER)]).max() < 1e-3


def test_a_part_that_is_too_large_keeps_the_drawer_open() -> None:
    scene = replace(SCENE, objects=(BALL, DRAWER, "env:bench"))
    put = call("pick-place", "t:b", object=BALL, workspace=DRAWER_WS)
    run = executed(scene, call("open", "t:a", object=DRAWER), put, call("close", "t:c", object=DRAWER))
    assert run.completed == 2
    assert run.failure(2).startswith(f"gripper lost the handle of {DRAWER} at ")
    assert positions(run)[-1] > 0.1


@pytest.mark.parametrize(("behaviour", "share"), [("open", "1"), ("close", "0")])
def test_what_is_open_or_closed_stays_as_it_is(behaviour: str, share: str) -> None:
    scene = replace(SCENE, config=(ConfigSpec(DRAWER, "opening", share),))
    run = executed(scene, call(behaviour, "t:a", object=DRAWER))
    assert run.completed == 1
    assert np.ptp(positions(run)) < 1e-3


def with_door(folder: Path, text: str, place: tuple[float, float, float] = (0.5, 0.1, 0.1)) -> Execution:
    """Return an execution in which the Panda opens and closes a door or a drawer from a file."""
    (folder / "door.xml").write_text(text, encoding="utf-8")
    source = ModelSource(
        "x:m", "mjcf", "file", "door.xml", bodies=(("x:g.door", ""),), origin=Origin(str(folder / "c.scenex"), 7, 11)
    )
    staged = instance(link("x:g.door.foot", place), elements=(Realisation(DOOR, (source,)),))
    how = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    scene = SceneSpec(objects=(DOOR, "env:bench"), agents=(PANDA,), workspaces={"env:bench_ws": ("env:bench",)})
    spec = replace(scenario(scene, 1, events=EVENTS), execution=how)
    return Execution(spec, [call("open", "t:a", object=DOOR), call("close", "t:c", object=DOOR)])


def test_an_arm_opens_and_closes_a_door_by_its_knob(tmp_path: Path) -> None:
    run = with_door(tmp_path, DOOR_XML)
    run.advance_until(lambda _: False)
    assert run.completed == 2, run.course.failures
    assert positions(run, DOOR)[at(run, "t:open-end")] > 0.9 * 1.2217
    assert positions(run, DOOR)[-1] < 0.02 * 1.2217


def test_fingers_fit_behind_a_bar_when_they_open_just_enough(tmp_path: Path) -> None:
    run = with_door(tmp_path, BAR_XML, (0.6, 0.2, 0.1))
    run.advance_until(lambda _: False)
    assert run.completed == 2, run.course.failures
    assert positions(run, DOOR)[at(run, "t:open-end")] > 0.9 * 0.14
    assert positions(run, DOOR)[-1] < 0.02 * 0.14


def test_a_door_without_a_handle_is_a_fault_of_the_model(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"'env:door' has no handle: name a shape of its moving part"):
        with_door(tmp_path, DOOR_XML.replace('name="knob" ', ""))


def test_what_has_no_joint_cannot_be_opened() -> None:
    with pytest.raises(SceneError, match=r"'env:cube1' has no joint to open or to close"):
        executed(SCENE, call("open", "t:a", object=CUBE))
