"""Faults of robots that ``robbdd mutate`` introduces into the simulated world, to see which clauses notice them.

A fault changes how the robot perceives, moves or grips, never the code of its behaviour, so that it means the same for
behaviours of the catalog and of users.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping


class RobotFaultError(ValueError):
    """An unknown fault or an invalid size; the message lists the valid ones."""


@dataclass(frozen=True, slots=True)
class RobotFault:
    """A fault. Its ``size`` is from ``low`` to ``high`` in ``unit``; a fault without a size has ``low == high``."""

    name: str
    words: str
    size: float = 1.0
    unit: str = ""
    low: float = 1.0
    high: float = 1.0

    def __str__(self) -> str:
        """Return the fault as an argument of the command line."""
        return f"{self.name}={self.size:g}" if self.has_size else self.name

    @property
    def has_size(self) -> bool:
        """Whether the fault has a size."""
        return self.low != self.high

    @property
    def description(self) -> str:
        """The fault in words."""
        return self.words.format(size=f"{self.size:g} {self.unit}".rstrip())


_EVERY = (
    RobotFault("weak-grip", "the gripper has {size} of its force", 0.25, "", 0.01, 0.99),
    RobotFault("offset-pose", "everything is seen {size} away from its place", 10.0, "mm", 0.1, 500.0),
    RobotFault("sensor-noise", "seen positions have {size} of noise (standard deviation)", 5.0, "mm", 0.1, 200.0),
    RobotFault("backlash", "the first joint of the arm has a backlash of {size}", 2.0, "deg", 0.01, 45.0),
    RobotFault("slow-arm", "the arm has {size} of its speed", 0.5, "", 0.05, 0.99),
    RobotFault("fast-arm", "the arm has {size} times its speed", 2.0, "", 1.01, 10.0),
    RobotFault("early-release", "the gripper opens {size} before the arm arrives", 0.5, "s", 0.02, 10.0),
    RobotFault("late-release", "the gripper opens {size} late", 0.5, "s", 0.02, 10.0),
    RobotFault("high-release", "places to put down are seen {size} too high", 50.0, "mm", 1.0, 500.0),
    RobotFault("swapped-object", "another object is handled"),
    RobotFault("swapped-goal", "another workspace is the goal"),
    RobotFault("no-grip", "the gripper never closes"),
    RobotFault("no-release", "the gripper never opens again"),
    RobotFault("no-retreat", "the arm stays where it releases"),
)
ROBOT_FAULTS: Mapping[str, RobotFault] = MappingProxyType({fault.name: fault for fault in _EVERY})


def robot_fault(text: str) -> RobotFault:
    """Return the fault ``NAME`` or ``NAME=SIZE``, with the size in the fault's unit; raises ``RobotFaultError``."""
    name, given, written = text.partition("=")
    fault = ROBOT_FAULTS.get(name.strip())
    if fault is None:
        raise RobotFaultError(f"there is no fault '{name.strip()}'; the known ones are {', '.join(ROBOT_FAULTS)}")
    if not given:
        return fault
    if not fault.has_size:
        raise RobotFaultError(f"the fault '{fault.name}' has no size: omit '={written}'")
    try:
        size = float(written)
    except ValueError:
        size = float("nan")
    if not isfinite(size) or not fault.low <= size <= fault.high:
        unit = f" {fault.unit}" if fault.unit else ""
        wanted = f"a number from {fault.low:g} to {fault.high:g}{unit}"
        raise RobotFaultError(f"the size of '{fault.name}' cannot be '{written}': it must be {wanted}")
    return replace(fault, size=size)
