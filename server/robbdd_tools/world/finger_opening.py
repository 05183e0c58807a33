"""The opening of fingers where they grip: fingers that rotate apart are close together at their roots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.gripper_faces import extent, gap

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.catalog.api import FloatArray

BAND = 0.035
"""The opening counts from this distance (m) to the finger tips: the tool is 15 mm deep, and objects reach above it."""
LEVELS = 8
"""Number of levels in this band at which the opening is measured."""
SKEW = 0.003
"""Faces whose opening in the band differs from their smallest distance by more than this (m) are not parallel."""
_PROBE = "robbdd-probe"


class Opening:
    """Measures the opening of two gripping faces along a middle axis, with a probe in a model of its own."""

    def __init__(self, spec: Any, faces: Sequence[Sequence[str]], middle: FloatArray, ahead: FloatArray) -> None:
        """``middle`` (m) is a point between the closed faces, ``ahead`` the direction out of the hand, in the world."""
        probed = spec.copy()
        probe = probed.worldbody.add_geom(name=_PROBE, type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[1e-5, 0.0, 0.0])
        probe.contype = probe.conaffinity = 0
        self._model: Any = probed.compile()
        self._data: Any = mujoco.MjData(self._model)
        self._faces = faces[:2]
        self._middle, self._ahead = middle, ahead

    def at(self, state: FloatArray) -> float:
        """Return the opening (m) near the tips at joint positions ``state``; for parallel faces, their distance."""
        model, data = self._model, self._data
        distance = gap(model, state, self._faces)
        data.qpos[:] = state
        mujoco.mj_kinematics(model, data)
        reached = [[extent(model, data, name, self._ahead) for name in face] for face in self._faces]
        top = min(max(high for _, high in face) for face in reached)
        bottom = max(top - BAND, *(min(low for low, _ in face) for face in reached))
        found = min((self._across(level) for level in np.linspace(bottom, top, LEVELS)), default=distance)
        return found if found > distance + SKEW else distance

    def to_second(self, state: FloatArray) -> float:
        """Return the distance (m) of the second face from the middle point at joint positions ``state``, signed."""
        self._data.qpos[:] = state
        mujoco.mj_kinematics(self._model, self._data)
        probe = self._model.geom(_PROBE).id
        self._data.geom_xpos[probe] = self._middle
        return min(self._distance(probe, self._model.geom(name).id) for name in self._faces[1])

    def _across(self, level: float) -> float:
        """Return the distance (m) between the faces at a level (m) along the direction out of the hand."""
        probe = self._model.geom(_PROBE).id
        self._data.geom_xpos[probe] = self._middle + (level - self._middle @ self._ahead) * self._ahead
        return sum(
            max(0.0, min(self._distance(probe, self._model.geom(name).id) for name in face)) for face in self._faces
        )

    def _distance(self, one: int, other: int) -> float:
        return float(mujoco.mj_geomDistance(self._model, self._data, one, other, 1.0, None))
