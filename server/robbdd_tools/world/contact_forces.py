"""Contact forces between agents and objects, measured while the simulation steps: nothing recorded tells them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


class Forces:
    """The largest force per sample on each of ``targets`` from each agent, together with all that it grips."""

    def __init__(self, model: Any, agents: Iterable[str], things: Iterable[str], targets: Iterable[str]) -> None:
        """Watch agents and the objects ``targets`` among all ``things``, by the names of their bodies."""
        self._model = model
        owners = [str(model.body(int(body)).name) for body in model.geom_bodyid]
        self._agents = {name: {geom for geom, o in enumerate(owners) if o.startswith(f"{name}/")} for name in agents}
        # A belt belongs to the object that it is a part of.
        bodies = [owner.partition("/belt")[0] for owner in owners]
        self._things = {name: {geom for geom, owner in enumerate(bodies) if owner == name} for name in things}
        self._rows: dict[tuple[str, str], list[float]] = {(a, t): [] for t in targets for a in self._agents}
        self._peaks = dict.fromkeys(self._rows, 0.0)

    def look(self, data: Any, gripped: Mapping[str, list[str]]) -> None:
        """Measure after one step of the engine; ``gripped`` are the objects that each agent grips."""
        if not data.ncon:
            return
        pairs = data.contact.geom
        for (agent, target), peak in self._peaks.items():
            own = set(self._agents[agent])
            own.update(*(self._things[name] for name in gripped[agent] if name != target))
            theirs = self._things[target]
            force = sum(
                self._force(data, contact)
                for contact, (one, other) in enumerate(pairs.tolist())
                if (one in own and other in theirs) or (other in own and one in theirs)
            )
            self._peaks[agent, target] = max(peak, force)

    def record(self) -> None:
        """Take a sample: what was largest since the last one."""
        for pair, peak in self._peaks.items():
            self._rows[pair].append(peak)
            self._peaks[pair] = 0.0

    def clear(self) -> None:
        """Forget all samples."""
        for pair, rows in self._rows.items():
            rows.clear()
            self._peaks[pair] = 0.0

    def record_of(self, size: int) -> Mapping[tuple[str, str], FloatArray]:
        """Return the first ``size`` samples of each agent and target, N, shape (size,)."""
        return {pair: np.array(rows[:size]) for pair, rows in self._rows.items()}

    def _force(self, data: Any, contact: int) -> float:
        wrench = np.zeros(6)
        mujoco.mj_contactForce(self._model, data, contact, wrench)
        return float(np.linalg.norm(wrench[:3]))
