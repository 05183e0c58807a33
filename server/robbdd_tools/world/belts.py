"""Driven belts.

The engine has no running surfaces. So a belt is a slab that a servo drives at the belt's speed, and whose position is
reset after each control tick: friction depends only on its speed, which continues.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, Vector

STIFFNESS = 5000.0
"""Gain of a belt's speed servo, N s/m: so high that an object that is held back does not slow the belt."""


def add_belt(spec: Any, body: Any, name: str, surface: Vector) -> Any:
    """Add a belt to a body and return it; when driven, it runs at the velocity ``surface`` (m/s, body's frame)."""
    speed = float(np.linalg.norm(surface))
    part = body.add_body(name=name)
    part.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[along / speed for along in surface])
    servo = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    servo.set_to_velocity(kv=STIFFNESS)
    servo.ctrlrange, servo.ctrllimited = [0.0, speed], True
    return part


def belts_of(model: Any, name: str) -> list[int]:
    """Return the servos of an object's belts."""
    names = (str(model.actuator(index).name) for index in range(model.nu))
    return [index for index, servo in enumerate(names) if servo.startswith(f"{name}/belt")]


def belt_speed(model: Any, servo: int) -> float:
    """Return the speed (m/s) at which a belt runs."""
    return float(model.actuator_ctrlrange[servo, 1])


class Belts:
    """The belts of a simulation; they stand still until started."""

    def __init__(self, model: Any, names: list[str]) -> None:
        """Collect the belts of the objects ``names``."""
        servos = [servo for name in names for servo in belts_of(model, name)]
        joints = [int(model.actuator_trnid[servo, 0]) for servo in servos]
        self._servos = np.array(servos, dtype=int)
        self._places = np.array([model.jnt_qposadr[joint] for joint in joints], dtype=int)
        self._rates = np.array([model.jnt_dofadr[joint] for joint in joints], dtype=int)
        self._speeds: FloatArray = np.array([belt_speed(model, servo) for servo in servos])

    def __bool__(self) -> bool:
        return bool(self._servos.size)

    def start(self, data: Any) -> None:
        """Start the belts."""
        data.ctrl[self._servos] = self._speeds
        data.qvel[self._rates] = self._speeds

    def set_back(self, data: Any) -> None:
        """Reset the positions of the belts, not their speeds."""
        data.qpos[self._places] = 0.0
