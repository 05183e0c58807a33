"""Grippers in files that others model: actuators, gripping faces, stroke, friction and suction cups."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.catalog.executable import (
    ArmModel,
    Friction,
    Realisation,
    SceneInstance,
)
from robbdd_tools.protocol.specs import ConfigSpec
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.robot_files import prepared_robot
from robbdd_tools.world.staging import Staging
from world import strangers
from world.arms import MJCF, SHEARS, URDF
from world.arms_from_files import ARM, picking, robot, source
from world.worlds import CUBE, SCENE


def test_fingers_that_do_not_come_to_rest_are_named(tmp_path: Path) -> None:
    light = URDF.replace('<mass value="0.05"/>', '<mass value="0.001"/>')
    with pytest.raises(SceneError, match=r"name its pads\. It does not come to rest within 10 s: check the masses"):
        robot(tmp_path, light)


def test_the_fingers_of_two_actuators_are_one_gripper(tmp_path: Path) -> None:
    found = robot(tmp_path, strangers.SCARA)
    assert found.joints == ("a1", "a2", "z", "rot")
    assert (found.gripper_actuator, found.gripper_open, found.gripper_closed) == ("ga", 0.035, 0.0)
    assert found.stroke == pytest.approx(0.07, abs=1e-3)
    assert dict(finger_motion(found).open_joints) == pytest.approx({"ja": 0.035, "jb": -0.035}, abs=1e-3)


@pytest.mark.parametrize("turn", ["180 0 0", "0 180 30"])
def test_a_cup_points_out_of_the_arm_whichever_way_its_frame_points(tmp_path: Path, turn: str) -> None:
    usual = arm_of(robot(tmp_path, strangers.VACUUM, name="usual.xml"))
    text = strangers.VACUUM.replace(
        '<body name="cup" pos="0 0 .06">', f'<body name="cup" pos="0 0 .06" euler="{turn}">'
    )
    turned = arm_of(robot(tmp_path, text, name="turned.xml"))
    place, axes = turned.forward(usual.home)
    assert place == pytest.approx(usual.forward(usual.home)[0], abs=1e-6)
    assert axes[:, 2] == pytest.approx(usual.forward(usual.home)[1][:, 2], abs=1e-6)


@pytest.mark.parametrize(
    ("extra", "goes"),
    [
        ('<adhesion name="x" body="left" ctrlrange="1 2" gain="50"/>', True),
        ('<adhesion name="x" body="left" ctrlrange="0 1" gain="50"/>', True),
        ('<motor name="x" joint="left_slide" ctrlrange="-9 -5"/>', True),
        ('<general name="x" joint="left_slide" biastype="affine" biasprm="-9 0 0"/>', True),
        ('<motor name="x" joint="left_slide" ctrlrange="-9 9"/>', False),
        ('<position name="x" joint="right_slide" kp="10" ctrlrange="0.01 0.02"/>', False),
    ],
)
def test_actuators_that_act_although_nothing_commands_them_are_removed(tmp_path: Path, extra: str, goes: bool) -> None:
    """The engine clamps an idle control into its range, so such pads would always stick to what they touch."""
    own = robot(tmp_path, MJCF.replace("</actuator>", f"{extra}</actuator>"), ArmModel(actuator="grip"))
    spec = prepared_robot(own.mjcf)
    assert spec is not None
    kept = {one.name for one in spec.actuators}
    assert kept - {"x"} == {*(f"{joint}_servo" for joint in ("yaw", "shoulder", "elbow", "pitch", "roll")), "grip"}
    assert ("x" not in kept) is goes
    assert ("actuators that act although nothing commands them, removed: x" in changes_of(own.mjcf)) is goes


@pytest.mark.physics
def test_glue_on_pads_does_not_carry_what_friction_cannot(tmp_path: Path) -> None:
    glue = "".join(f'<adhesion body="{pad}" ctrlrange="1 2" gain="50"/>' for pad in ("left", "right"))
    slippery = (ConfigSpec(CUBE, "mass", "0.5"), ConfigSpec(CUBE, "friction", "0.1"))
    scene = replace(SCENE, agents=(ARM,), config=slippery)
    text = MJCF.replace("</actuator>", f"{glue}</actuator>")
    run = picking(tmp_path, text, ArmModel(actuator="grip"), scene)
    assert not run.run_behaviour(0)
    assert "gripper lost" in run.trace.remark or "gripper missed" in run.trace.remark


def test_a_gripper_that_opens_at_zero_and_closes_at_255_is_understood(tmp_path: Path) -> None:
    found = robot(tmp_path, strangers.SIX)
    assert (found.gripper_open, found.gripper_closed, found.pads) == (0.0, 255.0, ("lpad", "rpad"))
    assert finger_motion(found).rate == pytest.approx(255 / (found.stroke / 2), rel=0.01)


def test_fingers_whose_ranges_begin_at_zero_and_differ_close_on_each_other(tmp_path: Path) -> None:
    text = re.sub(r'ctrlrange="(0 .035|-.035 0)"', 'ctrlrange="-1 1"', strangers.SCARA)
    found = robot(tmp_path, text.replace('range="-.035 0"', 'range="-.03 0"'))
    assert sorted(len(face) for face in finger_motion(found).faces) == [1, 1]
    # Limits are soft: the force of both actuators pushes the fingers 6 mm beyond theirs.
    assert found.stroke == pytest.approx(0.066, abs=1e-3)


def apart(closed: float) -> str:
    """Return an arm whose fingers stop ``closed`` (m) from the middle."""
    text = MJCF.replace('range="0 0.04"', f'range="{closed} 0.04"')
    return text.replace('ctrlrange="-0.002 0.04"', f'ctrlrange="{closed} 0.04"')


PADS = ArmModel(pads=("left_pad", "right_pad"))


@pytest.mark.physics
def test_a_gripper_whose_faces_stay_apart_holds_what_is_wider(tmp_path: Path) -> None:
    run = picking(tmp_path, apart(0.012), PADS)
    assert finger_motion(run.simulation.robots[ARM].model).narrowest == pytest.approx(0.024, abs=1e-4)
    assert run.run_behaviour(0), run.trace.remark


def test_a_gripper_whose_faces_stay_apart_holds_nothing_narrower(tmp_path: Path) -> None:
    run = picking(tmp_path, apart(0.03), PADS)
    assert not run.run_behaviour(0)
    assert re.search(r"cube1 is 0\.\d+ m wide, the gripper closes to 0\.060 m", run.trace.remark), run.trace.remark


def test_a_thumb_closes_on_two_fingers_that_are_one_face(tmp_path: Path) -> None:
    found = robot(tmp_path, strangers.THUMB)
    thumb, beside = finger_motion(found).faces
    spec = prepared_robot(found.mjcf)
    assert spec is not None
    assert [spec.geom(name).parent.name for name in (*thumb, *beside)] == ["fa", "fb1", "fb2"]
    assert (len(thumb), len(beside)) == (1, 2)
    assert found.stroke == pytest.approx(0.07, abs=1e-3)


def test_three_rotating_fingers_around_a_hand_are_two_faces(tmp_path: Path) -> None:
    first, others = finger_motion(robot(tmp_path, strangers.JAWS)).faces
    assert "apad" in first
    assert {"bpad", "cpad"} <= {*others}
    assert not {"bpad", "cpad"} & {*first}


def test_fingers_that_swing_far_ahead_are_opposite(tmp_path: Path) -> None:
    found = robot(tmp_path, strangers.RAIL)
    assert finger_motion(found).faces == (("pad0",), ("pad1", "pad2"))
    assert found.stroke > 0.09


def test_the_roots_of_fingers_do_not_narrow_the_opening(tmp_path: Path) -> None:
    """The roots of the three fingers stay 23 mm apart; at their tips, a cube of 70 mm fits between them."""
    assert robot(tmp_path, strangers.JAWS).stroke > 0.07


def test_fingers_that_rotate_open_like_shears_open_at_their_tips(tmp_path: Path) -> None:
    """Their roots stay 16 mm apart. 37 mm from the roots, which is 35 mm from the tips, the faces are 54 mm apart."""
    expected = 2 * (0.012 * np.cos(0.6) + 0.037 * np.sin(0.6) - 0.004)
    assert robot(tmp_path, SHEARS).stroke == pytest.approx(expected, abs=1e-3)
    with pytest.raises(SceneError, match=r"opens 0\.054 m, not the stated stroke of 0\.016 m"):
        robot(tmp_path, SHEARS, ArmModel(stroke=0.016), "stated.xml")


def test_a_cup_is_found_by_its_vacuum_or_by_the_face_that_is_named(tmp_path: Path) -> None:
    for text, arm in ((strangers.VACUUM, None), (strangers.CUP_ONLY, ArmModel(pads=("cup",), stroke=0.024))):
        found = robot(tmp_path, text, arm)
        assert found.gripper is GripperKind.SUCTION
        assert (found.gripper_open, found.gripper_closed, found.stroke) == (0.0, 1.0, 0.024)


def test_tips_of_rotating_fingers_pass_over_the_table(tmp_path: Path) -> None:
    """On their arcs, the tips reach lower than where they meet."""
    motion = finger_motion(robot(tmp_path, strangers.SIX))
    assert motion.reach(0.0) > motion.reach(0.07) > 0.0
    assert finger_motion(robot(tmp_path, strangers.SCARA, name="sliding.xml")).sweep == (), (
        "sliding fingers reach as far everywhere"
    )


def test_gripping_faces_without_friction_are_a_fault_of_the_model_unless_the_scene_states_it(tmp_path: Path) -> None:
    smooth = strangers.SCARA.replace('friction="1 .01 .001"', 'friction="0 .01 .001"')
    model = source(tmp_path, smooth)
    instance = SceneInstance("x:cell", elements=(Realisation(ARM, (model,)),))
    words = (
        "cell.scenex:3:7: the gripping faces in arm.xml have no friction, so they hold nothing: of two surfaces, the"
    )
    with pytest.raises(SceneError, match=words):
        Staging(instance, 1).robot(ARM)
    stated = replace(instance, frictions=(Friction(CUBE, ARM, 0.6),))
    assert Staging(stated, 1).robot(ARM) is not None
