"""The largest force of a gripper: that of each finger, or the pull of a cup (``grip_force``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.catalog.api import GripperKind
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.finger_motion import finger_motion

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import RobotModel


def limit_grip(spec: Any, name: str, robot: RobotModel, force: float) -> None:
    """Set the force (N) of each finger, or of the vacuum, of an agent. Raises ``SceneError``."""
    actuator = spec.actuator(f"{name}/{robot.gripper_actuator}")
    if robot.gripper is GripperKind.SUCTION:
        actuator.gainprm[0] = force
        return
    share = _share(actuator.biasprm, robot)
    if share is None:
        raise SceneError(f"'{name}' has no grip_force: no position servo closes its gripper")
    actuator.forcerange, actuator.forcelimited = [-force / share, force / share], True


def grip_force(model: Any, name: str, robot: RobotModel) -> float | None:
    """Return the force (N) of each finger, or of the vacuum, in a compiled model; ``None`` if it is not known.

    For fingers with levers, it is a mean over their way, since their force depends on their posture.
    """
    actuator = model.actuator(f"{name}/{robot.gripper_actuator}")
    if robot.gripper is GripperKind.SUCTION:
        return float(actuator.gainprm[0])
    share = _share(actuator.biasprm, robot)
    if share is None or not model.actuator_forcelimited[actuator.id]:
        return None
    return float(actuator.forcerange[1]) * share


def slip_force(model: Any, name: str, robot: RobotModel, part: str) -> float | None:
    """Return the force (N) at which a part slips out of two fingers, 2 μ N; ``None`` for a cup or an unknown grip."""
    force = None if robot.gripper is GripperKind.SUCTION else grip_force(model, name, robot)
    faces = {int(model.geom(f"{name}/{pad}").id) for pad in robot.pads}
    body = model.body(part)
    shapes = range(int(body.geomadr[0]), int(body.geomadr[0] + body.geomnum[0]))
    pairs = zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), model.pair_friction[:, 0].tolist(), strict=True)
    rough = [mu for one, other, mu in pairs if {one, other} & faces and (one in shapes or other in shapes)]
    return None if force is None or not rough else 2.0 * min(rough) * force


def _share(bias: Any, robot: RobotModel) -> float | None:
    """Return the force of each finger as a share of the force of a position servo, by the principle of virtual work.

    Actuators of other kinds have none: their force does not grow to its limit when the fingers meet a part.
    """
    motion = finger_motion(robot)
    return None if bias[1] >= 0.0 else motion.lever / (1 if motion.one_sided else 2)
