"""A gripper from a file of its own is fixed to an arm that has none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.catalog.api import GripperKind, RobotModel
from robbdd_tools.catalog.executable import ArmModel, ModelSource, MountedGripper
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.robot_files import robot_from
from robbdd_tools.world.robot_specs import load_robot
from world.arms import MJCF, URDF, joint
from world.arms_from_files import ARM, picking, source
from world.worlds import CUBE

_BEFORE, _AFTER = MJCF.index('<site name="tcp"'), MJCF.index("</body>", MJCF.index("right_pad") + 60)
_FLANGE = '<site name="flange" pos="0 0 0.03" euler="0 0 1.5707963"/>'
_SERVOS = MJCF[MJCF.index("<actuator>") : MJCF.index('<position name="grip"')]
BARE = f"{MJCF[:_BEFORE]}{_FLANGE}{MJCF[_AFTER : MJCF.index('<equality>')]}{_SERVOS}</actuator></mujoco>"
"""The arm of the other tests without its fingers, with a flange whose y axis points along the x axis of its hand."""
PADS = MJCF[MJCF.index("<default>") : MJCF.index("</default>\n  <worldbody>")]
GRIPPER = f"""<mujoco model="fingers">
  <compiler angle="degree" autolimits="true"/>
  {PADS}</default>
  <worldbody>
    <light pos="0 0 2"/>
    <geom type="plane" size="1 1 0.1"/>
    <body name="hand" pos="0 0 0">
      <freejoint/>
      <geom type="box" size="0.02 0.05 0.01" pos="0 0 0.01" mass="0.4"/>
      <body name="left" pos="0 0.004 0.07">
        <joint class="finger" axis="0 1 0" name="roll"/>
        <geom name="left_pad" class="pad"/>
      </body>
      <body name="right" pos="0 -0.004 0.07">
        <joint class="finger" axis="0 -1 0" name="right_slide"/>
        <geom name="right_pad" class="pad"/>
      </body>
      <site name="tip" pos="0 0 0.07"/>
    </body>
  </worldbody>
  <equality><joint joint1="roll" joint2="right_slide"/></equality>
  <actuator>
    <position name="roll_servo" joint="roll" kp="6000" kv="120" forcerange="-30 30" ctrlrange="-0.002 0.04"/>
  </actuator>
  <keyframe><key name="home" qpos="0 0 0 1 0 0 0 0 0"/></keyframe>
</mujoco>
"""
"""Fingers whose names are also those of parts of the arm: hand, roll, roll_servo."""


_LINKS, _ARM = URDF.index('<link name="hand">'), URDF.index('<joint name="yaw"')
FINGERS = f'<robot name="fingers">{URDF[_LINKS:_ARM]}{URDF[URDF.index("<joint name=" + chr(34) + "left_slide") :]}'
"""The hand and the fingers of the arm of the other tests."""


def mounted(
    name: str = "fingers.xml",
    on: str = "flange",
    position: tuple[float, ...] = (0.0, 0.0, 0.0),
    rotation: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0),
) -> ArmModel:
    return ArmModel(mounted=MountedGripper("file", name, on, position=position, rotation=rotation))


def with_gripper(folder: Path, arm: ArmModel, text: str = GRIPPER, bare: str = BARE) -> ModelSource:
    (folder / ("fingers.urdf" if text.startswith("<robot") else "fingers.xml")).write_text(text, encoding="utf-8")
    return source(folder, bare, arm)


def read(folder: Path, arm: ArmModel, text: str = GRIPPER, bare: str = BARE) -> RobotModel:
    return robot_from(with_gripper(folder, arm, text, bare), ARM)


def tool_in_hand(robot: RobotModel) -> tuple[np.ndarray, np.ndarray]:
    """Return the position (m) and the rotation of the tool in the frame of the arm's hand."""
    model = load_robot(robot).compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    hand, site = model.body("hand").id, model.site(robot.tool_site).id
    turn = data.xmat[hand].reshape(3, 3).T
    return turn @ (data.site_xpos[site] - data.xpos[hand]), turn @ data.site_xmat[site].reshape(3, 3)


