"""Objects held by each agent's gripper, detected from contacts alone."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from math import cos, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.catalog.api import GripperKind

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.robot import Robot

ASKEW = cos(radians(20.0))
"""A cup's lip seals if the cosine of the angle between the cup's axis and the surface normal is at least this."""
AGAINST = cos(radians(95.0))
"""Two faces push against each other if the cosine of the angle between their pushes is at most this."""

Contacts = Mapping[int, list[tuple[int, int]]]
"""Column of a loose object (-1 for anything else) → number of each contact, and 1 if its normal points into it,
else -1."""


class Grips:
    """Detects grips in the contacts of a simulation.

    Fingers hold an object that all their gripping faces touch, two of them from opposite sides; a cup holds an object
    that its face touches while the vacuum is on. ``held`` maps an agent to an array with 1 in the columns of held
    objects. ``leaking`` are the agents whose cup touches something without sealing.
    """

    def __init__(self, model: Any, robots: Mapping[str, Robot], columns: Mapping[str, int], loose: list[str]) -> None:
        self._robots = robots
        self._owner = _owners(model, columns, loose)
        self._pads = {pad for robot in robots.values() for pad in robot.pads}
        self._touched = False
        self.held: dict[str, FloatArray] = {name: np.zeros(len(columns)) for name in robots}
        self.leaking: set[str] = set()

    def find(self, data: Any) -> None:
        """Update ``held`` and ``leaking`` (for few contacts, plain sets are the fastest)."""
        touching = self._touching(data) if data.ncon else {}
        if not touching and not self._touched:
            return
        self._touched = bool(touching)
        self.leaking.clear()
        for name, robot in self._robots.items():
            grip = self.held[name]
            grip[:] = 0.0
            for column in self._held(robot, data, touching):
                grip[column] = 1.0

    def _touching(self, data: Any) -> dict[int, dict[int, list[tuple[int, int]]]]:
        """Return the contacts of each pad; a pad without contact is absent."""
        touching: dict[int, dict[int, list[tuple[int, int]]]] = {}
        pads, owner = self._pads, self._owner
        for contact, (first, second) in enumerate(data.contact.geom.tolist()):
            if first in pads:
                touching.setdefault(first, {}).setdefault(owner.get(second, -1), []).append((contact, 1))
            elif second in pads:
                touching.setdefault(second, {}).setdefault(owner.get(first, -1), []).append((contact, -1))
        return touching

    def _held(self, robot: Robot, data: Any, touching: Mapping[int, Contacts]) -> set[int]:
        """Return the columns of the objects that a robot holds."""
        faces = [_of_face(face, touching) for face in robot.faces]
        if not all(faces):
            return set()
        first, *others = faces
        columns = set(first) - {-1}
        for other in others:
            columns &= other.keys()
        if robot.model.gripper is GripperKind.SUCTION:
            return self._sucked(robot, data, {column: first[column] for column in columns})
        normals = data.contact.frame[:, :3]
        return {column for column in columns if _are_opposed([_pushes(face[column], normals) for face in faces])}

    def _sucked(self, robot: Robot, data: Any, contacts: Contacts) -> set[int]:
        """Return the objects that a cup holds among those that it touches."""
        axis = data.site_xmat[robot.tool].reshape(3, 3)[:, 2]
        normals = data.contact.frame[:, :3]
        sealed = {
            column
            for column, found in contacts.items()
            if any(abs(float(normals[contact] @ axis)) >= ASKEW for contact, _ in found)
        }
        if contacts and not sealed:
            self.leaking.add(robot.name)
        return sealed if data.ctrl[robot.gripper] != robot.model.gripper_open else set()


def _of_face(face: tuple[int, ...], touching: Mapping[int, Contacts]) -> Contacts:
    """Return the contacts of a gripping face, which may consist of several pads."""
    if len(face) == 1:
        return touching.get(face[0], {})
    found: dict[int, list[tuple[int, int]]] = {}
    for pad in face:
        for column, contacts in touching.get(pad, {}).items():
            found.setdefault(column, []).extend(contacts)
    return found


def _pushes(contacts: list[tuple[int, int]], normals: FloatArray) -> FloatArray:
    """Return the directions (n, 3) in which a face pushes an object."""
    return np.array([sign * normals[contact] for contact, sign in contacts])


def _are_opposed(pushes: list[FloatArray]) -> bool:
    """Return whether two faces push against each other: fingers that press on the top of an object do not hold it."""
    return any(bool((one @ other.T <= AGAINST).any()) for one, other in combinations(pushes, 2))


def _owners(model: Any, columns: Mapping[str, int], loose: list[str]) -> dict[int, int]:
    """Map each geom of a loose object to the object's column."""
    owner: dict[int, int] = {}
    for name in loose:
        body = model.body(name)
        first = int(body.geomadr[0])
        owner |= dict.fromkeys(range(first, first + int(body.geomnum[0])), columns[name])
    return owner
