"""The force of fingers: what a file states, what is assumed without it, and what a failure says about it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import ArmModel, Implementation, ModelSource, Origin, Realisation, SceneInstance
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, ScenarioSpec
from robbdd_tools.world.arm_control import ArmControl
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.grip_force import grip_force
from world.arms import MJCF, SHEARS, URDF
from world.test_friction import GRAVITY, Held, bench
from world.test_own_robot import FIVE
from world.worlds import BIN_WS, CUBE, PANDA, pick_place, scenario

pytestmark = pytest.mark.physics
EFFORT = 'effort="100"'
SLIDES = URDF[URDF.index('<joint name="left_slide"') :]


def with_effort(effort: float, mimic: bool = True) -> str:
    """Return the arm of five axes in URDF; its fingers have this effort, and follow each other by ``mimic`` or not."""
    own = SLIDES if mimic else SLIDES.replace('<mimic joint="left_slide"/>', "")
    return URDF.replace(SLIDES, own.replace(EFFORT, f'effort="{effort}"'))


def cell(folder: Path, text: str, *config: ConfigSpec, width: float = 1.0) -> ScenarioSpec:
    """Return a scenario in which an arm from a file works with a cube on a bench."""
    kind, name = ("urdf", "arm.urdf") if text.startswith("<robot") else ("mjcf", "arm.xml")
    (folder / name).write_text(text, encoding="utf-8")
    arm = ArmModel() if kind == "urdf" else ArmModel(actuator="grip", pads=("left_pad", "right_pad"))
    source = ModelSource("x:arm", kind, "file", name, arm=arm, origin=Origin(str(folder / "cell.scenex"), 3, 7))
    instance = SceneInstance("x:cell", elements=(Realisation(FIVE, (source,)),))
    own = bench(FIVE, CUBE)
    scene = replace(own, config=(*config, ConfigSpec(CUBE, "size_scale", str(width))))
    behaviour = Implementation("x:own", "catalog", "pick-place")
    return replace(scenario(scene), execution=ExecutionSpec("x:run", "x:run", behaviour, instance))


def held(spec: ScenarioSpec) -> Held:
    return Held(Execution(spec, []).simulation, CUBE)


def stated(one: Held) -> float | None:
    return grip_force(one.model, one.robot.name, one.robot.model)


@pytest.mark.parametrize("mimic", [True, False])
@pytest.mark.parametrize("width", [0.5, 1.2])
@pytest.mark.parametrize("effort", [12.0, 60.0, 180.0])
def test_each_finger_presses_with_the_effort_of_its_file(
    tmp_path: Path, effort: float, width: float, mimic: bool
) -> None:
    one = held(cell(tmp_path, with_effort(effort, mimic), width=width))
    assert one.forces() == pytest.approx([effort, effort], rel=0.03)
    assert stated(one) == pytest.approx(effort, rel=0.03)
    assert not [line for line in changes_of(one.robot.model.mjcf) if "assumed" in line]


@pytest.mark.parametrize(
    ("effort", "words"),
    [
        (0.0, "the file states no effort of its fingers: the grip is assumed"),
        (1000.0, "with the effort in the file, the fingers would press with 1e+03 N, more than such grippers do: "),
    ],
)
def test_without_a_plausible_effort_each_finger_presses_with_15_newtons(
    tmp_path: Path, effort: float, words: str
) -> None:
    one = held(cell(tmp_path, with_effort(effort)))
    assert one.forces() == pytest.approx([15.0, 15.0], rel=0.03)
    assert [line for line in changes_of(one.robot.model.mjcf) if line.startswith(words)]


@pytest.mark.parametrize("share", [0.85, 1.05])
def test_strong_fingers_hold_up_to_twice_friction_times_force(tmp_path: Path, share: float) -> None:
    """The light arm sags when the weight of 3 kg begins to act, which pulls the cube a little."""
    settings = (("friction", 0.2), ("mass", share * 2 * 0.2 * 80.0 / GRAVITY))
    config = [ConfigSpec(CUBE, name, f"{value:.6f}") for name, value in settings]
    slip = held(cell(tmp_path, with_effort(80.0), *config)).slip()
    assert slip < 2e-3 if share < 1 else slip > 0.05


def test_rotating_fingers_with_an_actuator_press_about_as_stated(tmp_path: Path) -> None:
    """The lever of a finger changes with its angle; the stated force is a mean."""
    one = held(cell(tmp_path, SHEARS))
    one.wait(2.0, closing=finger_motion(one.robot.model).rate * 0.05)
    force = stated(one)
    assert force is not None
    assert one.forces() == pytest.approx([force, force], rel=0.2)


def test_the_force_of_a_file_can_be_configured(tmp_path: Path) -> None:
    for text in (MJCF, with_effort(60.0)):
        one = held(cell(tmp_path, text, ConfigSpec(FIVE, "grip_force", "8")))
        # The range of the actuator in the MJCF file is 5 % longer than the way of its fingers.
        assert one.forces() == pytest.approx([8.0, 8.0], rel=0.06)


def test_a_motor_that_closes_a_gripper_has_no_known_force(tmp_path: Path) -> None:
    motor = '<general name="grip" joint="left_slide" gainprm="10" ctrlrange="-1 1"/>'
    begin = MJCF.index('<position name="grip"')
    text = MJCF[:begin] + motor + MJCF[MJCF.index("/>", begin) + 2 :]
    assert stated(held(cell(tmp_path, text))) is None
    with pytest.raises(SceneError, match="no position servo closes its gripper"):
        held(cell(tmp_path, text, ConfigSpec(FIVE, "grip_force", "8")))


def test_what_slips_out_is_compared_with_the_friction_of_the_fingers() -> None:
    scene = replace(bench(PANDA, CUBE, friction=0.6, mass=2.5), agents=(PANDA,))
    run = Execution(scenario(replace(scene, workspaces={BIN_WS: ("env:bench",)})), [pick_place(CUBE, BIN_WS)])
    assert not run.run_behaviour(0)
    assert run.trace.remark.endswith(": its weight is 24.5 N, and its friction in the fingers bears 18 N")


def test_what_is_lost_for_another_reason_is_not_called_heavy() -> None:
    """Its friction in the fingers bears 18 N, and moving it takes up to 1.5 times its weight."""
    for mass, heavy in ((1.21, False), (1.24, True)):
        scene = bench(PANDA, CUBE, friction=0.6, mass=mass)
        control = ArmControl(Execution(scenario(scene), []).simulation, PANDA)
        control.held = CUBE
        assert ("its weight" in str(control.lost())) is heavy