def test_the_gripper_is_where_the_site_is_and_found_as_if_one_file_had_both(tmp_path: Path) -> None:
    found = read(tmp_path, mounted())
    assert found.joints == ("yaw", "shoulder", "elbow", "pitch", "roll")
    assert found.stroke == pytest.approx(0.08, abs=1e-3)
    place, turn = tool_in_hand(found)
    # The flange is 30 mm above the hand, the middle of the pads 70 mm above the flange.
    assert place == pytest.approx([0.0, 0.0, 0.1], abs=1e-3)
    # The flange is turned by a quarter about its z axis, and so is the direction in which the fingers close.
    assert abs(turn[0, 1]) == pytest.approx(1.0, abs=1e-3)


def test_an_offset_and_an_orientation_are_those_of_an_adapter(tmp_path: Path) -> None:
    half = np.sqrt(0.5)
    place, turn = tool_in_hand(read(tmp_path, mounted(position=(0.01, 0.0, 0.02), rotation=(half, 0.0, 0.0, half))))
    # 10 mm along the x axis of the flange are 10 mm along the y axis of the hand.
    assert place == pytest.approx([0.0, 0.01, 0.12], abs=1e-3)
    assert abs(turn[1, 1]) == pytest.approx(1.0, abs=1e-3)


def test_a_body_may_carry_the_gripper(tmp_path: Path) -> None:
    place, turn = tool_in_hand(read(tmp_path, mounted(on="hand")))
    assert place == pytest.approx([0.0, 0.0, 0.07], abs=1e-3)
    assert abs(turn[1, 1]) == pytest.approx(1.0, abs=1e-3)


def test_names_of_gripper_and_tool_are_those_in_the_file_of_the_gripper(tmp_path: Path) -> None:
    stated = replace(mounted(), tool="tip", actuator="roll_servo", pads=("left_pad", "right_pad"))
    found = read(tmp_path, stated)
    assert (found.tool_site, found.gripper_actuator) == ("mounted-gripper/tip", "mounted-gripper/roll_servo")
    assert found.pads == ("mounted-gripper/left_pad", "mounted-gripper/right_pad")
    with pytest.raises(SceneError, match=r"gripper of fingers\.xml has no actuator or joint 'yaw_servo'"):
        read(tmp_path, replace(mounted(), actuator="yaw_servo"))
    with pytest.raises(SceneError, match=r"fingers\.xml has no site or body 'flange' for the tool"):
        read(tmp_path, replace(mounted(), tool="flange"))


def test_only_the_gripper_is_taken_from_its_file(tmp_path: Path) -> None:
    spec = load_robot(read(tmp_path, mounted()))
    assert not any(geom.type == mujoco.mjtGeom.mjGEOM_PLANE for geom in spec.geoms)
    assert not any(joint.type == mujoco.mjtJoint.mjJNT_FREE for joint in spec.joints)
    assert not list(spec.lights)
    assert not list(spec.keys)


def test_parts_of_the_gripper_need_no_names(tmp_path: Path) -> None:
    nameless = GRIPPER.replace(' name="roll_servo"', "").replace('<body name="right"', "<body")
    assert read(tmp_path, mounted(), nameless).gripper_actuator == "mounted-gripper/actuator0"


def test_shapes_that_are_fixed_to_the_world_of_the_gripper_keep_their_mass(tmp_path: Path) -> None:
    palm = '<geom type="box" size="0.02 0.05 0.01" pos="0 0 0.01" mass="0.4"/>'
    loose = GRIPPER.replace("<freejoint/>\n      " + palm, "").replace("<light", f"{palm}<light")
    loose = loose.replace('<key name="home" qpos="0 0 0 1 0 0 0 0 0"/>', "")
    # The arm's hand states its inertia, to which the engine adds no shapes.
    inertial = '<body name="hand" pos="0 0 0.08"><inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>'
    bare = BARE.replace('<body name="hand" pos="0 0 0.08">', inertial)
    masses: list[float] = []
    for number, text in enumerate((GRIPPER, loose)):
        folder = tmp_path / str(number)  # What was read of a path is kept.
        folder.mkdir()
        masses.append(float(load_robot(read(folder, mounted(), text, bare)).compile().body_mass.sum()))
    assert masses[0] == pytest.approx(masses[1])


