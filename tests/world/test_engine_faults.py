"""Warnings of the physics engine make a scenario unknown, with the cause; the engine never writes a file of its own."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, ModelSource, Origin, SceneInstance
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import After
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.specs import ExecutionSpec, ScenarioSpec
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.engine_faults import strict
from robbdd_tools.world.errors import SceneError, SimulationError
from robbdd_tools.world.fixed_faults import fixed_faults
from robbdd_tools.world.robot_files import robot_from
from world import strangers
from world.worlds import BIN_WS, CUBE, SCENE, execution, pick_place, scenario

LOG = "MUJOCO_LOG.TXT"
SECOND = '<joint name="again" axis="0 0 1"/>'
DOOR = """
<mujoco><worldbody><body name="door" pos="3 0 0.4"><joint name="hinge" axis="0 0 1"/>{second}
  <geom type="box" size="0.3 0.01 0.3" pos="0.3 0 0" mass="2"/>
</body></worldbody></mujoco>
"""
SPHERES = "".join(f'<body pos="{x / 100} 0 0.1"><freejoint/><geom size="0.1"/></body>' for x in range(8))
CRAMPED = '<mujoco><size memory="{}"/><worldbody><geom type="plane" size="2 2 1"/>' + SPHERES + "</worldbody></mujoco>"
SINGULAR = "is singular, so its motion cannot be computed: give every moving part a mass"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in a folder of the test's own, into which the engine would write its log."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def cell(folder: Path, second: str) -> SceneInstance:
    (folder / "door.xml").write_text(DOOR.format(second=second), encoding="utf-8")
    origin = Origin(str(folder / "cell.scenex"), 3, 7)
    return SceneInstance("x:cell", models=(ModelSource("x:door", "mjcf", "file", "door.xml", origin=origin),))


def spec(instance: SceneInstance) -> ScenarioSpec:
    run = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance)
    return replace(scenario(SCENE, 1), execution=run)


def state(text: str) -> tuple[Any, Any]:
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def test_a_singular_inertia_is_an_error_of_the_scene_at_its_model(folder: Path) -> None:
    with pytest.raises(SceneError) as caught:
        Execution(spec(cell(folder, SECOND)), [pick_place()])
    assert str(caught.value).startswith(f"cell.scenex:3:7: the inertia at the joint 'hinge' {SINGULAR}")
    assert not (folder / LOG).exists()


def test_a_singular_inertia_is_found_without_a_run(folder: Path) -> None:
    (fault,) = fixed_faults(cell(folder, SECOND))
    assert fault.reason.startswith(f"the inertia at the joint 'hinge' {SINGULAR}")
    assert fault.origin is not None
    assert fault.origin.line == 3


def test_a_door_with_one_hinge_is_no_fault(folder: Path) -> None:
    assert list(fixed_faults(cell(folder, ""))) == []


def test_a_gripper_with_a_singular_inertia_is_a_fault_of_its_model(folder: Path) -> None:
    text = strangers.SCARA.replace(
        '<joint name="ja" type="slide" axis="0 1 0" range="0 .035" armature=".1" damping="5"/>',
        '<joint name="ja" type="slide" axis="0 1 0" range="0 .035"/><joint name="jc" type="slide" axis="0 1 0"/>',
    )
    assert "jc" in text
    (folder / "arm.xml").write_text(text, encoding="utf-8")
    origin = Origin(str(folder / "cell.scenex"), 5, 9)
    words = "cell.scenex:5:9: the gripper of arm.xml cannot be simulated: the inertia at the joint 'ja' is singular"
    with pytest.raises(SceneError, match=re.escape(words)):
        robot_from(ModelSource("x:arm", "mjcf", "file", "arm.xml", origin=origin), "env:own")


@pytest.mark.parametrize(
    ("memory", "words"),
    [
        ("8K", "the physics engine failed: mj_stackAlloc: out of memory"),
        ("60K", "the physics engine ran out of memory for contacts, so some of them are missing"),
    ],
)
def test_missing_contacts_are_an_error(folder: Path, memory: str, words: str) -> None:
    model, data = state(CRAMPED.format(memory))
    with pytest.raises(SimulationError, match=words), strict(model, data):
        mujoco.mj_forward(model, data)
    assert not (folder / LOG).exists()


def test_an_error_does_not_remain_for_the_next_simulation() -> None:
    model, data = state(CRAMPED.format("60K"))
    with pytest.raises(SimulationError), strict(model, data):
        mujoco.mj_forward(model, data)
    model, data = state(CRAMPED.format("1M"))
    with strict(model, data):
        mujoco.mj_step(model, data)


@pytest.mark.physics
def test_clauses_are_unknown_when_the_simulation_breaks_down(folder: Path) -> None:
    run = execution([pick_place()])
    run.advance_until(lambda trace: trace.event_time("t:pick-end") is not None)
    # Finite, but beyond what the engine computes with.
    run.simulation.data.qvel[run.simulation.model.body(CUBE).dofadr[0]] = 1e12
    trace = run.advance_until(lambda _: False)
    reason = f"the simulation became unstable: the free joint of '{CUBE}' moves without bounds, at {trace.end:.2f} s"
    assert trace.remark == reason
    stopped = run.cut_short(0)
    assert stopped is not None
    assert (stopped.outcome, stopped.cause) == (Outcome.UNKNOWN, Cause.SIMULATION)
    predicate = load_catalog().predicates["located-at"]
    found = judge(predicate, {"object": CUBE, "workspace": BIN_WS}, After("t:place-end"), trace, run.regions)
    assert found.outcome is Outcome.UNKNOWN
    assert reason in found.reason
    assert not (folder / LOG).exists()
