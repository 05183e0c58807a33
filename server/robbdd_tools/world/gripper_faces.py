"""Find the gripping faces of two or more fingers: compare where their parts are with the gripper open and closed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray, RobotModel
    from robbdd_tools.catalog.executable import ModelSource

Faces = tuple[tuple[str, ...], ...]
"""The names of the geoms of each gripping face."""
MOVES = 0.004
"""The distance between two gripping faces changes by at least this much (m)."""
NEVER_MEET = 0.02
"""If closed faces are farther apart (m), a gripper cannot hold the catalog's smallest object, 31.5 mm."""
TIPS = 0.8
"""A shape of a finger belongs to its gripping face if its distance changes by this share of the largest change."""
OPPOSITE = -0.35
"""Movements up to this cosine of their angle are opposite: three fingers around a hand are 110° to 120° apart."""
OPENS = 0.015
"""Fingers open by more than this (m): parts that approach each other by less belong to a linkage."""
LEVEL = 0.003
"""Pairs of closed shapes form the gripping faces if their distance exceeds the smallest by at most this (m)."""
SMOOTH = 0.01
"""A surface with a coefficient below this has no friction; smaller coefficients cannot be configured either."""


def meeting_faces(model: Any, bodies: Sequence[int], states: Mapping[float, FloatArray]) -> Faces:
    """Return the shapes of the two fingers that approach each other most and meet; empty without such fingers.

    Another finger that closes on one of the two, like the second finger opposite a thumb, belongs to the face of the
    other one. ``bodies`` are the gripper's bodies, the palm first. ``states`` are the joint positions of the model at
    the two ends of the actuator's range.
    """
    palm = bodies[0]
    fingers = _fingers(model, bodies)
    base = int(model.body_weldid[palm])
    moving = [body for body in fingers if body != base]
    branch = {body: _branch(model, body, palm) for body in moving}
    moves = _movements(model, fingers, states)
    # Fingers around a hand that swing far also move ahead, all alike: only the rest of their movements is opposite.
    common = np.mean([moves[body] for body in moving] or [np.zeros(3)], axis=0)
    apart = [
        (one, other)
        for one, other in combinations(moving, 2)
        if branch[one] != branch[other]
        and _joints_to(model, one, palm) == _joints_to(model, other, palm)
        and (_approach(moves[one], moves[other]) or _approach(moves[one] - common, moves[other] - common))
    ]
    # One finger may close on the palm.
    pairs = apart or [(one, base) for one in moving if base in fingers]
    tips: dict[tuple[int, int], tuple[float, Faces]] = {}
    for one, other in pairs:
        tips[one, other] = _tips(model, _names_of(model, fingers[one]), _names_of(model, fingers[other]), states)
    best = max(tips, key=lambda pair: round(tips[pair][0], 6), default=None)
    if best is None or tips[best][0] <= OPENS:
        return ()
    largest, faces = tips[best]
    for side, opposite in ((1, best[0]), (0, best[1])):
        beside = [pair for pair in apart if opposite in pair and pair != best]
        for pair in beside:
            change, found = tips[pair]
            third = pair[1 - pair.index(opposite)]
            own = found[pair.index(third)]
            if change >= TIPS * largest and branch[third] not in {branch[one] for one in best} and own:
                faces = _extended(faces, side, own)
    return faces


def _extended(faces: Faces, side: int, names: Sequence[str]) -> Faces:
    """Return the faces with shapes added to the face ``side``, except those that a face already has."""
    new = tuple(name for name in names if _new(faces, name))
    return tuple((*face, *new) if number == side else face for number, face in enumerate(faces))


def _fingers(model: Any, bodies: Sequence[int]) -> dict[int, list[int]]:
    """Return the collision shapes of each finger; bodies without a joint between them are one finger."""
    found: dict[int, list[int]] = {}
    for body in bodies:
        first, count = int(model.body_geomadr[body]), int(model.body_geomnum[body])
        own = [g for g in range(first, first + count) if model.geom_contype[g] or model.geom_conaffinity[g]]
        if own:
            found.setdefault(int(model.body_weldid[body]), []).extend(own)
    return found


def _tips(
    model: Any, one: Sequence[str], other: Sequence[str], states: Mapping[float, FloatArray]
) -> tuple[float, Faces]:
    """Return the largest change (m) of the distance of two fingers' shapes, and the faces that meet when closed."""
    changes: dict[tuple[str, str], tuple[float, float]] = {}
    for names in product(one, other):
        near, far = sorted(max(0.0, gap(model, state, ((names[0],), (names[1],)))) for state in states.values())
        # Parts that do not meet belong to a linkage; those that move most are the tips.
        if near <= NEVER_MEET and far - near >= MOVES:
            changes[names] = far - near, near
    largest = max((change for change, _ in changes.values()), default=0.0)
    moved = {names: near for names, (change, near) in changes.items() if change >= TIPS * largest}
    nearest = min(moved.values(), default=0.0)
    level = [names for names, near in moved.items() if near <= nearest + LEVEL]
    return largest, _together(model, sorted(level, key=lambda names: -changes[names][0]), states, TIPS * largest)


