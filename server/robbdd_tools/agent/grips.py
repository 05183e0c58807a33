"""What each agent's gripper holds, told from contacts alone."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.api import GripperKind

if TYPE_CHECKING:
    from robbdd_tools.agent.simulation import Robot
    from robbdd_tools.catalog.api import FloatArray

ASKEW = cos(radians(20.0))
"""Cosine of the largest angle between a cup's axis and what it holds at which its lip still seals."""


class Grips:
    """Finds grips in the contacts of a simulation.

    Fingers hold what all their pads touch; a cup what it touches with its face while the vacuum is on.
    ``held`` maps an agent to an array with 1 in the columns of what it holds; ``leaking`` are the agents whose cup
    touches something but does not seal on it.
    """

    def __init__(self, model: Any, robots: Mapping[str, Robot], columns: Mapping[str, int], loose: list[str]) -> None:
        self._robots = robots
        self._owner = _owners(model, columns, loose)
        self.held: dict[str, FloatArray] = {name: np.zeros(len(columns)) for name in robots}
        self.leaking: set[str] = set()

    def find(self, data: Any) -> None:
        """Bring ``held`` and ``leaking`` up to date (contacts are few: plain sets are the fastest)."""
        touching: dict[int, dict[int, int]] = {pad: {} for robot in self._robots.values() for pad in robot.pads}
        for contact, (first, second) in enumerate(data.contact.geom.tolist()):
            if first in touching:
                touching[first].setdefault(self._owner.get(second, -1), contact)
            elif second in touching:
                touching[second].setdefault(self._owner.get(first, -1), contact)
        self.leaking.clear()
        for name, robot in self._robots.items():
            grip = self.held[name]
            grip[:] = 0.0
            first, *others = (touching[pad] for pad in robot.pads)
            columns = first.keys() - {-1}
            for other in others:
                columns &= other.keys()
            if robot.model.gripper is GripperKind.SUCTION:
                columns = self._sucked(robot, data, {column: first[column] for column in columns})
            grip[list(columns)] = 1.0

    def _sucked(self, robot: Robot, data: Any, contacts: Mapping[int, int]) -> set[int]:
        """Return what a cup holds among what it touches: column → contact."""
        axis = data.site_xmat[robot.tool].reshape(3, 3)[:, 2]
        sealed = {
            column
            for column, contact in contacts.items()
            if abs(float(data.contact.frame[contact, :3] @ axis)) >= ASKEW
        }
        if contacts and not sealed:
            self.leaking.add(robot.name)
        on = abs(float(data.ctrl[robot.gripper]) - robot.model.gripper_open) > 0.0
        return sealed if on else set()


def _owners(model: Any, columns: Mapping[str, int], loose: list[str]) -> dict[int, int]:
    """Map each geom of a loose object to the object's column."""
    owner: dict[int, int] = {}
    for name in loose:
        body = model.body(name)
        first = int(body.geomadr[0])
        owner |= dict.fromkeys(range(first, first + int(body.geomnum[0])), columns[name])
    return owner
