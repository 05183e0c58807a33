"""Distances between the surfaces of elements, measured on demand from recorded states."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.owners import geom_owners, whole_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.simulation import Simulation

MEASURABLE = frozenset(
    int(kind)
    for kind in (
        mujoco.mjtGeom.mjGEOM_SPHERE,
        mujoco.mjtGeom.mjGEOM_CAPSULE,
        mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        mujoco.mjtGeom.mjGEOM_CYLINDER,
        mujoco.mjtGeom.mjGEOM_BOX,
        mujoco.mjtGeom.mjGEOM_MESH,
    )
)
"""The convex shapes. A mesh is measured as its convex hull, like in contacts, so its gap is never too wide."""
FAR = 1e3
"""No two elements are farther apart than this (m)."""


class GapSampler:
    """Measures the distance of the surfaces of two elements at samples of the recording.

    It measures the surfaces that take part in contacts. An element without such surfaces, or with one that is not
    convex, has no measurements.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._gaps: dict[tuple[str, str], dict[int, float]] = {}
        self._posed: FloatArray | None = None

    @cached_property
    def _data(self) -> Any:
        return mujoco.MjData(self._simulation.model)

    @cached_property
    def _geoms(self) -> Mapping[str, NDArray[np.intp]]:
        """The geoms of each element that can be measured."""
        model, objects = self._simulation.model, self._simulation.world.cast.objects
        owners = np.array([whole_of(one, objects) for one in geom_owners(model, self._simulation.robots)])
        solid = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
        found: dict[str, NDArray[np.intp]] = {}
        for name in (*objects, *self._simulation.robots):
            geoms = np.flatnonzero((owners == name) & solid)
            if geoms.size and MEASURABLE.issuperset(model.geom_type[geoms].tolist()):
                found[name] = geoms
        return found

    def sample(self, one: str, other: str, rows: range) -> None:
        """Measure at these samples of the trace. A workspace means each object that carries it."""
        for pair in self._pairs(one, other):
            known = self._gaps.setdefault(pair, {})
            for row in rows:
                if row not in known:
                    known[row] = self._gap(pair, self._simulation.recorder.states[row])

    def record(self, size: int) -> Mapping[tuple[str, str], FloatArray]:
        """Return the measured gaps (m) as arrays over the first ``size`` samples, NaN where not measured."""
        found: dict[tuple[str, str], FloatArray] = {}
        for pair, gaps in self._gaps.items():
            values = np.full(size, nan)
            values[list(gaps)] = list(gaps.values())
            found[pair] = values
        return found

    def _pairs(self, one: str, other: str) -> list[tuple[str, str]]:
        regions = self._simulation.world.cast.regions
        ones, others = ([carrier for carrier, _ in regions.get(name, ((name, None),))] for name in (one, other))
        pairs = {tuple(sorted((a, b))) for a in ones for b in others if a != b}
        return [(a, b) for a, b in sorted(pairs) if a in self._geoms and b in self._geoms]

    def _gap(self, pair: tuple[str, str], state: FloatArray) -> float:
        """Return the smallest distance over all pairs of geoms; pairs that cannot be the nearest are not measured."""
        model, data = self._simulation.model, self._data
        if self._posed is None or not np.array_equal(self._posed, state):
            data.qpos[:] = self._posed = state.copy()
            mujoco.mj_kinematics(model, data)
        ones, others = self._geoms[pair[0]], self._geoms[pair[1]]
        between = np.linalg.norm(data.geom_xpos[ones][:, None] - data.geom_xpos[others][None], axis=2)
        bounds = between - model.geom_rbound[ones][:, None] - model.geom_rbound[others][None]
        nearest = FAR
        for index in np.argsort(bounds, axis=None, kind="stable"):
            row, column = divmod(int(index), len(others))
            if bounds[row, column] >= nearest:
                break
            found = mujoco.mj_geomDistance(model, data, int(ones[row]), int(others[column]), max(nearest, 0.0), None)
            nearest = min(nearest, float(found))
        return nearest
