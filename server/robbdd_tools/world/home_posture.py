"""Find a home posture for arms whose file has none: the tool points down ahead of the base, far from joint limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.coupled_joints import coupled_by_name
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.hanging_arms import is_hung, slides_sideways
from robbdd_tools.world.self_collision import NEAR
from robbdd_tools.world.shoulders import shoulder_aside
from robbdd_tools.world.tilted_base import HIGH

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.catalog.executable import ModelSource

DOWN = np.cos(np.radians(20.0))
"""A tool points down if the cosine of its angle to the vertical is at least this."""
SEEDS = 40
"""Number of random postures from which the search starts; they are the same in every run."""
ROUNDS = 80
CLOSE = 1e-3
"""A posture is accepted if its pose error is below this (m and rad)."""
PROGRESS, PATIENCE = 0.98, 16
"""A search from one posture ends if so many steps in a row do not bring its error below this share of the smallest."""
DAMPING = 1e-4 * np.eye(6)
DISTANCES, HEIGHTS = (0.55, 0.45, 0.65, 0.35), (0.25, 0.35, 0.15, 0.08, 0.03)
"""Places of the tool: shares of the reach ahead of the base, and heights (m) above it, low ones for desktop arms."""
BELOW = (-0.30, -0.45, -0.60, -0.80, -0.15)
"""Heights (m) of the tool of an arm that hangs in its own file, or of a gantry whose base is its beam."""
TRAVEL, GRASP = (0.35, 0.45, 0.25, 0.60, 0.80), (0.30, 0.15)
"""Heights (m) above the world's origin for a tilted arm: it works at the heights of tables, wherever it is fixed.

``TRAVEL`` are heights of the home posture; at the heights ``GRASP``, postures are compared.
"""
OUTWARDS, LEVELS = (0.65, 0.75, 0.85, 0.95), (0.25, 0.0)
"""Places at which postures are compared: shares of the arm's reach from the base outwards, and heights (m)."""
JUMP = 1.0
"""Two neighbouring postures are not on one path if a joint differs by more than this (rad, m)."""
SAME = 0.1
"""Two postures are the same if all joints differ by at most this (rad, m)."""


def find_home(
    model: Any,
    source: ModelSource,
    joints: tuple[str, ...],
    tool: str,
    fingers: dict[str, float],
    palm: str,
    named: Iterable[Mapping[str, float]] = (),
    height: float | None = None,
    is_upright: bool = True,
) -> tuple[float, ...]:
    """Return joint positions (rad, m) with the tool down: a key frame of the file, else the best posture of a search.

    ``fingers`` are the positions of the open gripper's joints, ``palm`` is its first body. Postures that are ``named``
    elsewhere are tried after key frames. ``height`` (m) is that of a base that is tilted or far from the tables, above
    the origin of a usual cell, and ``is_upright`` says that it is not tilted. Raises ``SceneError`` if there is no such
    posture.
    """
    search = _Search(model, joints, tool, fingers, palm, height, is_upright)
    for posture in (*search.key_frames(), *search.complete(joints, named)):
        if search.points_down(posture):
            return tuple(posture.tolist())
    found = max(_different(search.postures()), key=search.quality, default=None)
    if found is None:
        text = f"the arm in {source.name} cannot point its tool straight down in front of its base"
        raise SceneError(f"{text}: check 'tool', or state 'home'", origin=source.origin)
    return tuple(round(float(value), 6) for value in search.straightened(found))


def _different(postures: Iterable[FloatArray]) -> list[FloatArray]:
    """Return the postures without those that are the same as another one."""
    found: list[FloatArray] = []
    for posture in postures:
        if all(np.abs(posture - other).max() > SAME for other in found):
            found.append(posture)
    return found


