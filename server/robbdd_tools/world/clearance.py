"""Collision checks of arms with the engine's collision detection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation


class Clearance:
    """Collision checks of one robot with the world in ``state`` at construction; nothing is stepped."""

    def __init__(self, simulation: Simulation, robot: Robot, spare: str, state: Any) -> None:
        """Ignore contacts with the object ``spare``: it is the one to be gripped."""
        self._model: Any = simulation.model
        self._data: Any = simulation.scratch
        self._state: FloatArray = state.qpos.copy()
        self._robot = robot
        self._simulation = simulation
        trees = self._model.body_rootid
        root = trees[self._model.geom_bodyid[robot.pads[0]]]
        self._own = trees[self._model.geom_bodyid] == root
        self._ignored = self._model.geom_bodyid == self._model.body(spare).id

    def depth(self, joints: FloatArray) -> float:
        """Return the penetration (m) of the arm with open fingers into anything else; 0 without a collision."""
        self._data.qpos[:] = self._state
        self._data.qpos[self._robot.joints] = joints
        self._simulation.open_fingers(self._robot, self._data)
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        pairs = self._data.contact.geom
        hits = self._own[pairs].any(axis=1) & ~self._ignored[pairs].any(axis=1)
        return max(0.0, -float(np.min(self._data.contact.dist[hits], initial=0.0)))
