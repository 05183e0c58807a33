"""Contact forces of chosen elements with everything else, measured in every step of the engine."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.contact_forces import Pair, series
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.owners import geom_owners, whole_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


class TouchForces:
    """Forces between each of the watched elements and the elements that it touches.

    A sample has, for each pair, the largest force (N) since the previous sample, summed over the pair's contacts. A
    moving part that the scene does not declare counts as the object that it belongs to. The engine has no contacts
    between sleeping bodies, so these keep the forces of the last step in which one was awake.
    """

    def __init__(self, model: Any, watched: Iterable[str], objects: Iterable[str], robots: Iterable[str]) -> None:
        """Watch the elements ``watched`` among all ``objects`` and ``robots``."""
        self._model = model
        self.watched = tuple(watched)
        self._bodies = {name: int(model.body(name).id) for name in objects}
        self._owners = [whole_of(owner, self._bodies) for owner in geom_owners(model, robots)]
        self._wrench: FloatArray = np.zeros(6)
        self._latest: dict[Pair, float] = {}
        self._rows: defaultdict[Pair, dict[int, float]] = defaultdict(dict)
        self._row = 0

    def restart(self) -> None:
        """Delete all samples. Present contacts also count for the first sample."""
        self._rows.clear()
        self._row = 0
        self._note()

    def measure(self, data: Any) -> None:
        """Measure after one step of the engine."""
        awake = {name for name, body in self._bodies.items() if data.body_awake[body] > 0}
        forces: defaultdict[Pair, float] = defaultdict(float)
        for pair, force in self._latest.items():
            if all(name in self._bodies and name not in awake for name in pair):
                forces[pair] = force
        for pair, force in self._contacts(data).items():
            forces[pair] = force
        self._latest = forces
        self._note()

    def record(self) -> None:
        """Take a sample."""
        self._row += 1

    def peaks(self, size: int) -> Mapping[Pair, FloatArray]:
        """Return the largest force (N) before each of the first ``size`` samples, by pair in contact: (size,)."""
        return series(self._rows, size)

    def _contacts(self, data: Any) -> Mapping[Pair, float]:
        found: defaultdict[Pair, float] = defaultdict(float)
        pairs: list[list[int]] = data.contact.geom.tolist() if data.ncon else []
        for contact, (first, second) in enumerate(pairs):
            one, other = self._owners[first], self._owners[second]
            if one == other or not (one in self.watched or other in self.watched):
                continue
            mujoco.mj_contactForce(self._model, data, contact, self._wrench)
            force = float(np.linalg.norm(self._wrench[:3]))
            for pair in ((one, other), (other, one)):
                if pair[0] in self.watched:
                    found[pair] += force
        return found

    def _note(self) -> None:
        for pair, force in self._latest.items():
            rows = self._rows[pair]
            rows[self._row] = max(rows.get(self._row, 0.0), force)
