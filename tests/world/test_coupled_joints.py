"""Joints of an arm that follow others, as in a palletizer, are not driven by themselves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.catalog.executable import ArmModel
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.coupled_joints import coupled_by_name
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.robot_files import prepared_robot
from world import strangers
from world.arms import MJCF
from world.arms_from_files import ARM, picking, robot

DRIVEN = ("j1", "j2", "j3", "j4")


def tied(tie: str) -> str:
    """Return the arm of five axes with an equality added."""
    return MJCF.replace("<equality>", f"<equality>{tie}")


def test_only_joints_that_follow_no_other_one_are_driven(tmp_path: Path) -> None:
    found = robot(tmp_path, strangers.PALLETIZER)
    assert found.joints == DRIVEN
    spec = prepared_robot(found.mjcf)
    assert spec is not None
    assert {one.name for one in spec.actuators} == {*(f"{joint}-servo" for joint in DRIVEN), "grip"}
    assert "joints that follow others of the arm: rod2, rod3" in changes_of(found.mjcf)


def test_limits_are_those_at_which_followers_keep_theirs(tmp_path: Path) -> None:
    arm = arm_of(robot(tmp_path, strangers.PALLETIZER))
    assert arm.lower[1:3] == pytest.approx([-0.9, -0.8])
    assert arm.upper[1:3] == pytest.approx([1.1, 1.5])
    assert robot(tmp_path, strangers.PALLETIZER).velocity_limits == (1.5, 1.2, 1.5, 3.0)


def test_the_tool_of_a_palletizer_points_down_in_every_posture(tmp_path: Path) -> None:
    arm = arm_of(robot(tmp_path, strangers.PALLETIZER))
    dice = np.random.default_rng(3)
    for _ in range(20):
        posture = arm.lower + dice.random(4) * (arm.upper - arm.lower)
        place, turn = arm.forward(posture)
        assert turn[2, 2] == pytest.approx(-1.0, abs=1e-6)
        assert arm.forward(arm.solve(posture, place, turn))[0] == pytest.approx(place, abs=1e-4)


def test_the_positions_of_a_chain_of_followers_are_those_of_the_file(tmp_path: Path) -> None:
    text = strangers.PALLETIZER.replace('<mimic joint="j3" multiplier="-1"/>', '<mimic joint="rod2" offset="0.2"/>')
    found = robot(tmp_path, text, ArmModel(home=(0.0, 0.3, 0.7, 0.0)))
    spec = prepared_robot(found.mjcf)
    assert spec is not None
    model = spec.copy().compile()
    positions = np.zeros(model.nq)
    positions[model.joint("j2").qposadr[0]] = 0.5
    coupled_by_name(model, found.joints).place(positions)
    assert positions[model.joint("rod2").qposadr[0]] == pytest.approx(-0.5)
    assert positions[model.joint("rod3").qposadr[0]] == pytest.approx(-0.3)


@pytest.mark.physics
def test_a_palletizer_places_a_part_with_its_tool_vertical(tmp_path: Path) -> None:
    run = picking(tmp_path, strangers.PALLETIZER)
    assert run.run_behaviour(0), run.trace.remark
    model, states = run.simulation.model, run.simulation.recorder.states
    for follower, leader in (("rod2", "j2"), ("rod3", "j3")):
        both = [states[:, int(model.joint(f"{ARM}/{joint}").qposadr[0])] for joint in (follower, leader)]
        assert np.abs(both[0] + both[1]).max() < 0.002
        assert np.ptp(both[1]) > 0.1


@pytest.mark.parametrize(
    ("tie", "words"),
    [
        ('<joint joint1="elbow" joint2="shoulder" polycoef="0 1 .5 0 0"/>', "its joint 'elbow' follows no line"),
        ('<joint joint1="elbow" polycoef=".1 0 0 0 0"/>', "its joint 'elbow' follows no line"),
        ('<joint joint1="elbow" joint2="left_slide"/>', "'elbow' follows 'left_slide', which is not between"),
        (
            '<joint joint1="elbow" joint2="shoulder"/><joint joint1="shoulder" joint2="elbow"/>',
            "its joint 'shoulder' follows itself",
        ),
        ('<connect body1="upper" body2="world" anchor="0 0 0"/>', "its bodies 'upper' and 'world' close a loop"),
    ],
)
def test_ties_that_are_not_followed_are_refused(tmp_path: Path, tie: str, words: str) -> None:
    with pytest.raises(SceneError) as caught:
        robot(tmp_path, tied(tie))
    assert str(caught.value).startswith("cell.scenex:3:7: the arm in arm.xml cannot be simulated, because ")
    assert words in str(caught.value)
    assert "'mimic' (URDF)" in str(caught.value)


def test_a_tendon_that_ties_joints_of_an_arm_is_refused(tmp_path: Path) -> None:
    tendon = '<tendon><fixed name="rod"><joint joint="elbow" coef="1"/><joint joint="pitch" coef="1"/></fixed></tendon>'
    with pytest.raises(SceneError, match="the tendon 'rod' ties its joints"):
        robot(tmp_path, tied('<tendon tendon1="rod"/>').replace("<equality>", f"{tendon}<equality>"))
