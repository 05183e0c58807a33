"""Determine the poses of the bodies of an executable scene: compose relative frames and draw random samples."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import numpy as np

from robbdd_tools.catalog.executable import law_fault
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import Body, Link, SceneInstance

    Transform = tuple[FloatArray, FloatArray]
    """Position (3,) m and unit quaternion (4,), w first."""

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class PoseError(SceneError):
    """A body has no pose because its frames are not connected to the world, or its pose cannot be determined."""


def is_rotation(numbers: Sequence[float] | FloatArray) -> bool:
    """Return whether numbers are a quaternion of a rotation: four, not all of them 0."""
    return len(numbers) == 4 and bool(np.any(numbers))


class Frames:
    """The frames of one scene instance in one execution; ``seed`` is the seed of random draws."""

    def __init__(self, instance: SceneInstance, seed: int) -> None:
        self._instance = instance
        self._seed = seed
        self._bodies = {body.iri: body for body in instance.bodies}
        self._laws = {law.iri: law for law in instance.laws}

    def pose(self, iri: str, element: str, attempt: int = 0) -> Transform | None:
        """Return the pose of a body's own frame in the world, ``None`` for a body that no pose or joint places.

        The body's own placement is drawn again for each ``element`` and ``attempt``, the placement of its supports only
        once. Raises ``PoseError`` if no chain of frames connects the body to the world or a distribution cannot be
        sampled.
        """
        body = self._bodies.get(iri)
        if body is None:
            raise PoseError(f"the body '{_short(iri)}' is not part of a 'kgraph' of the scene")
        if not body.frames or not self._is_placed(body):
            return None
        known = self._known(body, f"{element} {attempt}")
        if body.frames[0] not in known:
            where = f"the body '{_short(iri)}' is placed nowhere: no pose or joint leads from"
            world = _short(self._instance.anchor) or "the world"
            raise PoseError(f"{where} '{world}' to its frame", origin=body.origin)
        return known[body.frames[0]]

    def _is_placed(self, body: Body) -> bool:
        """Return whether a pose or a joint places a body."""
        named = {self._instance.anchor, *(frame for link in self._instance.links for frame in (link.frame, link.base))}
        return not named.isdisjoint(body.frames)

    def first_body(self, tree: str) -> str | None:
        """Return the first body of a tree."""
        return next((body.iri for body in self._instance.bodies if body.iri.startswith(f"{tree}.")), None)

    def _known(self, body: Body, salt: str) -> dict[str, Transform]:
        """Return the world poses of all reachable frames; poses are applied before joints."""
        origin: Transform = (np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
        known: dict[str, Transform] = {"": origin}
        if self._instance.anchor:
            known[self._instance.anchor] = origin
        poses = [link for link in self._instance.links if link.kind == "pose"]
        joints = [link for link in self._instance.links if link.kind != "pose"]
        while self._extend(known, poses, body, salt) or self._extend(known, joints, body, salt):
            pass
        return known

    def _extend(self, known: dict[str, Transform], links: list[Link], body: Body, salt: str) -> bool:
        """Add the first frame that a link connects to a known one; return whether there was one."""
        for link in links:
            if (link.base in known) == (link.frame in known):
                continue
            step = self._transform(link, salt if link.frame in body.frames else "")
            if link.base in known:
                known[link.frame] = compose(known[link.base], step)
            else:
                known[link.base] = compose(known[link.frame], inverse(step))
            return True
        return False

    def _transform(self, link: Link, salt: str) -> Transform:
        if link.kind == "revolute":
            return np.array(link.position or (0.0, 0.0, 0.0)), _onto(*(np.array(AXES[axis]) for axis in link.axes))
        if link.kind == "fixed":
            return np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
        position = np.array(link.position)
        if link.position_law:
            position = self._drawn(link.position_law, f"{link.frame} xyz {salt}") * link.scale
        if len(position) != 3:
            raise PoseError(f"a position needs 3 numbers, not {len(position)}", origin=link.origin)
        rotation = np.array(link.rotation)
        if link.rotation_law:
            rotation = _rotation(self._drawn(link.rotation_law, f"{link.frame} turn {salt}"), link)
        if not is_rotation(rotation):
            raise PoseError("the orientation is not a rotation", origin=link.origin)
        return position, rotation

    def _drawn(self, iri: str, salt: str) -> FloatArray:
        law = self._laws.get(iri)
        if law is None:
            raise PoseError(f"the distribution '{_short(iri)}' does not exist")
        fault = law_fault(law)
        if fault:
            raise PoseError(f"the distribution '{_short(law.iri)}' {fault}", origin=law.origin)
        digest = hashlib.sha256(f"{self._seed} {salt}".encode()).digest()
        dice = np.random.default_rng(int.from_bytes(digest[:8], "big"))
        match law.kind:
            case "uniform-rotation":
                turn = dice.standard_normal(4)
                return turn / np.linalg.norm(turn)
            case "uniform":
                return dice.uniform(law.low, law.high)
            case _:
                size = len(law.mean)
                factor = np.linalg.cholesky(np.array(law.covariance).reshape(size, size))
                drawn: FloatArray = np.array(law.mean) + factor @ dice.standard_normal(size)
                return drawn


def _rotation(drawn: FloatArray, link: Link) -> FloatArray:
    """Return the quaternion of a drawn value: a rotation, or angles about x, y, z (rad, intrinsic)."""
    if len(drawn) == 4:
        return drawn / np.linalg.norm(drawn)
    if len(drawn) != 3:
        raise PoseError(f"an orientation needs 3 angles or a rotation, not {len(drawn)} numbers", origin=link.origin)
    turn: FloatArray = np.empty(4)
    mujoco.mju_euler2Quat(turn, drawn, "xyz")
    return turn


def compose(first: Transform, second: Transform) -> Transform:
    """Compose two poses: ``second`` is given in the frame ``first``."""
    moved, turned = np.empty(3), np.empty(4)
    mujoco.mju_rotVecQuat(moved, second[0], first[1])
    mujoco.mju_mulQuat(turned, first[1], second[1])
    return first[0] + moved, turned


def inverse(pose: Transform) -> Transform:
    """Return the pose of the base relative to the frame."""
    back, moved = np.empty(4), np.empty(3)
    mujoco.mju_negQuat(back, pose[1])
    mujoco.mju_rotVecQuat(moved, pose[0], back)
    return -moved, back


def _onto(goal: FloatArray, start: FloatArray) -> FloatArray:
    """Return the smallest rotation that aligns the child's axis ``start`` with the parent's axis ``goal``."""
    axis = np.cross(start, goal)
    turn = np.empty(4)
    mujoco.mju_axisAngle2Quat(turn, axis, np.pi / 2 if axis.any() else 0.0)
    return turn


def _short(iri: str) -> str:
    return iri.replace("#", "/").rpartition("/")[2]
