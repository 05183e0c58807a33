"""Collision checks of arms with the engine's collision detection."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.owners import geom_owners, shape_name

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation


@dataclass(frozen=True, slots=True)
class Hit:
    """The deepest penetration (m) of an arm into anything else, and its owner; 0 and empty without a collision."""

    depth: float
    owner: str


class Clearance:
    """Collision checks of one robot with the world in ``state`` at construction; nothing is stepped."""

    def __init__(
        self,
        simulation: Simulation,
        robot: Robot,
        spare: str,
        state: Any,
        shape: int | None = None,
        control: float | None = None,
    ) -> None:
        """Ignore contacts with the object ``spare``, if any, or with one of its shapes: the arm is going to grip it.

        The gripper is open, or at the value ``control`` of its actuator.
        """
        self._control = control
        self._model: Any = simulation.model
        self._data: Any = simulation.scratch
        self._state: FloatArray = state.qpos.copy()
        self._robot = robot
        self._simulation = simulation
        trees = self._model.body_rootid
        root = trees[self._model.geom_bodyid[robot.pads[0]]]
        self._own = trees[self._model.geom_bodyid] == root
        self._ignored = self._model.geom_bodyid == (self._model.body(spare).id if spare else -1)
        if shape is not None:
            self._ignored &= np.arange(len(self._ignored)) == self._model.geom(shape_name(spare, shape)).id

    def depth(self, joints: FloatArray) -> float:
        """Return the penetration (m) of the arm with open fingers into anything else; 0 without a collision."""
        return self.hit(joints).depth

    def hit(self, joints: FloatArray) -> Hit:
        """Return the deepest collision of the arm with open fingers."""
        self._data.qpos[:] = self._state
        self._data.qpos[self._robot.joints] = joints
        self._robot.coupled.place(self._data.qpos)
        self._simulation.open_fingers(self._robot, self._data, self._control)
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        pairs = self._data.contact.geom
        hits = self._own[pairs].any(axis=1) & ~self._ignored[pairs].any(axis=1)
        distances = np.where(hits, self._data.contact.dist, 0.0)
        if np.min(distances, initial=0.0) >= 0.0:
            return Hit(0.0, "")
        deepest = int(np.argmin(distances))
        return Hit(-float(distances[deepest]), self._owner(pairs[deepest].tolist()))

    def _owner(self, pair: list[int]) -> str:
        owners = geom_owners(self._model, self._simulation.robots)
        other = next((owners[geom] for geom in pair if not self._own[geom]), "")
        return other or "itself"