def test_a_urdf_gripper_is_fixed_to_an_mjcf_arm(tmp_path: Path) -> None:
    unusual = FINGERS.replace('ixx="0.01"', 'ixx="0.1"', 1)  # More than the sum of the others.
    idle = f'<link name="knob"/>{joint("turn", ("hand", "knob"), "0 0 1", "0 0.05 0")}</robot>'
    found = read(tmp_path, mounted("fingers.urdf"), unusual.replace("</robot>", idle))
    assert found.stroke == pytest.approx(0.08, abs=1e-3)
    assert "moving links without a mass, which got 1 g: knob" in changes_of(found.mjcf)
    opened = dict(finger_motion(found).open_joints)
    assert {"mounted-gripper/left_slide", "mounted-gripper/right_slide"} <= opened.keys()


@pytest.mark.parametrize(
    ("arm", "message"),
    [
        (mounted(on="flang"), "arm.xml has no site or body 'flang' for the gripper; did you mean 'flange'"),
        (mounted(on="fore"), "'fore' of arm.xml carries the joints pitch, roll: fix the gripper to the end of the arm"),
        (mounted("gone.xml"), "there is no model file .*gone.xml"),
        (mounted(rotation=(0.0, 0.0, 0.0, 0.0)), "the orientation of the gripper fingers.xml is not a rotation"),
        (mounted(position=(1.0, 2.0)), "the offset of the gripper fingers.xml needs 3 numbers, not 2"),
    ],
)
def test_a_gripper_that_cannot_be_mounted_is_refused(tmp_path: Path, arm: ArmModel, message: str) -> None:
    with pytest.raises(SceneError, match=message) as caught:
        read(tmp_path, arm)
    assert caught.value.origin is not None


def test_a_gripper_without_joints_is_named(tmp_path: Path) -> None:
    bracket = '<mujoco><worldbody><body name="b"><geom size=".02"/></body></worldbody></mujoco>'
    with pytest.raises(SceneError, match=r"the gripper of fingers\.xml has no joints and no actuators"):
        read(tmp_path, mounted(), bracket)


def test_a_suction_cup_is_named_by_its_face(tmp_path: Path) -> None:
    shape = '<geom type="cylinder" size=".014 .04" pos="0 0 .04"/>'
    cup = f'<mujoco><worldbody><body name="cup">{shape}</body></worldbody></mujoco>'
    found = read(tmp_path, replace(mounted(), pads=("cup",), stroke=0.028), cup)
    assert (found.gripper, found.stroke) == (GripperKind.SUCTION, 0.028)
    place, _ = tool_in_hand(found)
    assert place == pytest.approx([0.0, 0.0, 0.11], abs=1e-3)


def test_faces_without_friction_are_those_of_the_file_of_the_gripper(tmp_path: Path) -> None:
    smooth = GRIPPER.replace('friction="0.9 0.01 0.001"', 'friction="0 0 0"')
    with pytest.raises(SceneError, match=r"the gripping faces in fingers\.xml have no friction"):
        picking(tmp_path, BARE, with_gripper(tmp_path, mounted(), smooth).arm)


def test_an_arm_without_a_gripper_is_told_how_to_get_one(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"has no gripper: .* fix a gripper to it, gripper \{ sys path = "):
        robot_from(source(tmp_path, BARE), ARM)


@pytest.mark.physics
def test_an_arm_with_a_mounted_gripper_picks_and_places(tmp_path: Path) -> None:
    arm = with_gripper(tmp_path, mounted())
    run = picking(tmp_path, BARE, arm.arm)
    assert run.run_behaviour(0), run.trace.remark
    (cube, _), (container, _) = run.simulation.pose(CUBE), run.simulation.pose("env:bin1")
    assert abs(cube[:2] - container[:2]).max() < 0.15
