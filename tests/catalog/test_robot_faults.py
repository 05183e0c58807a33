"""Faults of robots are written as ``NAME`` or ``NAME=SIZE``; wrong ones are refused with the right ones."""

from __future__ import annotations

import pytest

from robbdd_tools.catalog.robot_faults import ROBOT_FAULTS, RobotFaultError, robot_fault


def test_a_fault_has_its_own_size_unless_another_is_given() -> None:
    assert robot_fault("high-release") is ROBOT_FAULTS["high-release"]
    other = robot_fault("high-release=20")
    assert (str(other), other.description) == ("high-release=20", "places to put down are seen 20 mm too high")


def test_every_fault_is_read_as_it_is_written() -> None:
    assert [robot_fault(str(fault)) for fault in ROBOT_FAULTS.values()] == list(ROBOT_FAULTS.values())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("weak-gripp", "there is no fault 'weak-gripp'; the known ones are weak-grip, offset-pose, "),
        ("weak-grip=2", "the size of 'weak-grip' cannot be '2': it must be a number from 0.01 to 0.99"),
        ("offset-pose=wide", "the size of 'offset-pose' cannot be 'wide': it must be a number from 0.1 to 500 mm"),
        ("offset-pose=nan", "the size of 'offset-pose' cannot be 'nan': it must be"),
        ("no-grip=1", "the fault 'no-grip' has no size: omit '=1'"),
    ],
)
def test_wrong_faults_are_refused(text: str, message: str) -> None:
    with pytest.raises(RobotFaultError) as error:
        robot_fault(text)
    assert str(error.value).startswith(message)
