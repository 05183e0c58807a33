"""Find where a mobile base has room: check the whole robot for collisions with its base at other places."""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.object_settings import can_move
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.owners import geom_owners

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.robot import Robot
    from robbdd_tools.world.simulation import Simulation

SCAN = 0.20
"""A loose thing is seen if it reaches this height (m) above the floor: usual scanners look in this plane."""
GROUND = 0.02
"""Contacts below this height (m) above the base's lowest point are ignored: they are with the floor or things in it."""


class BaseSpace:
    """Collision checks of a robot in its present posture, with the object in its gripper, for other poses of its base.

    Everything is where the robot saw it at construction. Loose things that are lower than ``SCAN`` are not seen.
    """

    def __init__(self, simulation: Simulation, robot: Robot, held: str | None, room: float) -> None:
        """Demand a distance of ``room`` (m) from everything."""
        assert robot.mobile is not None, "only mobile bases drive"
        self._model: Any = copy(simulation.model)
        self._data: Any = mujoco.MjData(self._model)
        self._state: FloatArray = simulation.state
        self._mobile = robot.mobile
        self._owners = geom_owners(self._model, simulation.robots)
        self._moving = np.array([owner in (robot.name, held) for owner in self._owners])
        self._model.geom_margin[self._moving] = room
        self._held = None if held is None else int(self._model.jnt_qposadr[self._model.body(held).jntadr[0]])
        self._start = self._mobile.pose_at(self._state[self._mobile.joints])
        self._place(self._start)
        lows = self._lows()
        self._floor = float(lows[self._moving & (self._model.geom_contype > 0)].min()) + GROUND
        self._unseen = np.array([owner in self._low_things(simulation, lows) for owner in self._owners])
        self.touched: dict[str, None] = {}
        """Names of the elements that have been in the way so far."""

    @property
    def start(self) -> FloatArray:
        """The pose of the base at construction, (x m, y m, yaw rad)."""
        return self._start

    def bounds(self, room: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the lowest and the highest x and y (m) of everything, with some room around."""
        finite = self._model.geom_rbound > 0.0
        spread = self._model.geom_rbound[finite, None]
        places = self._data.geom_xpos[finite, :2]
        low, high = (places - spread).min(axis=0) - room, (places + spread).max(axis=0) + room
        return (float(low[0]), float(low[1])), (float(high[0]), float(high[1]))

    def is_free(self, pose: FloatArray) -> bool:
        """Return whether the robot touches nothing when its base is at a pose (x m, y m, yaw rad)."""
        self._place(pose)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        pairs = self._data.contact.geom
        if not len(pairs):
            return True
        hits = (self._moving[pairs[:, 0]] != self._moving[pairs[:, 1]]) & ~self._unseen[pairs].any(axis=1)
        hits &= self._data.contact.pos[:, 2] > self._floor
        if not hits.any():
            return True
        for first, second in pairs[hits].tolist():
            self.touched[self._owners[second if self._moving[first] else first]] = None
        return False

    def _place(self, pose: FloatArray) -> None:
        """Move the base to a pose, and the object in the gripper with it."""
        self._data.qpos[:] = self._state
        self._data.qpos[self._mobile.joints] = self._mobile.positions_at(pose)
        if self._held is not None:
            turn = pose[2] - self._start[2]
            c, s = np.cos(turn), np.sin(turn)
            here = slice(self._held, self._held + 3)
            x, y = self._state[here][:2] - self._start[:2]
            self._data.qpos[here][:2] = [pose[0] + c * x - s * y, pose[1] + s * x + c * y]
            around = np.array([np.cos(turn / 2), 0.0, 0.0, np.sin(turn / 2)])
            old = self._state[self._held + 3 : self._held + 7]
            mujoco.mju_mulQuat(self._data.qpos[self._held + 3 : self._held + 7], around, old)
        mujoco.mj_kinematics(self._model, self._data)

    def _lows(self) -> FloatArray:
        """Return the lowest point (m) of each geom."""
        middle, half = self._model.geom_aabb[:, :3], self._model.geom_aabb[:, 3:]
        upwards = self._data.geom_xmat.reshape(-1, 3, 3)[:, 2]
        return self._data.geom_xpos[:, 2] + (upwards * middle).sum(axis=1) - (np.abs(upwards) * half).sum(axis=1)

    def _low_things(self, simulation: Simulation, lows: FloatArray) -> set[str]:
        """Return the loose objects that do not reach the height of the scanner above the floor."""
        half = self._model.geom_aabb[:, 3:]
        upwards = self._data.geom_xmat.reshape(-1, 3, 3)[:, 2]
        tops = lows + 2 * (np.abs(upwards) * half).sum(axis=1)
        loose = {name for name, model in simulation.world.cast.objects.items() if can_move(model)}
        high = {owner for owner, top in zip(self._owners, tops, strict=True) if top >= self._floor + SCAN}
        return loose - high
