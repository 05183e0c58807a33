"""What drives of an arm from a file bear, and where its shapes act."""

from __future__ import annotations

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


def test_a_drive_that_cannot_hold_the_arm_is_refused(tmp_path: Path) -> None:
    weak = MJCF.replace(ELBOW, SERVO.replace("40", ".1"))
    words = (
        r"the drive of 'elbow' bears 0.1 N m, but at home the arm's own weight needs [\d.]+ N m: correct the limit or"
    )
    with pytest.raises(SceneError, match=words):
        robot(tmp_path, weak, ArmModel(actuator="grip"))
