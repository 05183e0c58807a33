"""Traces: stamped world states and events of one execution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.last_iteration import LAST

if TYPE_CHECKING:
    from robbdd_tools.base.articulation import OpeningRecord
    from robbdd_tools.catalog.api import FloatArray, Outline


OTHERS = "others"
"""Key in ``Trace.uncertain`` for all elements without an entry."""


@dataclass(frozen=True, slots=True)
class EventStamp:
    """The name of an event (CURIE) and the simulated time (s) at which it occurred.

    ``iteration`` is the number (from 1) of the scenario's behaviour during which the event occurred; 0 for an event
    outside of them. In a behaviour tree, it is the number of the execution of the event's emitter.
    """

    name: str
    time: float
    iteration: int = 0


@dataclass(frozen=True, slots=True)
class Doubt:
    """A span of time (s) in which a defined event may have occurred without being observed.

    ``iterations`` are the first and the last iteration to which such an occurrence may belong; 0 for all.
    """

    name: str
    since: float
    until: float
    iterations: tuple[int, int] = (0, 0)
    reason: str = ""

    def __str__(self) -> str:
        why = f": {self.reason}" if self.reason else ""
        return f"it is not known whether event {self.name} occurred from {self.since:.2f} s to {self.until:.2f} s{why}"


@dataclass(frozen=True, slots=True)
class Sample:
    """The state of the world at one instant. It maps names to positions and orientations.

    Positions are in m in the world frame, orientations are unit quaternions (w, x, y, z).
    """

    time: float
    positions: Mapping[str, tuple[float, float, float]]
    orientations: Mapping[str, tuple[float, float, float, float]]


@dataclass(frozen=True, eq=False)
class Trace:
    """A finite sequence of samples and events. Its arrays are read-only: users' code that judges receives them.

    - ``names``: the recorded bodies. The body of an object has its name, and the tool of an agent has the agent's name.
    - ``times``: (n,) s, increasing.
    - ``positions``: (n, len(names), 3) m in the world frame.
    - ``orientations``: (n, len(names), 4) unit quaternions (w, x, y, z).
    - ``grips``: maps an agent to an (n, len(names)) array with 1 where its gripping faces hold the body.
    - ``finished``: true if nothing will be appended.
    - ``remark``: the final message of the execution about a failure ("gripper lost env:cube1 at 3.42 s").
    - ``reaches``: maps an agent and an object to reach margins (n,) rad, with NaN where none was sampled.
    - ``settings``: maps an element and the name of a configuration to its value.
    - ``forces``: maps an agent and a touched element to the largest contact force (N) in any physics step since the
      previous sample (n,). For the agents in ``watched``, all touched elements are included.
    - ``touches``: maps two elements to the largest contact force (N) between them, without what they grip, in any
      physics step since the previous sample (n,). For those in ``touch_watched``, all touched elements are included.
    - ``impulses``: like ``forces``, for the impulse (N s) since the previous sample.
    - ``contacts``: the list of these contacts.
    - ``immovable``: the elements that do not move when they are hit: fixed objects, and agents.
    - ``stated``: the objects of a log whose places are stated instead of observed, by static transforms or the scene.
    - ``outlines``: the extent of each object around its position.
    - ``unreached``: the reason if the scenario is a part of a behaviour tree that never began; then it is not judged.
    - ``contents``: maps a workspace to the workspaces inside it, at any depth.
    - ``correct_places``: maps an object to the workspaces that are stated to be correct for it.
    - ``gaps``: maps two elements to the distance (m) of their surfaces (n,), NaN where it was not measured.
    - ``joint_clearances``: maps an agent to the smallest distance of its joints from their limits, each as a share of
      the joint's range (n,). An agent without limited joints is missing.
    - ``openings``: maps a thing with a joint to its joint positions (n,), or to the reason why it is not known how it
      opens.
    - ``executions``: maps events of a behaviour tree to the number of executions of their emitter.
    - ``pending``: the events that could occur again if the execution continued.
    - ``defined``: the events that the model defines by conditions, each with a remark if it does not occur.
    - ``doubts``: when these events may have occurred without being observed.
    - ``log``: the name of the log from which the samples are; empty for a simulation. Only the trace of a log can lack
      values, which are NaN.
    - ``uncertain``: the largest errors of the measurements of a log, in SI units, if they are stated: of the position
      of an element, or of ``OTHERS``; of ``angle`` and ``speed``.
    - ``truths``: maps a topic of a log to 1 where its last message is true, -1 where it is false, and NaN (n,).
    """

    names: tuple[str, ...]
    times: FloatArray
    positions: FloatArray
    orientations: FloatArray
    grips: Mapping[str, FloatArray] = field(default_factory=dict[str, "FloatArray"])
    events: tuple[EventStamp, ...] = ()
    finished: bool = True
    remark: str = ""
    reaches: Mapping[tuple[str, str], FloatArray] = field(default_factory=dict[tuple[str, str], "FloatArray"])
    settings: Mapping[tuple[str, str], str] = field(default_factory=dict[tuple[str, str], str])
    forces: Mapping[tuple[str, str], FloatArray] = field(default_factory=dict[tuple[str, str], "FloatArray"])
    outlines: Mapping[str, Outline] = field(default_factory=dict[str, "Outline"])
    unreached: str = ""
    contents: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    impulses: Mapping[tuple[str, str], FloatArray] = field(default_factory=dict[tuple[str, str], "FloatArray"])
    watched: tuple[str, ...] = ()
    contacts: tuple[Contact, ...] = ()
    immovable: tuple[str, ...] = ()
    executions: Mapping[str, int] = field(default_factory=dict[str, int])
    pending: tuple[str, ...] = ()
    log: str = ""
    truths: Mapping[str, FloatArray] = field(default_factory=dict[str, "FloatArray"])
    touches: Mapping[tuple[str, str], FloatArray] = field(default_factory=dict[tuple[str, str], "FloatArray"])
    touch_watched: tuple[str, ...] = ()
    correct_places: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    gaps: Mapping[tuple[str, str], FloatArray] = field(default_factory=dict[tuple[str, str], "FloatArray"])
    joint_clearances: Mapping[str, FloatArray] = field(default_factory=dict[str, "FloatArray"])
    openings: Mapping[str, OpeningRecord | str] = field(default_factory=dict[str, "OpeningRecord | str"])
    uncertain: Mapping[str, float] = field(default_factory=dict[str, float])
    defined: Mapping[str, str] = field(default_factory=dict[str, str])
    doubts: tuple[Doubt, ...] = ()
    stated: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Make all arrays read-only, without copying them."""
        for name in ("times", "positions", "orientations"):
            object.__setattr__(self, name, _read_only(getattr(self, name)))
        for name in ("grips", "reaches", "forces", "impulses", "truths", "touches", "gaps", "joint_clearances"):
            object.__setattr__(self, name, {key: _read_only(value) for key, value in getattr(self, name).items()})
        kept = {name: one if isinstance(one, str) else _fixed(one) for name, one in self.openings.items()}
        object.__setattr__(self, "openings", kept)

    @property
    def end(self) -> float:
        """The time of the last sample, s; 0 if there is none."""
        return float(self.times[-1]) if len(self.times) else 0.0

    @cached_property
    def _index(self) -> Mapping[str, int]:
        return {name: index for index, name in enumerate(self.names)}

    def column(self, name: str) -> int:
        """Return the index of a body in ``names``. Raises ``KeyError`` if the trace does not contain it."""
        return self._index[name]

    def position_error(self, name: str) -> float:
        """Return the largest error (m) of the position of an element in a log; 0 if none is stated."""
        return self.uncertain.get(name, self.uncertain.get(OTHERS, 0.0))

    def event_time(self, name: str, iteration: int = 0) -> float | None:
        """Return the time of the first occurrence of an event, or ``None``.

        With an ``iteration``, which may be ``LAST``, only occurrences in that iteration and outside of all iterations
        count.
        """
        iteration = self.executions.get(name, 0) if iteration == LAST else iteration
        counted = (0, iteration)
        stamps = (stamp for stamp in self.events if stamp.name == name)
        return min((stamp.time for stamp in stamps if not iteration or stamp.iteration in counted), default=None)

    def event_times(self, name: str, scope: tuple[int, int] = (0, 0)) -> tuple[float, ...]:
        """Return the times of all occurrences of an event, in order.

        ``scope`` are the first and the last iteration that count, besides occurrences outside of all iterations. All
        iterations count if the first one is 0.
        """
        first, last = scope
        stamps = (stamp for stamp in self.events if stamp.name == name)
        return tuple(
            sorted(
                stamp.time for stamp in stamps if not first or not stamp.iteration or first <= stamp.iteration <= last
            )
        )

    def doubt(self, name: str, scope: tuple[int, int] = (0, 0), before: float | None = None) -> Doubt | None:
        """Return the first span in which an event may have occurred unobserved in the iterations ``scope``, if any.

        ``scope`` has the same meaning as in ``event_times``. Spans that do not begin ``before`` a time (s) are ignored.
        """
        first, last = scope
        for one in self.doubts:
            low, high = one.iterations
            is_meant = first <= 0 or not high or (low <= last and first <= high)
            if one.name == name and is_meant and (before is None or one.since < before):
                return one
        return None

    def first_at_or_after(self, time: float) -> int:
        """Return the index of the first sample in ``[time, ∞)``; ``len(times)`` if there is none."""
        return int(np.searchsorted(self.times, time, side="left"))

    def last_at_or_before(self, time: float) -> int:
        """Return the index of the last sample in ``(-∞, time]``; -1 if there is none."""
        return int(np.searchsorted(self.times, time, side="right")) - 1

    def sample(self, index: int) -> Sample:
        """Return the state of the world at the sample with this index."""
        positions: list[list[float]] = self.positions[index].tolist()
        orientations: list[list[float]] = self.orientations[index].tolist()
        return Sample(
            float(self.times[index]),
            {name: (p[0], p[1], p[2]) for name, p in zip(self.names, positions, strict=True)},
            {name: (q[0], q[1], q[2], q[3]) for name, q in zip(self.names, orientations, strict=True)},
        )


def _read_only(values: FloatArray) -> FloatArray:
    """Return the same values, which cannot be changed through the result."""
    view = values.view()
    view.flags.writeable = False
    return view


def _fixed(record: OpeningRecord) -> OpeningRecord:
    return replace(record, positions=_read_only(record.positions))
