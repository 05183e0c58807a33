"""How the fingers of a gripper move with its control value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import RobotModel


@dataclass(frozen=True, slots=True)
class FingerMotion:
    """The motion of two fingers. By default, as in the catalog, the control value is the position (m) of each finger.

    - ``rate``: change of the control value per metre that a finger moves.
    - ``settling``: how long (s) the fingers take to arrive after a jump of the control value; 0 if unknown.
    - ``open_joints``: positions of the gripper's joints when it is open. If it is empty, these are the joints of the
      pads, at the control value of the open gripper.
    - ``faces``: the geoms of each gripping face; empty if each pad is one.
    - ``sweep``: pairs, from open to closed: the distance (m) of the faces, and how far (m) the fingers then reach
      beyond the tool; empty if the fingers slide.
    - ``one_sided``: whether only one jaw moves, along the tool's y axis: the tool is at the surface of the other one.
    - ``narrowest``: distance (m) of the faces when the gripper is closed; 0 if they meet.
    - ``lever``: change of the actuator's length (m, rad) per metre that a finger moves, on average.
    """

    rate: float = 1.0
    settling: float = 0.0
    open_joints: tuple[tuple[str, float], ...] = ()
    faces: tuple[tuple[str, ...], ...] = ()
    sweep: tuple[tuple[float, float], ...] = ()
    one_sided: bool = False
    narrowest: float = 0.0
    lever: float = 1.0

    def reach(self, width: float) -> float:
        """Return how far (m) the fingers reach beyond the tool at most until they have closed to a width (m)."""
        return max((beyond for gap, beyond in self.sweep if gap >= width), default=0.0)


_PLAIN = FingerMotion()
_measured: dict[str, FingerMotion] = {}


def set_finger_motion(mjcf: str, motion: FingerMotion) -> None:
    """Record the motion that was measured for the arm with this ``RobotModel.mjcf``."""
    _measured[mjcf] = motion


def finger_motion(robot: RobotModel) -> FingerMotion:
    """Return the motion of a robot's fingers."""
    return _measured.get(robot.mjcf, _PLAIN)
