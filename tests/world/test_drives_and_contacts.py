"""What drives of an arm from a file bear, and where its shapes act."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import pytest

from robbdd_tools.catalog.executable import ArmModel
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.robot_files import prepared_robot
from world.arms import MJCF
from world.arms_from_files import robot

ELBOW = '<position name="elbow_servo" joint="elbow" kp="2000" kv="100"/>'
SERVO = ELBOW.replace("/>", ' forcerange="-40 40"/>')
MOTOR = '<motor name="elbow_servo" joint="elbow" gear="2" ctrlrange="-20 20"/>'
UNEQUAL = {
    "servo": ELBOW.replace("/>", ' forcerange="-30 40"/>'),
    "motor": MOTOR.replace("-20", "-15"),
    "motor the other way round": '<motor name="elbow_servo" joint="elbow" gear="-2" ctrlrange="-20 15"/>',
    "motor with less force": MOTOR.replace("-20 20", "-90 90").replace("/>", ' forcerange="-15 20"/>'),
    "motor with more force": MOTOR.replace("-20", "-15").replace("/>", ' forcerange="-90 90"/>'),
    "motor whose controls are not limited": MOTOR.replace("/>", ' ctrllimited="false" forcerange="-15 20"/>'),
}


def test_shapes_of_an_arm_act_only_where_they_touch(tmp_path: Path) -> None:
    text = MJCF.replace("<geom ", '<geom margin="0.02" gap="0.05" ', 2)
    assert text != MJCF
    own = robot(tmp_path, text, ArmModel(actuator="grip"))
    spec = prepared_robot(own.mjcf)
    assert spec is not None
    assert not any(one.margin or one.gap for one in spec.geoms)
    assert "margins of 8 contacts, removed: they would act at a distance" in changes_of(own.mjcf)


@pytest.mark.parametrize("drive", [SERVO, MOTOR], ids=["servo", "motor"])
def test_a_drive_bears_the_weight_of_the_arm_within_its_limit(tmp_path: Path, drive: str) -> None:
    assert ELBOW in MJCF
    own = robot(tmp_path, MJCF.replace(ELBOW, drive), ArmModel(actuator="grip"))
    spec = prepared_robot(own.mjcf)
    assert spec is not None
    model = spec.copy().compile()
    joint = model.joint("elbow")
    assert model.jnt_actgravcomp[joint.id]
    assert model.jnt_actfrcrange[joint.id].tolist() == [-40.0, 40.0]
    assert own.torque_limits[own.joints.index("elbow")] == 40.0


@pytest.mark.parametrize("drive", UNEQUAL.values(), ids=UNEQUAL)
def test_a_drive_is_as_strong_in_each_direction_as_its_file_says(tmp_path: Path, drive: str) -> None:
    spec = prepared_robot(robot(tmp_path, MJCF.replace(ELBOW, drive), ArmModel(actuator="grip")).mjcf)
    assert spec is not None
    model = spec.copy().compile()
    joint = model.joint("elbow").id
    assert model.jnt_actfrcrange[joint].tolist() == [-30.0, 40.0]
    (number,) = (index for index in range(model.nu) if model.actuator_trnid[index, 0] == joint)
    assert model.actuator_forcerange[number].tolist() == [-30.0, 40.0]


@pytest.mark.parametrize(("forces", "holds"), [("-40 .1", True), ("-.1 40", False)])
def test_a_drive_holds_the_arm_by_its_force_in_the_right_direction(tmp_path: Path, forces: str, holds: bool) -> None:
    """The elbow needs a negative torque."""
    drive = ELBOW.replace("/>", f' forcerange="{forces}"/>')
    refused = pytest.raises(SceneError, match=r"the drive of 'elbow' bears 0\.1 N m, but at home")
    with nullcontext() if holds else refused:
        robot(tmp_path, MJCF.replace(ELBOW, drive), ArmModel(actuator="grip"))


def test_a_drive_that_cannot_hold_the_arm_is_refused(tmp_path: Path) -> None:
    weak = MJCF.replace(ELBOW, SERVO.replace("40", ".1"))
    words = (
        r"the drive of 'elbow' bears 0.1 N m, but at home the arm's own weight needs [\d.]+ N m: correct the limit or"
    )
    with pytest.raises(SceneError, match=words):
        robot(tmp_path, weak, ArmModel(actuator="grip"))
