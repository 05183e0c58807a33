"""A log that a ``.bddx`` names for an execution, as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import Origin

ERROR_KEYS = {"length": "others", "angle": "angle", "speed": "speed"}
"""Dimension of a largest error that is stated for no element → its key in ``RecordedLog.errors``."""
Pairs = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class RecordedLog:
    """A recording of a real robot, and the meaning of the names in it. Elements, variables and events are IRIs.

    - ``path``: the path as written: absolute, or relative to the folder of the file of ``origin``.
    - ``values``: pairs of a variable and the value (IRI, text or number) with which the robot executed the scenario.
    - ``frames``, ``bases``, ``joints``: pairs of a name in the log (the frame of an element, the frame of the base of
      an arm, a topic of joint states) and an element.
    - ``world``: the frame of the world; empty if it is found by its name.
    - ``events``: pairs of an event and the signal that reports it; see ``protocol/event_signals``.
    - ``grips``: pairs of an agent and the signal that it holds something; see ``protocol/grip_signals``.
    - ``annotations``: the path, like ``path``, of a table of further events; empty if there is none.
    - ``errors``: pairs of an element, or of ``others``, ``angle`` or ``speed``, and the largest error in m, rad or m/s.
    """

    iri: str
    path: str
    values: tuple[tuple[str, str | float], ...] = ()
    frames: Pairs = ()
    bases: Pairs = ()
    world: str = ""
    joints: Pairs = ()
    events: Pairs = ()
    grips: Pairs = ()
    annotations: str = ""
    errors: tuple[tuple[str, float], ...] = ()
    origin: Origin | None = None
