"""Contact forces of agents and gripped objects, measured in every step of the engine.

An impact is shorter than a sample, so no other recorded quantity shows it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.predicates.does_not_collide import FORCE_LIMIT
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.world.engine import TICK, mujoco
from robbdd_tools.world.owners import geom_owners, whole_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

UPHOLDING = 0.5
"""A body supports the one above it if the cosine of the contact normal's angle to the vertical is at least this."""
Pair = tuple[str, str]


class ContactForces:
    """Forces between everything else and each agent together with the objects that it grips.

    A sample has, for each agent and each thing that it touches, the largest force (N) and the impulse (N s) since the
    previous sample. Objects and agents (also the agent itself) are given by name, anything else by the name of its body
    or geom. A moving part that the scene does not declare also counts as the object that it belongs to. A gripped
    object counts with the force beyond its own weight: a part that still stands on a table exerts nothing. Forces are
    measured in every step. Only the steady force between an agent and its gripped object is measured once per sample,
    except for the objects ``in_every_step``.
    """

    def __init__(self, model: Any, agents: Iterable[str], things: Iterable[str], in_every_step: Iterable[str]) -> None:
        """Watch ``agents`` among all ``things``, by the names of their bodies."""
        self._model = model
        self._agents = tuple(agents)
        self._owners = geom_owners(model, self._agents)
        self._step = float(model.opt.timestep)
        gravity = float(np.linalg.norm(model.opt.gravity))
        self._weights = {thing: float(model.body(thing).subtreemass[0]) * gravity for thing in things}
        self._wholes = {thing: whole for thing in self._weights if (whole := whole_of(thing, self._weights)) != thing}
        self._in_every_step = frozenset(in_every_step)
        self._wrench: FloatArray = np.zeros(6)
        self.clear()

    def clear(self) -> None:
        """Delete all samples."""
        self._row = 0
        self._peaks: dict[Pair, dict[int, float]] = defaultdict(dict)
        self._impulses: dict[Pair, dict[int, float]] = defaultdict(dict)
        self._contacts: dict[tuple[str, str, str], _Sum] = {}
        self._ever_gripped: set[Pair] = set()
        self._supports: set[tuple[str, str]] = set()
        self._first_supports: frozenset[tuple[str, str]] = frozenset()
        self._hold(frozenset())

    def measure(self, data: Any) -> None:
        """Measure after one step of the engine."""
        if not data.ncon:
            return
        holders, steady = self._holder_of, self._is_steady
        counted = [
            (contact, first, second)
            for contact, (first, second) in enumerate(data.contact.geom.tolist())
            if holders[first] != holders[second] or (holders[first] and not (steady[first] or steady[second]))
        ]
        if counted:
            self._measure(data, counted, self._step)

    def record(self, data: Any, held: Mapping[str, Iterable[str]]) -> None:
        """Take a sample; from now on each agent grips the objects ``held``."""
        if self._gripped:
            self._measure_grips(data)
        gripped = frozenset((agent, thing) for agent, things in held.items() for thing in things)
        if gripped != self._gripped:
            for _, thing in gripped ^ self._gripped:
                self._note_supports(data, thing)
            first = {thing for _, thing in gripped - self._ever_gripped}
            self._first_supports |= {pair for pair in self._supports if pair[0] in first}
            self._ever_gripped |= gripped
            self._hold(gripped)
        self._row += 1

    @property
    def agents(self) -> tuple[str, ...]:
        """The watched agents."""
        return self._agents

    @property
    def row(self) -> int:
        """The number of samples so far."""
        return self._row

    def touched_since(self, row: int, agent: str) -> tuple[str, ...]:
        """Return the names of the things that an agent has touched since a sample."""
        pairs = ((other, rows) for (one, other), rows in self._peaks.items() if one == agent)
        found = {other for other, rows in pairs if any(one >= row for one in rows)}
        return tuple(sorted(found - {self._wholes.get(other) for other in found}))

    def hit_since(self, row: int, thing: str) -> tuple[str, ...]:
        """Return what a gripped thing has touched for the first time, or hardest, since a sample.

        The hardest contact comes first. The support from which the thing was first picked up is left out.
        """
        found = [
            (total.peak, other)
            for (_, part, other), total in self._contacts.items()
            if part == thing and (part, other) not in self._first_supports and max(total.first, total.highest) >= row
        ]
        return tuple(other for _, other in sorted(found, key=lambda one: (-one[0], one[1])))

    def peaks(self, size: int) -> Mapping[Pair, FloatArray]:
        """Return the largest force (N) before each of the first ``size`` samples, by pair in contact: (size,)."""
        return series(self._peaks, size)

    def impulses(self, size: int) -> Mapping[Pair, FloatArray]:
        """Return the impulse (N s) before each of the first ``size`` samples, by pair in contact: (size,)."""
        return series(self._impulses, size)

    def contacts(self, times: FloatArray) -> tuple[Contact, ...]:
        """Return the contacts so far, earliest first; ``times`` (n,) are the times of the samples, s.

        Contacts with an object that the agent grips at some time are left out. So are contacts with the support of this
        object while it is picked up or put down, unless the force exceeds the limit of *does not collide*.
        """
        found = [
            Contact(*key, float(times[total.first]), total.peak, float(times[total.highest]), total.impulse)
            for key, total in self._contacts.items()
            if total.highest < len(times)
            and (key[0], key[2]) not in self._ever_gripped
            and ((key[1], key[2]) not in self._supports or total.peak > FORCE_LIMIT)
        ]
        return tuple(sorted(found, key=lambda one: (one.time, one.agent, one.part, one.other)))

    def _hold(self, gripped: frozenset[Pair]) -> None:
        """Record which agent grips which objects, and for each geom its agent and whether it is of a gripped object."""
        self._gripped = gripped
        self._holders = {agent: agent for agent in self._agents} | {thing: agent for agent, thing in gripped}
        self._holder_of = [self._holders.get(owner, "") for owner in self._owners]
        things = {thing for _, thing in gripped} - self._in_every_step
        self._is_steady = [owner in things for owner in self._owners]

    def _measure_grips(self, data: Any) -> None:
        """Measure the forces between agents and gripped objects."""
        counted = [
            (contact, first, second)
            for contact, (first, second) in enumerate(data.contact.geom.tolist())
            if self._holder_of[first] == self._holder_of[second] and self._is_steady[first] != self._is_steady[second]
        ]
        self._measure(data, counted, TICK)

    def _measure(self, data: Any, counted: list[tuple[int, int, int]], duration: float) -> None:
        """Add the forces of the contacts ``counted`` (number, two geoms), which last for ``duration`` (s)."""
        forces: defaultdict[tuple[str, str, str], list[float]] = defaultdict(lambda: [0.0, 0.0])
        for contact, *geoms in counted:
            size, lift = self._force(data, contact)
            if not size:
                continue
            first, second = (self._owners[geom] for geom in geoms)
            pairs = ((first, second, lift),) if first == second else ((first, second, lift), (second, first, -lift))
            for mine, theirs, upwards in pairs:
                agent = self._holders.get(mine)
                # Contacts of a gripped object with its agent, or with another part in the same gripper, are no
                # collisions.
                if agent is None or (mine != agent and self._holders.get(theirs) == agent):
                    continue
                total = forces[agent, "" if mine == agent else mine, theirs]
                total[0] += size
                total[1] += max(0.0, -upwards)
        pressed: defaultdict[Pair, float] = defaultdict(float)
        for (agent, part, other), (size, down) in forces.items():
            force = size - min(down, self._weights.get(part, 0.0)) if part else size
            pressed[agent, other] += force
            if other in self._wholes:
                pressed[agent, self._wholes[other]] += force
            if not part and (agent, part, other) not in self._contacts:
                # Closing fingers may lift a part a little before they grip it.
                self._note_supports(data, other)
            self._contacts.setdefault((agent, part, other), _Sum(self._row, self._row)).add(self._row, force, duration)
        for pair, force in pressed.items():
            peaks, impulses = self._peaks[pair], self._impulses[pair]
            peaks[self._row] = max(peaks.get(self._row, 0.0), force)
            impulses[self._row] = impulses.get(self._row, 0.0) + force * duration

    def _force(self, data: Any, contact: int) -> tuple[float, float]:
        """Return the magnitude (N) of a contact's force, and its upward component (N) on the second geom."""
        mujoco.mj_contactForce(self._model, data, contact, self._wrench)
        x, y, z, *_ = self._wrench.tolist()
        if not (x or y or z):
            return 0.0, 0.0
        upwards = data.contact.frame[contact, 2::3].tolist()
        return hypot(x, y, z), x * upwards[0] + y * upwards[1] + z * upwards[2]

    def _note_supports(self, data: Any, thing: str) -> None:
        """Record the supports of an object by contact directions, not by forces: a grip may carry all of the weight."""
        pairs: list[list[int]] = data.contact.geom.tolist()
        for geoms, upwards in zip(pairs, data.contact.frame[:, 2].tolist(), strict=True):
            first, second = (self._owners[geom] for geom in geoms)
            if thing in (first, second) and (upwards if second == thing else -upwards) > UPHOLDING:
                self._supports.add((thing, first if second == thing else second))


@dataclass(slots=True)
class _Sum:
    """Totals of one contact: row of its first sample, row of its largest force, this force (N), the impulse (N s)."""

    first: int
    highest: int
    peak: float = 0.0
    impulse: float = 0.0

    def add(self, row: int, force: float, duration: float) -> None:
        if force > self.peak:
            self.peak, self.highest = force, row
        self.impulse += force * duration


def series(rows: Mapping[Pair, Mapping[int, float]], size: int) -> Mapping[Pair, FloatArray]:
    """Return values by row as arrays (size,), 0 in rows without a value."""
    found: dict[Pair, FloatArray] = {}
    for pair, values in sorted(rows.items()):
        series = np.zeros(size)
        for row, value in values.items():
            if row < size:
                series[row] = value
        found[pair] = series
    return found
