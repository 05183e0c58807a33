"""The largest force of a gripper: that of each finger, or the pull of a cup (``grip_force``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.robot_files import prepared_robot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import RobotModel


def has_known_force(robot: RobotModel) -> bool:
    """Return whether the force of each finger follows from the gripper's actuator, as in the catalog's arms.

    The fingers of a file may have levers, so their force depends on their posture.
    """
    return prepared_robot(robot.mjcf) is None


def limit_grip(spec: Any, name: str, robot: RobotModel, force: float) -> None:
    """Set the force (N) of each finger, or of the vacuum, of an agent. Raises ``SceneError``."""
    if not has_known_force(robot):
        raise SceneError(f"'{name}' has no grip_force: only the force of the catalog's grippers is known")
    actuator = spec.actuator(f"{name}/{robot.gripper_actuator}")
    if robot.gripper is GripperKind.SUCTION:
        actuator.gainprm[0] = force
    else:
        total = force * len(robot.pads)
        actuator.forcerange = [-total, total]


def grip_force(model: Any, name: str, robot: RobotModel) -> float:
    """Return the force (N) of each finger, or of the vacuum, in a compiled model."""
    actuator = model.actuator(f"{name}/{robot.gripper_actuator}")
    if robot.gripper is GripperKind.SUCTION:
        return float(actuator.gainprm[0])
    return float(actuator.forcerange[1]) / len(robot.pads)