def _together(model: Any, pairs: Sequence[tuple[str, str]], states: Mapping[float, FloatArray], change: float) -> Faces:
    """Return two faces made of pairs of shapes, except pairs that narrow the opening: a finger's root moves little."""
    faces: Faces = ((), ())
    for pair in pairs:
        wider = tuple((*face, *_new(faces, name)) for face, name in zip(faces, pair, strict=True))
        near, far = sorted(max(0.0, gap(model, state, wider)) for state in states.values())
        if far - near >= change:
            faces = wider
    return faces


def _new(faces: Faces, name: str) -> tuple[str, ...]:
    return () if any(name in face for face in faces) else (name,)


def _movements(
    model: Any, fingers: Mapping[int, Sequence[int]], states: Mapping[float, FloatArray]
) -> dict[int, FloatArray]:
    """Return for each finger the movement (m, shape (3,)) between the two states of its shape that moves most."""
    data = mujoco.MjData(model)
    places: list[FloatArray] = []
    for state in states.values():
        data.qpos[:] = state
        mujoco.mj_kinematics(model, data)
        places.append(data.geom_xpos.copy())
    moved = places[1] - places[0]
    return {body: max(moved[geoms], key=lambda one: float(one @ one)) for body, geoms in fingers.items()}


def _approach(one: FloatArray, other: FloatArray) -> bool:
    """Return whether two movements (m) are opposite or one of them is negligible."""
    lengths = float(np.linalg.norm(one)), float(np.linalg.norm(other))
    return min(lengths) < MOVES / 4 or float(one @ other) <= OPPOSITE * lengths[0] * lengths[1]


def _joints_to(model: Any, body: int, palm: int) -> int:
    """Return the number of joints between a body and the palm: it is equal for the tips of both fingers."""
    below = set(_ancestors(model, body)) - set(_ancestors(model, palm))
    return sum(int(model.body_jntnum[one]) for one in below)


def _branch(model: Any, body: int, palm: int) -> int:
    """Return the child of the palm that carries a body."""
    path = list(_ancestors(model, body))
    return path[path.index(palm) - 1] if palm in path else body


def _ancestors(model: Any, body: int) -> Iterator[int]:
    while body:
        yield body
        body = int(model.body_parentid[body])


def _names_of(model: Any, geoms: Sequence[int]) -> tuple[str, ...]:
    return tuple(str(model.geom(geom).name) for geom in geoms)


def gap(model: Any, state: FloatArray, faces: Sequence[Sequence[str]]) -> float:
    """Return the smallest distance (m) between two gripping faces, negative where they overlap."""
    data = mujoco.MjData(model)
    data.qpos[:] = state
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    pairs = ((model.geom(one).id, model.geom(other).id) for one in faces[0] for other in faces[1])
    return min(float(mujoco.mj_geomDistance(model, data, one, other, 1.0, None)) for one, other in pairs)


def extent(model: Any, data: Any, name: str, axis: FloatArray) -> tuple[float, float]:
    """Return the range (m) of a geom's bounding box along an axis of the world."""
    geom = model.geom(name).id
    box, turn = model.geom_aabb[geom], data.geom_xmat[geom].reshape(3, 3)
    center = float((data.geom_xpos[geom] + turn @ box[:3]) @ axis)
    half = float(np.abs(axis @ turn) @ box[3:])
    return center - half, center + half


def length_of(model: Any, joint: str) -> float:
    """Return the distance (m) from a hinge to the farthest collision shape that it moves."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found = model.joint(joint)
    body = int(model.jnt_bodyid[found.id])
    below = [g for g in range(model.ngeom) if body in _ancestors(model, int(model.geom_bodyid[g]))]
    anchor = data.xanchor[found.id]
    return max((float(np.linalg.norm(data.geom_xpos[geom] - anchor)) for geom in below), default=0.0)


def refuse_smooth_faces(spec: Any, robot: RobotModel, source: ModelSource) -> None:
    """Raise ``SceneError`` if no gripping face of an arm in a file has friction: they would hold 2 μ N = 0.

    Files without friction rely on the engine's own rule that the larger coefficient of two surfaces counts.
    """
    if max(float(spec.geom(pad).friction[0]) for pad in robot.pads) >= SMOOTH:
        return
    raise SceneError(
        f"the gripping faces in {source.name} have no friction, so they hold nothing: of two surfaces, the smaller "
        "coefficient counts. State it in the scene instance: friction of obj <…> on agn <…>: 0.8",
        origin=source.origin,
    )
