"""The behaviours of an execution as data: calls, their order, and time limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments

TIMEOUT = 60.0
"""An execution is stopped after this simulated time (s)."""


@dataclass(frozen=True, slots=True)
class Call:
    """A behaviour, by its catalog name, with the names in its slots.

    The place of a behaviour may be a set of workspaces. In a When with several behaviours, ``part`` distinguishes its
    events from those of the others, ``is_meanwhile`` states whether it is executed at the same time as the previous
    call, and ``awaited`` are the events (CURIEs) that must occur before it begins. ``iteration`` is the iteration of
    its events; if it is 0, this is the call's own number in the sequence of calls.
    """

    behaviour: str
    arguments: Arguments
    part: str = ""
    is_meanwhile: bool = False
    awaited: tuple[str, ...] = ()
    iteration: int = 0

    def element(self, slot: str) -> str:
        """Return the single element in a slot. Raises ``SceneError`` if the slot contains a set."""
        found = self.arguments[slot]
        if isinstance(found, str):
            return found
        raise SceneError(f"'{self.behaviour}' needs one {slot}, not a set of them")

    @property
    def agents(self) -> tuple[str, ...]:
        """The agents whose arms the behaviour moves."""
        return tuple(self.element(slot) for slot in ("agent", "receiver") if slot in self.arguments)

    @property
    def places(self) -> tuple[str, ...]:
        """The workspaces where the behaviour may place."""
        found = self.arguments["workspace"]
        return (found,) if isinstance(found, str) else tuple(found)


@dataclass(frozen=True, slots=True)
class Choice:
    """An element that a behaviour chose from a set of places.

    ``number`` is the number of the call (from 1), and ``nodes`` are the behaviour-tree nodes to which the call belongs.
    """

    number: int
    nodes: tuple[str, ...]
    place: str


@dataclass(frozen=True, slots=True)
class Timing:
    """The times of an execution in simulated s.

    They are the minimum idle time before the first behaviour, the recording time after the scenario's end, and the
    timeout. The contact forces of the elements ``touching`` are recorded; a workspace means its objects.
    """

    lead: float = 0.5
    tail: float = 0.0
    timeout: float = TIMEOUT
    touching: frozenset[str] = frozenset()


def groups_of(calls: Sequence[Call]) -> list[list[int]]:
    """Return the indices of the calls in groups that are executed one after the other.

    The calls of a group are executed at the same time. Raises ``SceneError`` if an agent has two calls in a group.
    """
    groups: list[list[int]] = []
    for index, call in enumerate(calls):
        if call.is_meanwhile and groups:
            groups[-1].append(index)
        else:
            groups.append([index])
    for group in groups:
        agents: set[str] = set()
        for agent in (agent for index in group for agent in calls[index].agents) if len(group) > 1 else ():
            if agent in agents:
                raise SceneError(f"'{agent}' cannot execute two behaviours at the same time ('meanwhile')")
            agents.add(agent)
    return groups
