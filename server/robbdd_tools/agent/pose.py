"""Where something is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Vector


@dataclass(frozen=True, slots=True)
class Pose:
    """Position (m, world frame) and rotation about the vertical (rad).

    ``rotation`` is the whole rotation as a quaternion, w first, of what does not stand upright.
    """

    position: Vector
    yaw: float = 0.0
    rotation: tuple[float, ...] = ()
