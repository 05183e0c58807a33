"""``robbdd view --robot``: what was found in the file of an arm, how to state it, and a picture."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.show_robot import NAME, source_of
from robbdd_tools.cli import main
from robbdd_tools.world.finger_motion import finger_motion
from robbdd_tools.world.robot_files import robot_from
from robbdd_tools.world.robot_report import as_stated, stated
from world import strangers
from world.arms import MJCF, URDF
from world.hollow import write_tote
from world.test_mounted_gripper import BARE, FINGERS, GRIPPER


def write(folder: Path, text: str) -> Path:
    path = folder / ("arm.urdf" if text.startswith("<robot") else "arm.xml")
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.physics
def test_it_says_what_was_found_and_writes_a_picture_or_what_to_install(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, target = write(tmp_path, strangers.GANTRY), tmp_path / "arm.png"
    code = main(["view", "--robot", str(path), "-o", str(target)])
    said = capsys.readouterr()
    if code == 0:
        assert target.read_bytes().startswith(b"\x89PNG")
    else:
        assert "install EGL (libegl1 and libgl1) or OSMesa (libosmesa6)" in said.err
    for line in (
        "an arm of 4 joints with two fingers, ",
        "  turn   rotating  none in the file: one turn  2.5 rad/s      ",
        "home: found by a search: the tool points down, the arm reaches far",
        "gripper: actuator 'grip', open at 0.04, closed at 0, 80 mm wide",
        "gripping faces: a shape of 'thumb' | a shape of 'finger', friction 0.9",
        "        velocity: (0.8, 0.8, 0.5, 2.5) rad/s   // sliding joints in m/s",
    ):
        assert line in said.out


def test_without_graphics_the_report_is_printed_all_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "nonsense")
    key = '<keyframe><key name="ready" qpos="0 .2 1.6 1.3416 0 .04 .04"/></keyframe></mujoco>'
    path = write(tmp_path, MJCF.replace("</mujoco>", key))
    assert main(["view", "--robot", str(path), "-o", str(tmp_path / "arm.png")]) == 2
    said = capsys.readouterr()
    assert "home: key frame 'ready' of the file" in said.out
    assert "1 rad/s (assumed)" in said.out
    assert "nothing here can render without a display: install EGL" in said.err
    assert not (tmp_path / "arm.png").exists()


def test_it_counts_the_fingers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["view", "--robot", str(write(tmp_path, strangers.THUMB)), "-o", str(tmp_path / "arm.png")])
    assert "an arm of 4 joints with three fingers, " in capsys.readouterr().out


def test_an_inertia_that_no_body_can_have_is_named_and_does_not_stop_the_arm(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = re.sub(r'(<link name="carriage">.*?)izz="0.01"', r'\1izz="0.03"', strangers.GANTRY)
    path = write(tmp_path, wrong)
    main(["view", "--robot", str(path), "-o", str(tmp_path / "arm.png")])
    said = capsys.readouterr().out
    assert "an arm of 4 joints with two fingers, " in said
    assert "replaced by the mean of their principal moments: carriage\n" in said
    write(tmp_path, strangers.GANTRY)
    main(["view", "--robot", str(path), "-o", str(tmp_path / "arm.png")])
    assert "principal moments" not in capsys.readouterr().out


def test_an_arm_that_cannot_be_used_and_a_missing_file_are_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["view", "--robot", str(write(tmp_path, strangers.CUP_ONLY)), "-o", str(tmp_path / "arm.png")]) == 2
    assert "has no gripper: beyond the body 'b6'" in capsys.readouterr().err
    assert main(["view", "--robot", "nothing-like-it"]) == 2
    assert "there is no model file" in capsys.readouterr().err
    assert main(["view"]) == 2
    assert capsys.readouterr().err == "robbdd: name a model (FILE) or an arm (--robot ARM)\n"


def test_an_arm_of_the_catalog_is_shown_by_its_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["view", "--robot", "ur10", "-o", str(tmp_path / "arm.png")])
    said = capsys.readouterr().out
    assert "an arm of 6 joints with a suction cup" in said
    assert "home: of the catalog" in said
    assert "scenex" not in said


@pytest.mark.parametrize("text", [strangers.SCARA, strangers.SIX, strangers.VACUUM, strangers.GANTRY, MJCF])
def test_an_arm_as_it_is_stated_is_the_same_arm(tmp_path: Path, text: str) -> None:
    source = source_of(str(write(tmp_path, text)))
    found = robot_from(source, NAME)
    again = robot_from(replace(source, iri="view:again", arm=as_stated(found, NAME, source)), NAME)
    assert replace(again, mjcf=found.mjcf) == found
    one, other = (dict(finger_motion(robot).open_joints) for robot in (found, again))
    assert one == pytest.approx(other, abs=1e-3)


@pytest.mark.parametrize(("text", "has_gripper"), [(strangers.SCARA, False), (strangers.SIX, True)])
def test_a_gripper_that_several_actuators_close_is_not_stated(tmp_path: Path, text: str, has_gripper: bool) -> None:
    source = source_of(str(write(tmp_path, text)))
    lines = list(stated(as_stated(robot_from(source, NAME), NAME, source), source, joints_slide=False))
    assert ("    gripper {" in lines) is has_gripper
    assert lines[0] == "model arm_model as mjcf {"


def test_an_arm_is_shown_with_a_gripper_from_another_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arm, gripper = write(tmp_path, BARE), tmp_path / "fingers.xml"
    gripper.write_text(GRIPPER, encoding="utf-8")
    command = ["view", "--robot", str(arm), "-o", str(tmp_path / "arm.png"), "--gripper", str(gripper)]
    main([*command, "--on", "flange"])
    said = capsys.readouterr().out
    assert f"gripper from {gripper}, fixed to 'flange'" in said
    assert "gripper: actuator 'roll_servo', open at 0.04, closed at -0.002, 80 mm wide" in said
    assert "gripping faces: left_pad | right_pad" in said
    block = said[said.index("        gripper {") : said.index("        home:")]
    assert [line.strip() for line in block.splitlines()] == [
        "gripper {",
        f"sys path = '{gripper}'",
        'on: "flange"',
        'actuator: "roll_servo"',
        "open: 0.04",
        "close: -0.002",
        'pads: "left_pad", "right_pad"',
        "stroke: 80 mm",
        "}",
    ]
    assert main([*command, "--on", "flang"]) == 2
    assert "arm.xml has no site or body 'flang' for the gripper" in capsys.readouterr().err
    assert main(command) == 2
    assert "a gripper needs both --gripper FILE and --on NAME" in capsys.readouterr().err
    assert main(["view", str(tmp_path / "cell.bdd"), "--on", "flange"]) == 2
    assert "--gripper and --on need an arm: --robot ARM" in capsys.readouterr().err


def test_remarks_on_the_file_of_a_gripper_are_those_on_an_arm(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arm, gripper = write(tmp_path, BARE), tmp_path / "fingers.urdf"
    gripper.write_text(FINGERS.replace('ixx="0.01"', 'ixx="0.1"', 1), encoding="utf-8")
    main(["view", "--robot", str(arm), "-o", str(tmp_path / "a.png"), "--gripper", str(gripper), "--on", "flange"])
    said = capsys.readouterr().out
    assert "inertias that no body can have, replaced by the mean of their principal moments: hand" in said


def test_links_that_collide_as_they_look_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    link = '<geom type="capsule" size=".04" fromto="0 0 0 .45 0 0" mass="2"/>'
    seen = strangers.SCARA.replace(link, link.replace("/>", ' contype="0" conaffinity="0"/>'))
    main(["view", "--robot", str(write(tmp_path, seen)), "-o", str(tmp_path / "arm.png")])
    assert "links without collision shapes, which collide as their visual shapes: arm1\n" in capsys.readouterr().out
    main(["view", "--robot", str(write(tmp_path, strangers.SCARA)), "-o", str(tmp_path / "arm.png")])
    assert "collide as" not in capsys.readouterr().out


def test_the_range_of_a_velocity_servo_is_the_speed_of_its_joint(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    servo = '<velocity joint="rot" kv="5" gear="2" ctrlrange="-3 4"/>'
    arm = strangers.SCARA.replace('<velocity joint="rot" kv="5"/>', servo)
    main(["view", "--robot", str(write(tmp_path, arm)), "-o", str(tmp_path / "arm.png")])
    said = capsys.readouterr().out
    assert "        velocity: (1, 1, 1, 1.5) rad/s" in said
    assert re.search(r"  rot +rotating .* 1\.5 rad/s +", said)
    assert said.count("(assumed)") == 3


def test_it_lists_hollow_meshes_and_how_far_closed_faces_stay_apart(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_tote(tmp_path / "tote.obj")
    finger = '<geometry><box size="0.018 0.008 0.03"/></geometry>'
    hollow = '<geometry><mesh filename="tote.obj" scale="0.1 0.04 0.1"/></geometry>'
    path = write(tmp_path, URDF.replace(finger, hollow).replace('lower="0.0"', 'lower="0.006"'))
    main(["view", "--robot", str(path), "-o", str(tmp_path / "arm.png")])
    said = capsys.readouterr().out
    assert "hollow meshes, each of which collides as its convex hull: tote.obj (4.1 times its volume)" in said
    assert "closed gripper: its faces stay 12 mm apart" in said
