"""An arm that the catalog does not have picks and places as well."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import ArmModel, Implementation, ModelSource, Origin, Realisation, SceneInstance
from robbdd_tools.protocol.specs import ExecutionSpec, ScenarioSpec
from robbdd_tools.world.errors import SceneError
from world.arms import MJCF, URDF
from world.worlds import BIN_WS, CUBE, SCENE, pick_place, scenario

FIVE = "env:five"
ARM = ArmModel("tcp", "grip", 0.04, -0.002, ("left_pad", "right_pad"), 0.08, (0.0, 0.2, 1.6, 1.3416, 0.0))
BUILT_IN = Implementation("x:own", "catalog", "pick-place")


def spec(folder: Path, source: ModelSource, seed: int = 1, text: str = MJCF) -> ScenarioSpec:
    (folder / source.name).write_text(text, encoding="utf-8")
    source = replace(source, origin=Origin(str(folder / "cell.scenex"), 3, 7))
    instance = SceneInstance("x:cell", elements=(Realisation(FIVE, (source,)),))
    execution = ExecutionSpec("x:run", "x:run", BUILT_IN, instance)
    return replace(scenario(replace(SCENE, agents=(FIVE,)), seed), execution=execution)


def source(arm: ArmModel | None = ARM, name: str = "five.xml") -> ModelSource:
    return ModelSource("x:five_model", "mjcf", "file", name, arm=arm)


@pytest.mark.physics
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_an_arm_from_an_mjcf_file_picks_and_places(tmp_path: Path, seed: int) -> None:
    run = Execution(spec(tmp_path, source(), seed), [pick_place(CUBE, BIN_WS, FIVE)])
    assert run.run_behaviour(0), run.trace.remark
    trace = run.advance_until(lambda trace: trace.finished)
    position, _ = run.simulation.pose(CUBE)
    bin_at, _ = run.simulation.pose("env:bin1")
    assert abs(position[:2] - bin_at[:2]).max() < 0.15
    assert trace.remark == ""


@pytest.mark.physics
def test_an_arm_from_a_urdf_file_gets_servos_and_picks_and_places(tmp_path: Path) -> None:
    arm = replace(ARM, actuator="left_slide", closed=0.0, pads=("left", "right"))
    model = replace(source(arm, "five.urdf"), format="urdf")
    run = Execution(spec(tmp_path, model, text=URDF), [pick_place(CUBE, BIN_WS, FIVE)])
    assert run.run_behaviour(0), run.trace.remark


@pytest.mark.parametrize(
    ("arm", "words"),
    [
        (
            replace(ARM, tool="tip"),
            r"cell.scenex:3:7: five.xml has no site or body 'tip' for the tool; did you mean 'tcp'\?",
        ),
        (replace(ARM, tool="x"), "five.xml has no site or body 'x' for the tool; it has the sites tcp and the bodies "),
        (
            replace(ARM, actuator="hand"),
            "the gripper of five.xml has no actuator or joint 'hand': the file has the actuators yaw_servo,",
        ),
        (replace(ARM, pads=("left_pad", "thumb")), "no gripping face 'thumb'"),
        (replace(ARM, home=(0.0,)), "the arm has 5 joints .yaw, shoulder, elbow, pitch, roll., 'home' has 1"),
    ],
)
def test_what_an_arm_lacks_is_said_with_its_place(tmp_path: Path, arm: ArmModel | None, words: str) -> None:
    with pytest.raises(SceneError, match=words):
        Execution(spec(tmp_path, source(arm)), [])
