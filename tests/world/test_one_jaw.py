"""Grippers on which one jaw moves: the other one is beside the object, and the arm bears the force."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path
from shutil import copyfile, copytree
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import ArmModel, Implementation, ModelSource, Origin, Realisation
from robbdd_tools.protocol.specs import ExecutionSpec
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.mesh_cutting import cut_mesh
from robbdd_tools.world.reaching import approaches
from robbdd_tools.world.robot_files import prepared_robot, robot_from
from world import strangers
from world.arms_of_others import FOLDER
from world.scene_instances import instance, link
from world.worlds import BIN, BIN_WS, CUBE, OTHER_BIN, SCENE, pick_place, scenario

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, RobotModel

ARM = "env:own"
SO_100 = FOLDER / "mani_skill/assets/robots/so100/so100.urdf"


def source(folder: Path, text: str = strangers.DESK) -> ModelSource:
    (folder / "desk.urdf").write_text(text, encoding="utf-8")
    origin = Origin(str(folder / "cell.scenex"), 3, 7)
    return ModelSource("x:arm", "urdf", "file", "desk.urdf", bodies=(("x:g.foot", "base"),), origin=origin)


def picking(arm: ModelSource, yaw: float, foot: float = 0.0) -> Execution:
    """Return the execution in which an arm moves a cube onto a tray near it; ``yaw`` and ``foot`` turn cube and arm."""
    turn = (cos(yaw / 2), 0.0, 0.0, sin(yaw / 2))
    names = {CUBE: "cube", BIN: "tray", OTHER_BIN: "bin"}
    things = [
        Realisation(one, (ModelSource(f"x:{name}", "mjcf", "catalog", name, bodies=((f"x:g.{name}", "b"),)),))
        for one, name in names.items()
    ]
    places = (
        link("x:g.foot.f", (0.05, 0.0, 0.1), turn=(cos(foot / 2), 0.0, 0.0, sin(foot / 2))),
        link("x:g.cube.f", (0.25, 0.06, 0.116), turn=turn),
        link("x:g.tray.f", (0.25, -0.2, 0.1)),
        link("x:g.bin.f", (0.9, 0.5, 0.1)),
    )
    staged = instance(*places, elements=(*things, Realisation(ARM, (arm,), is_agent=True)))
    execution = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), staged)
    scene = replace(SCENE, agents=(ARM,), objects=(CUBE, BIN, OTHER_BIN, "env:bench"))
    return Execution(replace(scenario(scene), execution=execution), [pick_place(CUBE, BIN_WS, ARM)])


def found(folder: Path) -> RobotModel:
    return robot_from(source(folder), ARM)


def tool_in_hand(robot: RobotModel) -> tuple[FloatArray, FloatArray]:
    """Return the place (m) of the tool and its axes, as columns, in the frame of the hand."""
    spec = prepared_robot(robot.mjcf)
    assert spec is not None
    model: Any = spec.compile()
    data: Any = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    hand, tool = data.body("gripper"), data.site(robot.tool_site)
    turn: FloatArray = hand.xmat.reshape(3, 3).T
    return turn @ (tool.xpos - hand.xpos), turn @ tool.xmat.reshape(3, 3)


def test_the_jaw_is_the_gripper_and_the_other_one_carries_the_tool(tmp_path: Path) -> None:
    robot = found(tmp_path)
    assert robot.joints == ("pan", "lift", "elbow", "pitch", "roll")
    assert robot.gripper_actuator == "grip"
    assert finger_motion(robot).one_sided
    assert 0.032 < robot.stroke < 0.05
    place, axes = tool_in_hand(robot)
    assert axes[:, 1:] == pytest.approx(np.eye(3)[:, [1, 0]], abs=1e-6)
    assert place[1] == pytest.approx(-0.008, abs=1e-3), "the surface of the jaw that does not move"


def test_stated_faces_may_be_in_either_order(tmp_path: Path) -> None:
    expected = found(tmp_path)
    for pads in (("fixed_jaw", "moving_jaw"), ("moving_jaw", "fixed_jaw")):
        robot = robot_from(replace(source(tmp_path), arm=ArmModel(pads=pads)), ARM)
        assert (robot.joints, robot.stroke) == (expected.joints, pytest.approx(expected.stroke, abs=1e-3))
        assert finger_motion(robot).one_sided
        assert tool_in_hand(robot)[1][:, 1:] == pytest.approx(np.eye(3)[:, [1, 0]], abs=1e-6)


def test_the_jaw_closes_at_the_speed_of_one_finger(tmp_path: Path) -> None:
    """Over the whole way, from 1.6 to −0.2 rad, it moves by the stroke."""
    robot = found(tmp_path)
    assert finger_motion(robot).rate * robot.stroke == pytest.approx(1.8, rel=0.02)


@pytest.mark.parametrize("turn", [f"0 {pi / 2} 0", f"{pi} {-pi / 2} 0"])
def test_a_stated_tool_gets_the_y_axis_towards_the_jaw_that_moves(tmp_path: Path, turn: str) -> None:
    tip = (
        '<link name="tip"/><joint name="end" type="fixed"><parent link="gripper"/><child link="tip"/>'
        f'<origin xyz="0.1 0 0" rpy="{turn}"/></joint>'
    )
    text = strangers.DESK.replace("</robot>", f"{tip}</robot>")
    robot = robot_from(replace(source(tmp_path, text), arm=ArmModel(tool="tip")), ARM)
    assert tool_in_hand(robot)[1][:, 1:] == pytest.approx(np.eye(3)[:, [1, 0]], abs=1e-6)


@pytest.mark.parametrize("name", ["moving_jaw", "wrist_3"])
def test_a_last_link_that_turns_like_a_wrist_is_no_jaw(tmp_path: Path, name: str) -> None:
    """A flange may have the word gripper in its name, too."""
    text = strangers.DESK.replace("moving_jaw", name).replace('name="grip"', 'name="joint_6"')
    text = text.replace('lower="-0.2" upper="1.6"', 'lower="-2.8" upper="2.8"')
    with pytest.raises(SceneError, match="has no gripper"):
        robot_from(source(tmp_path, text), ARM)


@pytest.mark.physics
@pytest.mark.parametrize("yaw", [0.0, 0.7, 2.0])
def test_an_object_is_gripped_beside_the_fixed_jaw_and_its_middle_is_put_at_the_place(
    tmp_path: Path, yaw: float
) -> None:
    run = picking(source(tmp_path), yaw)
    simulation = run.simulation
    assert run.run_behaviour(0), run.trace.remark
    offset = simulation.pose(CUBE)[0][:2] - simulation.pose(BIN)[0][:2]
    assert np.abs(offset).max() < 0.06
    assert simulation.pose(CUBE)[0][2] == pytest.approx(0.12, abs=0.01)


def test_the_middle_of_an_object_is_half_its_width_beside_the_tool(tmp_path: Path) -> None:
    simulation = picking(source(tmp_path), 0.0).simulation
    robot = simulation.robots[ARM]
    cube = simulation.pose(CUBE)[0]
    for one in approaches(simulation, robot, CUBE):
        place, turn = arm_of(robot.model).forward(one.joints)
        beside = cube[:2] - robot.base.position[:2] - place[:2]
        assert beside @ turn[:2, 1] == pytest.approx(one.grasp.width / 2 + 0.003, abs=1e-3)
        assert np.array(one.grasp.aside) == pytest.approx(one.grasp.width / 2 * turn[:2, 1], abs=1e-3)


EXAMPLES = FOLDER / "cmeel.prefix/share/example-robot-data/robots"
SO_ARM = "so_arm_description"


@pytest.mark.physics
@pytest.mark.nightly
@pytest.mark.skipif(not EXAMPLES.is_dir(), reason="the arms of others are not here: make arms")
@pytest.mark.parametrize(
    ("urdf", "base", "foot", "jaws"),
    [
        (f"{SO_ARM}/urdf/so100.urdf", "base", pi / 2, ("so100/Fixed_Jaw.stl", "so100/Moving_Jaw.stl")),
        (
            f"{SO_ARM}/urdf/so101.urdf",
            "base_link",
            0.0,
            ("so101/wrist_roll_follower_so101_v1.stl", "so101/moving_jaw_so101_v1.stl"),
        ),
        (
            "z1_description/urdf/z1.urdf",
            "link00",
            0.0,
            ("collision/z1_GripperStator.STL", "collision/z1_GripperMover.STL"),
        ),
    ],
)
def test_arms_whose_hollow_jaws_are_cut_put_a_cube_onto_a_tray(
    urdf: str, base: str, foot: float, jaws: tuple[str, ...], tmp_path: Path
) -> None:
    robots, description = tmp_path / "example-robot-data" / "robots", urdf.partition("/")[0]
    copytree(EXAMPLES / description, robots / description)
    arm = ModelSource("x:arm", "urdf", "file", str(robots / urdf), bodies=(("x:g.foot", base),))
    with pytest.raises(SceneError, match=r"no two parts that meet .* A hollow mesh collides as its convex hull"):
        robot_from(arm, ARM)
    for jaw in jaws:
        cut_mesh(robots / description / "meshes" / jaw, threshold=0.05)
    again = replace(arm, name=str((robots / urdf).with_name("cut.urdf")))
    copyfile(robots / urdf, again.name)
    run = picking(again, 0.7, foot)
    assert run.run_behaviour(0), run.trace.remark
    assert np.abs(run.simulation.pose(CUBE)[0][:2] - run.simulation.pose(BIN)[0][:2]).max() < 0.06


@pytest.mark.physics
@pytest.mark.nightly
@pytest.mark.skipif(not SO_100.is_file(), reason="the arms of others are not here: make arms")
@pytest.mark.parametrize("yaw", [0.0, 0.7, 2.0])
def test_the_so_100_as_shipped_puts_a_cube_onto_a_tray(yaw: float) -> None:
    """At zero, it looks along its −y axis."""
    arm = ModelSource("x:arm", "urdf", "file", str(SO_100), bodies=(("x:g.foot", "Base"),))
    run = picking(arm, yaw, foot=pi / 2)
    assert run.run_behaviour(0), run.trace.remark
    assert np.abs(run.simulation.pose(CUBE)[0][:2] - run.simulation.pose(BIN)[0][:2]).max() < 0.06
