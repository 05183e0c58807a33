"""Arms that others model load as they are; what their files lack is reported with its place."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.catalog import robots
from robbdd_tools.catalog.executable import (
    ArmModel,
)
from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.motion import ToolPose, frame_of
from robbdd_tools.world.placement import TABLE_TOP
from robbdd_tools.world.robot_files import prepared_robot
from world import strangers
from world.arms import MJCF, SHEARS
from world.arms_from_files import ARM, picking, robot
from world.worlds import CUBE

SHORT = strangers.SCARA.replace('range="0 .42"', 'range="0 .2"')
"""A SCARA whose quill moves by 0.2 m."""


def test_the_stroke_of_an_arm_is_that_of_its_vertical_slides(tmp_path: Path) -> None:
    low, high = arm_of(robot(tmp_path, SHORT)).stroke
    assert (round(low, 2), round(high - low, 6)) == (0.04, 0.2)
    assert arm_of(robot(tmp_path, strangers.SIX, name="six.xml")).stroke == (-math.inf, math.inf)


def test_a_pose_beyond_the_stroke_is_missed_by_what_is_missing(tmp_path: Path) -> None:
    arm = arm_of(robot(tmp_path, SHORT))
    start = next(arm.solutions(*frame_of(ToolPose(0.5, 0.3, arm.stroke[1] - 0.01, 0.0))))
    with pytest.raises(Unreachable, match="50 mm short"):
        arm.solve(start, *frame_of(ToolPose(0.5, 0.3, arm.stroke[0] - 0.05, 0.0)))


@pytest.mark.physics
def test_an_arm_with_a_short_stroke_stands_so_low_that_it_reaches_the_table(tmp_path: Path) -> None:
    run = picking(tmp_path, SHORT)
    arm = run.simulation.robots[ARM]
    assert arm.base.position[2] + arm_of(arm.model).stroke[0] == pytest.approx(TABLE_TOP)
    assert run.run_behaviour(0), run.trace.remark
    assert not run.trace.remark


@pytest.mark.physics
@pytest.mark.parametrize(
    "text",
    [strangers.SCARA, strangers.THUMB, strangers.SIX, strangers.VACUUM, strangers.GANTRY, strangers.RAIL, MJCF, SHEARS],
    ids=["scara", "thumb", "six", "vacuum", "gantry", "rail", "five", "shears"],
)
def test_an_arm_picks_and_places_with_the_data_in_its_file_alone(tmp_path: Path, text: str) -> None:
    run = picking(tmp_path, text)
    assert run.run_behaviour(0), run.trace.remark
    (cube, _), (container, _) = run.simulation.pose(CUBE), run.simulation.pose("env:bin1")
    assert abs(cube[:2] - container[:2]).max() < 0.15


def test_a_mimic_joint_follows_and_the_speeds_of_a_urdf_file_count(tmp_path: Path) -> None:
    found = robot(tmp_path, strangers.GANTRY)
    assert found.joints == ("x", "y", "z", "turn")
    assert found.velocity_limits == (0.8, 0.8, 0.5, 2.5)
    assert (found.gripper_actuator, found.stroke) == ("grip", pytest.approx(0.08, abs=1e-3))


def test_joints_of_transmissions_do_not_hide_the_speeds(tmp_path: Path) -> None:
    drive = '<transmission name="drive"><joint name="z"><hardwareInterface>x</hardwareInterface></joint></transmission>'
    found = robot(tmp_path, strangers.GANTRY.replace("</robot>", f"{drive}</robot>"))
    assert found.velocity_limits == (0.8, 0.8, 0.5, 2.5)


@pytest.mark.physics
def test_a_light_spindle_turns_to_its_target(tmp_path: Path) -> None:
    """A cup on a thin spindle has an inertia of 1e-4 kg m²; its motor has 10 N m."""
    spindle = """<mujoco><compiler angle="radian"/><worldbody><body name="base"><geom size=".05"/>
    <body name="arm" pos="0 0 .4"><joint name="swing" axis="0 0 1"/><geom type="capsule" size=".03 .15" pos=".15 0 0"/>
    <body name="fore" pos=".3 0 0"><joint name="bend" axis="0 0 1"/><geom type="capsule" size=".03 .15" pos=".15 0 0"/>
    <body name="spindle" pos=".3 0 0"><joint name="down" type="slide" axis="0 0 -1" range="-.05 .3"/>
    <joint name="turn" axis="0 0 -1"/><geom type="cylinder" size=".01 .2" mass=".5"/>
    <geom type="cylinder" size=".011 .005" pos="0 0 -.205" mass=".02"/></body></body></body></body></worldbody>
    <actuator><motor joint="turn" ctrlrange="-10 10"/><adhesion body="spindle" gain="30" ctrlrange="0 1"/></actuator>
    </mujoco>"""
    found = robot(tmp_path, spindle)
    spec = prepared_robot(found.mjcf)
    assert spec is not None
    model = spec.compile()
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    data = mujoco.MjData(model)
    data.ctrl[model.actuator("turn-servo").id] = 1.0
    mujoco.mj_step(model, data, 1000)
    assert data.joint("turn").qpos[0] == pytest.approx(1.0, abs=0.01)


def test_what_a_scene_states_replaces_what_the_file_says(tmp_path: Path) -> None:
    stated = ArmModel(home=(0.0, -0.5, 0.1, 0.2), velocity=(1.0, 2.0, 3.0, 4.0), stroke=0.06)
    found = robot(tmp_path, strangers.SCARA, stated)
    assert (found.home, found.velocity_limits, found.stroke) == (stated.home, stated.velocity, 0.06)


def test_a_home_is_found_from_which_the_arm_reaches_far(tmp_path: Path) -> None:
    # At most places, the wrist of this arm can be turned inwards as well; then it reaches 0.2 m less.
    text = (Path(robots.__path__[0]) / "ur10.xml").read_text(encoding="utf-8")
    arm = arm_of(robot(tmp_path, text))
    for height in (0.0, 0.25):
        place, turn = frame_of(ToolPose(1.2, 0.3, height, 0.2))
        reached, _ = arm.forward(arm.solve(arm.towards(place), place, turn))
        assert reached == pytest.approx(place, abs=1e-4)


def test_the_fingers_close_across_the_way_ahead_at_a_home_that_was_found(tmp_path: Path) -> None:
    """Otherwise the wrist reaches its limit on the way to half of the grasps."""
    found = robot(tmp_path, MJCF)
    place, axes = arm_of(found).forward(np.array(found.home))
    assert axes[:, 0] == pytest.approx([1.0, 0.0, 0.0], abs=0.01), "x points ahead"
    assert abs(found.home[-1]) < 0.1, "the wrist turns as far to both sides"
    assert place[0] > 0.3


def test_an_arm_reaches_a_place_from_another_posture_than_its_home(tmp_path: Path) -> None:
    """From this home, the wrist is 0.2 rad from its limit, and the tool turned by a quarter of a turn."""
    arm = arm_of(robot(tmp_path, MJCF, ArmModel(home=(0.0, 0.2, 1.6, 1.3416, 2.8))))
    wanted = frame_of(ToolPose(0.55, 0.0, 0.1, -0.5))
    with pytest.raises(Unreachable):
        arm.solve(arm.towards(wanted[0]), *wanted)
    joints = next(arm.solutions(*wanted))
    assert arm.forward(joints)[0] == pytest.approx(wanted[0], abs=1e-4)


def test_a_wrist_at_its_limit_changes_its_posture(tmp_path: Path) -> None:
    """With this home, the straight path to the cube exceeds the limit of the wrist."""
    run = picking(tmp_path, MJCF, ArmModel(home=(0.0, 0.2, 1.6, 1.3416, 2.8)))
    assert run.run_behaviour(0), run.trace.remark


@pytest.mark.physics
def test_a_failure_to_reach_says_by_how_much_or_what_is_in_the_way(tmp_path: Path) -> None:
    short = strangers.SCARA.replace(".45 0 0", ".25 0 0").replace('pos=".45 0 .06"', 'pos=".25 0 .06"')
    run = picking(tmp_path, short)
    assert not run.run_behaviour(0)
    assert re.fullmatch(
        r"env:own cannot reach (env:cube1|a free place .*): its tool stays \d+ mm short", run.failure(0)
    )


FACES = ArmModel(pads=("left_pad", "right_pad"))
NEVER = MJCF.replace('range="0 0.04"', 'range="0.03 0.04"').replace('ctrlrange="-0.002 0.04"', 'ctrlrange="0.03 0.04"')


@pytest.mark.parametrize(
    ("text", "arm", "words"),
    [
        (strangers.CUP_ONLY, None, "has no gripper: beyond the body 'b6', the file has no joints and no actuators"),
        (
            MJCF,
            replace(FACES, open=-0.002, closed=0.04),
            "has 'open' and 'close' reversed: 0.080 m between its faces at",
        ),
        (
            MJCF,
            replace(FACES, open=4.0),
            "has an actuator 'grip' that takes values from -0.002 to 0.04: 'open' cannot be 4",
        ),
        (
            strangers.VACUUM,
            ArmModel(closed=2.0),
            "takes values from 0 to 1: 'close' cannot be 2",
        ),
        (MJCF, replace(FACES, stroke=0.15), "opens 0.080 m, not the stated stroke of 0.150 m"),
        (MJCF, ArmModel(pads=("left_pad", "hand")), "the gripper of arm.xml"),
        (
            NEVER,
            ArmModel(actuator="grip"),
            "the gripper of arm.xml has no two parts that meet when it closes: name its pads",
        ),
        (
            MJCF.replace('name="elbow" axis="0 1 0" range="-2.8 2.8"', 'name="elbow" axis="0 1 0" range="2.8 -2.8"'),
            None,
            "the joint 'elbow' in arm.xml has the limits 2.8 to -2.8: swap them",
        ),
        (
            strangers.GANTRY.replace('lower="-0.7" upper="0.7"', 'lower="0.7" upper="-0.7"'),
            None,
            "the joint 'y' in arm.urdf has the limits 0.7 to -0.7: swap them",
        ),
        (MJCF, ArmModel(home=(0.0, 9.0, 0.0, 0.0, 0.0)), "the home position 9 of the joint 'shoulder' is outside its"),
        (MJCF.replace('<body name="foot">', '<body name="foot"><freejoint/>'), None, "has a free joint 'joint0'"),
        (strangers.GANTRY.replace("visual>", "collision>"), None, "the collision mesh 'package://gantry_description/"),
    ],
)
def test_what_is_wrong_with_a_model_is_said_of_the_model(
    tmp_path: Path, text: str, arm: ArmModel | None, words: str
) -> None:
    with pytest.raises(SceneError) as caught:
        robot(tmp_path, text, arm)
    assert str(caught.value).startswith("cell.scenex:3:7: ")
    assert words in str(caught.value)


def test_a_xacro_file_is_refused_with_the_command_that_expands_it(tmp_path: Path) -> None:
    text = strangers.GANTRY.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    text = text.replace("</robot>", '<xacro:property name="a" value="1"/></robot>')
    with pytest.raises(SceneError, match=r"it is a xacro file: expand it \('xacro arm.urdf.xacro > arm.urdf'\)"):
        robot(tmp_path, text, name="arm.urdf.xacro")


TETRAHEDRON = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.mark.parametrize("variable", ["AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH", ""])
def test_meshes_of_packages_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variable: str) -> None:
    share = {"AMENT_PREFIX_PATH": "ros/share", "ROS_PACKAGE_PATH": "ros", "": ""}[variable]
    mesh = tmp_path / share / "gantry_description" / "meshes" / "carriage.obj"
    mesh.parent.mkdir(parents=True)
    mesh.write_text(TETRAHEDRON, encoding="utf-8")
    if variable:
        monkeypatch.setenv(variable, str(tmp_path / "ros"))
    text = re.sub(r"visual>", "collision>", strangers.GANTRY)
    folder = tmp_path / "models" / "urdf"
    folder.mkdir(parents=True)
    assert robot(folder, text).joints == ("x", "y", "z", "turn")
