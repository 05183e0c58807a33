"""Signals of a log that show whether an agent holds something, as users declare them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import inf

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.quantity_units import QuantityError, read_quantity

FORM = (
    "write AGENT=/topic, 'AGENT=joint NAME between 5 mm and 11 mm', 'AGENT=effort NAME above 5', "
    "or 'AGENT=wrench /topic above 3 N'"
)
EFFORT = "effort"
DIMENSIONS = {"joint": ("length", "angle"), "wrench": ("force",), EFFORT: ()}
"""Kind of a signal → what its numbers measure. An effort is a force or a moment, as the driver publishes it."""
_SIGNAL = re.compile(r"(?P<kind>joint|effort|wrench)\s+(?P<source>\S+)\s+(?P<bounds>.+)")
_BOUNDS = re.compile(r"between\s+(?P<low>.+?)\s+and\s+(?P<high>.+)|above\s+(?P<above>.+)|below\s+(?P<below>.+)")


class NoGripSignal(RobbddError, ValueError):
    """A text declares no signal of a grip; the message says how to write one."""


@dataclass(frozen=True, slots=True)
class GripSignal:
    """A condition on a log under which an agent holds something.

    - ``agent`` and ``held``: the agent, and the object that it then holds; empty if positions determine the object.
    - ``kind``: ``topic`` for a topic of truth values, ``joint``, ``effort`` or ``wrench``.
    - ``source``: the topic, or the name of a joint in the log.
    - ``low`` and ``high``: the bounds of the number in SI units; an effort counts by its magnitude.
    """

    agent: str
    held: str
    kind: str
    source: str
    low: float = -inf
    high: float = inf


def read_grip_signal(text: str) -> GripSignal:
    """Return the signal that ``AGENT[/OBJECT]=SIGNAL`` declares. Raises ``NoGripSignal``."""
    who, _, words = text.partition("=")
    agent, separator, held = who.strip().partition("/")
    words = words.strip()
    if not agent or (separator and not held):
        raise NoGripSignal(f"'{text}' declares no grip: {FORM}")
    if words.startswith("/") and len(words.split()) == 1:
        return GripSignal(agent, held, "topic", words)
    match = _SIGNAL.fullmatch(words)
    bounds = _BOUNDS.fullmatch(match["bounds"]) if match else None
    if match is None or bounds is None:
        raise NoGripSignal(f"'{text}' declares no grip: {FORM}")
    found = {name: _number(text, match["kind"], one) for name, one in bounds.groupdict().items() if one}
    low, high = found.get("low", found.get("above", -inf)), found.get("high", found.get("below", inf))
    if low > high:
        raise NoGripSignal(f"the bounds of '{text}' are in the wrong order")
    return GripSignal(agent, held, match["kind"], match["source"], low, high)


def _number(text: str, kind: str, stated: str) -> float:
    if kind == EFFORT:
        stated = re.sub(r"\s*(N\s*m|N)$", "", stated)
        try:
            return float(stated)
        except ValueError:
            raise NoGripSignal(f"'{stated}' in '{text}' is no number") from None
    for dimension in DIMENSIONS[kind]:
        try:
            return read_quantity(stated, dimension).si
        except QuantityError:
            continue
    wanted = " or ".join(DIMENSIONS[kind])
    raise NoGripSignal(f"'{stated}' in '{text}' is no {wanted}: {FORM}")
