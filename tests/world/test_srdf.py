"""SRDF files beside URDF files: hand, tool, home, both ends of the gripper, and collisions that are ignored."""

from __future__ import annotations

from pathlib import Path

import pytest

from robbdd_tools.cli import main
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.robot_files import prepared_robot
from world import strangers
from world.arms_from_files import robot

HOME = "".join(
    f'<joint name="{name}" value="{value}"/>' for name, value in {"x": 0.3, "y": 0.1, "z": 0.2, "turn": 0.5}.items()
)
SRDF = f"""<robot name="gantry">
  <group name="axes"><chain base_link="rail" tip_link="tcp"/></group>
  <group name="gripper"><joint name="grip"/><joint name="follow"/></group>
  <end_effector name="hand" parent_link="hand" group="gripper" parent_group="axes"/>
  <group_state name="parked" group="axes">{HOME.replace("0.3", "0.7")}</group_state>
  <group_state name="home" group="axes">{HOME}</group_state>
  <group_state name="opened" group="gripper"><joint name="grip" value="0.03"/></group_state>
  <group_state name="close" group="gripper"><joint name="grip" value="0"/></group_state>
  <disable_collisions link1="rail" link2="column" reason="Never"/>
  <disable_collisions link1="rail" link2="no_such_link" reason="Never"/>
</robot>"""
CAMERA = (
    '<link name="camera"><inertial><mass value="0.1"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
PAN = (
    '<joint name="pan" type="revolute"><parent link="carriage"/><child link="camera"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="5" velocity="1"/></joint>'
)
TCP = (
    '<link name="tcp"/><joint name="tool" type="fixed"><parent link="hand"/><child link="tcp"/>'
    '<origin xyz="0 0 -0.07" rpy="3.14159265 0 0"/></joint>'
)
URDF = strangers.GANTRY.replace("</robot>", f"{CAMERA}{PAN}{TCP}</robot>")
"""The gantry with a camera on a joint beside the hand, and with a link for its tool."""


def test_groups_say_where_the_hand_is_and_states_give_home_and_gripper(tmp_path: Path) -> None:
    (tmp_path / "arm.srdf").write_text(SRDF, encoding="utf-8")
    found = robot(tmp_path, URDF)
    assert found.joints == ("x", "y", "z", "turn")
    assert found.home == (0.3, 0.1, 0.2, 0.5)
    assert (found.gripper_actuator, found.gripper_open, found.gripper_closed) == ("grip", 0.03, 0.0)
    assert dict(finger_motion(found).open_joints) == pytest.approx({"grip": 0.03, "follow": 0.03}, abs=1e-3)
    assert found.tool_site == "tcp"
    spec = prepared_robot(found.mjcf)
    assert spec is not None
    assert [(str(pair.bodyname1), str(pair.bodyname2)) for pair in spec.excludes] == [("rail", "column")]
    assert spec.joint("pan") is None


def test_without_it_a_camera_on_a_joint_is_taken_for_a_finger(tmp_path: Path) -> None:
    with pytest.raises(SceneError):
        robot(tmp_path, URDF)


@pytest.mark.parametrize("folder", ["", "srdf", "../config"])
def test_it_is_found_by_the_name_of_the_robot(tmp_path: Path, folder: str) -> None:
    (tmp_path / "urdf" / folder).mkdir(parents=True)
    (tmp_path / "urdf" / folder / "semantics.srdf").write_text(SRDF, encoding="utf-8")
    (tmp_path / "urdf" / folder / "other.srdf").write_text('<robot name="other"/>', encoding="utf-8")
    assert robot(tmp_path / "urdf", URDF).home == (0.3, 0.1, 0.2, 0.5)


@pytest.mark.parametrize("instead", ['<joint name="x" value="3"/>', ""])
def test_a_home_outside_the_limits_or_without_a_joint_is_not_used(tmp_path: Path, instead: str) -> None:
    text = SRDF.replace('<joint name="x" value="0.3"/>', instead)
    (tmp_path / "arm.srdf").write_text(text, encoding="utf-8")
    assert robot(tmp_path, URDF).home == (0.7, 0.1, 0.2, 0.5)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            'value="0.03"',
            'value="wide"',
            "arm.srdf cannot be read: the state 'opened' gives the joint 'grip' no number",
        ),
        ("</robot>", "", "the semantic description arm.srdf cannot be read: no element found"),
        ('"opened"', '"closing"', "has 'open' and 'close' reversed"),
    ],
)
def test_what_is_wrong_with_it_is_said_with_its_name(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = SRDF.replace(old, new).replace('"close"', '"open"' if "closing" in new else '"close"')
    (tmp_path / "arm.srdf").write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        robot(tmp_path, URDF)
    assert said in str(caught.value)
    assert "arm.srdf" in str(caught.value)


def test_view_says_which_file_is_used(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(URDF, encoding="utf-8")
    (tmp_path / "one.srdf").write_text(SRDF, encoding="utf-8")
    main(["view", "--robot", str(path), "-o", str(tmp_path / "arm.png")])
    said = capsys.readouterr().out
    assert "semantic description: one.srdf, 2 pairs of links without collisions" in said
    assert "home: state 'home' of the SRDF file" in said
    (tmp_path / "two.srdf").write_text(SRDF, encoding="utf-8")
    (tmp_path / "arm.urdf").write_text(strangers.GANTRY, encoding="utf-8")
    main(["view", "--robot", str(path), "-o", str(tmp_path / "arm.png")])
    said = capsys.readouterr().out
    assert "none is used, since several describe this robot (one.srdf, two.srdf)" in said
    assert "home: found by a search" in said
