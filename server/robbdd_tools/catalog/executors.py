"""The executors of the catalog: how ``bhv impl … { catalog "NAME" }`` executes behaviours in simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Executor:
    """A controller that executes behaviours of the catalog.

    - ``executes``: the names of these behaviours.
    - ``doc``: what it does, in one or two sentences.
    """

    name: str
    executes: frozenset[str]
    doc: str


DEFAULT = "pick-place"
"""The executor of scenarios without an implementation; it executes every behaviour of the catalog."""
TIMED = "timed-pick-place"
"""The executor that follows a timetable and checks nothing."""

PLANNED = Executor(
    DEFAULT,
    frozenset({"pick", "place", "pick-place", "open", "close", "push", "hand-over", "move-to"}),
    "Plans each path within the limits of joints and tool, turns the fingers to the sides of the object, and checks "
    "its grip. A behaviour that cannot go on fails.",
)
PICK = Executor("pick", frozenset({"pick"}), f"As '{DEFAULT}', for picking alone.")
PLACE = Executor("place", frozenset({"place"}), f"As '{DEFAULT}', for placing alone.")
TIMETABLE = Executor(
    TIMED,
    frozenset({"pick-place"}),
    "The state machine of the RobBDD experiment: ten phases of fixed duration, a tool that always points down without "
    "turning, and no check of anything. It never fails; the clauses show what it has done.",
)
EXECUTORS: Mapping[str, Executor] = MappingProxyType(
    {executor.name: executor for executor in (PICK, PLANNED, PLACE, TIMETABLE)}
)


def executes(name: str, behaviour: str) -> bool:
    """Return whether an executor executes a behaviour; false for an unknown name."""
    return name in EXECUTORS and behaviour in EXECUTORS[name].executes