class _Search:
    def __init__(
        self,
        model: Any,
        joints: tuple[str, ...],
        tool: str,
        fingers: dict[str, float],
        palm: str,
        height: float | None,
        is_upright: bool,
    ) -> None:
        self._model = model
        self._data: Any = mujoco.MjData(model)
        for name, value in fingers.items():
            self._data.qpos[model.joint(name).qposadr[0]] = value
        self._site = model.site(tool).id
        numbers = [model.joint(joint).id for joint in joints]
        self._places, self._speeds = model.jnt_qposadr[numbers], model.jnt_dofadr[numbers]
        self._coupled = coupled_by_name(model, joints)
        limited = model.jnt_limited[numbers].astype(bool)
        wide = np.where(model.jnt_type[numbers] == int(mujoco.mjtJoint.mjJNT_SLIDE), 1.0, np.pi)
        self._low = np.where(limited, model.jnt_range[numbers, 0], -wide)
        self._high = np.where(limited, model.jnt_range[numbers, 1], wide)
        self._near = self._always_near(model.body(palm).id)
        self._heights, self._levels = self._usual_heights(numbers), LEVELS
        if height is not None:
            tables = tuple(one - height for one in TRAVEL)
            # An upright base far above the tables may stand on a pedestal, from which its arm does not reach them.
            self._heights = (*tables, *self._heights) if height >= HIGH and is_upright else tables
            self._levels = tuple(one - height for one in GRASP)
        self._aside = shoulder_aside(model, self._data, numbers[0])
        self._reach = 0.0

    def _usual_heights(self, joints: Sequence[int]) -> tuple[float, ...]:
        mujoco.mj_kinematics(self._model, self._data)
        if is_hung(self._data, joints):
            return BELOW
        return (*HEIGHTS, *BELOW) if slides_sideways(self._model, self._data, joints[0]) else HEIGHTS

    def key_frames(self) -> Iterator[FloatArray]:
        """Yield the postures of the file's key frames, those called home first."""
        named = sorted(range(self._model.nkey), key=lambda key: "home" not in str(self._model.key(key).name))
        for posture in (self._model.key_qpos[key] for key in named):
            values: FloatArray = posture[self._places]
            if self._is_inside(values):
                yield values.copy()

    def complete(self, joints: tuple[str, ...], named: Iterable[Mapping[str, float]]) -> Iterator[FloatArray]:
        """Yield the named postures that have a position within the limits for each joint."""
        for positions in named:
            if all(joint in positions for joint in joints):
                values = np.array([positions[joint] for joint in joints])
                if self._is_inside(values):
                    yield values

    def _is_inside(self, values: FloatArray) -> bool:
        return bool(np.all((values >= self._low - 1e-6) & (values <= self._high + 1e-6)))

    def points_down(self, posture: FloatArray) -> bool:
        """Return whether the tool points down in a posture, in front of the base and free of self-collisions."""
        place, turn = self._forward(posture)
        return bool(-turn[2, 2] >= DOWN and place[0] > 0.1 and self._is_clear())

    def postures(self) -> Iterator[FloatArray]:
        """Yield the postures at the first place that the arm reaches without self-collision."""
        dice = np.random.default_rng(1)
        span = np.minimum(self._high, np.pi) - np.maximum(self._low, -np.pi)
        starts = np.maximum(self._low, -np.pi) + dice.random((SEEDS, len(self._low))) * span
        self._reach = max(float(np.hypot(*self._forward(start)[0][:2])) for start in starts)
        for height in self._heights:
            for share in DISTANCES:
                goal = np.array([share * self._reach, self._aside, height])
                found = [one for start in starts if (one := self._solved(start, goal)) is not None]
                clear = [one for one in found if self._is_clear_at(one)]
                if clear:
                    yield from clear
                    return

    def straightened(self, posture: FloatArray) -> FloatArray:
        """Return a posture at the same place whose fingers close sideways, if there is one, else the posture.

        From it, the wrist can turn to either side as far as grasps need. From others, its joint limit may be in the
        way.
        """
        place, _ = self._forward(posture)
        found = [
            one
            for sign in (1.0, -1.0)
            if (one := self._solved(posture, place, np.array([0.0, sign, 0.0]))) is not None and self._is_clear_at(one)
        ]
        return max(found, key=lambda one: self._room(one)[-1], default=posture)

    def quality(self, posture: FloatArray) -> tuple[int, float]:
        """Return the number of places that the arm reaches from a posture, and how comfortable the posture is.

        An arm has up to eight postures for one place and cannot change between them on its way. An arm whose wrist is
        turned inwards reaches less of the table.
        """
        return sum(self._reached(posture, height) for height in self._levels), self._comfort(posture)

    def _reached(self, posture: FloatArray, height: float) -> int:
        """Return how many places at a height the arm reaches one after the other, without a change of posture."""
        for number, share in enumerate(OUTWARDS):
            after = self._solved(posture, np.array([share * self._reach, self._aside, height]))
            if after is None or np.abs(after - posture).max() > JUMP or not self._is_clear_at(after):
                return number
            posture = after
        return len(OUTWARDS)

    def _comfort(self, posture: FloatArray) -> float:
        """Return a score: best far from joint limits and from a stretched arm, with links high up and in the middle."""
        room = self._room(posture)
        self._forward(posture)
        stretches: list[float] = np.linalg.svd(self._jacobian()[:3], compute_uv=False).tolist()
        above = float(self._data.xpos[1:, 2].mean())
        aside = float(np.abs(self._data.xpos[1:, 1] - self._aside).mean())
        # An arm that bends upwards keeps its elbow off the table; one in the plane of its tool turns to both sides.
        return float(np.min(room)) + stretches[-1] + above - aside

    def _room(self, posture: FloatArray) -> FloatArray:
        """Return the distance of each joint from its limits as a share of its range."""
        return np.minimum(posture - self._low, self._high - posture) / (self._high - self._low)

    def _forward(self, posture: FloatArray) -> tuple[FloatArray, FloatArray]:
        self._data.qpos[self._places] = posture
        self._coupled.place(self._data.qpos)
        mujoco.mj_kinematics(self._model, self._data)
        return self._data.site_xpos[self._site].copy(), self._data.site_xmat[self._site].reshape(3, 3).copy()

    def _jacobian(self) -> FloatArray:
        jacobian = np.zeros((6, self._model.nv))
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_jacSite(self._model, self._data, jacobian[:3], jacobian[3:], self._site)
        self._coupled.reduce(jacobian)
        return jacobian[:, self._speeds]

    def _solved(self, start: FloatArray, goal: FloatArray, across: FloatArray | None = None) -> FloatArray | None:
        """Return a posture with the tool at a place and pointing down, by damped least squares; ``None`` without one.

        Any rotation about the vertical will do, unless the direction (3,) of the tool's y axis is given.
        """
        posture, nearest, since = start, np.inf, 0
        for _ in range(ROUNDS):
            place, turn = self._forward(posture)
            gap = np.concatenate([goal - place, turn_down(turn, across)])
            if np.abs(gap).max() < CLOSE:
                return posture
            error = float(np.linalg.norm(gap))
            nearest, since = (error, 0) if error < PROGRESS * nearest else (nearest, since + 1)
            if since == PATIENCE:
                return None
            jacobian = self._jacobian()
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + DAMPING, gap)
            step = step / max(1.0, float(np.abs(step).max()) / 0.3)
            posture = np.minimum(np.maximum(posture + step, self._low), self._high)
        return None

    def _is_clear_at(self, posture: FloatArray) -> bool:
        self._forward(posture)
        return self._is_clear()

    def _is_clear(self) -> bool:
        """Return whether only those parts of the arm touch that are always near each other."""
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        bodies = self._model.geom_bodyid[self._data.contact.geom]
        return all(self._near[one, other] for one, other in bodies.tolist())

    def _always_near(self, palm: int) -> FloatArray:
        """Return 1 for each pair of bodies at most ``NEAR`` joints apart and for each pair of bodies of the gripper."""
        joints = self._model.body_jntnum
        paths = [frozenset(self._path(body)) for body in range(self._model.nbody)]
        return np.array(
            [
                [sum(int(joints[body]) for body in one ^ other) <= NEAR or palm in one & other for other in paths]
                for one in paths
            ]
        )

    def _path(self, body: int) -> Iterator[int]:
        while body:
            yield body
            body = int(self._model.body_parentid[body])


def turn_down(turn: FloatArray, across: FloatArray | None) -> FloatArray:
    """Return the step (3,), a rotation vector, towards a tool with the rotation (3, 3) whose z axis points down.

    Its length is the angle (rad) or, for a tool that points below the horizontal, the sine of the angle. With
    ``across`` (3,), horizontal, it also turns the y axis there, about the vertical.
    """
    x, y = float(turn[0, 2]), float(turn[1, 2])
    tilt = [-y, x, 0.0]
    if turn[2, 2] > 0.0:
        length = math.hypot(x, y)
        angle = math.pi - math.asin(min(1.0, length))
        tilt = [-y / length * angle, x / length * angle, 0.0] if length > 1e-6 else [angle, 0.0, 0.0]
    if across is not None:
        sine = float(turn[0, 1] * across[1] - turn[1, 1] * across[0])
        tilt[2] = math.atan2(sine, float(turn[:, 1] @ across))
    return np.array(tilt)
