"""The frame of a hand: the middle of its faces, the closing direction, and the direction out of the hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.world.gripper_faces import Faces

BETWEEN_FINGERS = 0.03
"""If the frame of the palm is at most this far (m) from the middle of the closed faces, it is between the fingers."""
JUST_OPEN = 0.05
"""A jaw has just opened after this share of its way."""
ALONG = np.cos(np.radians(30.0))
"""The jaws of a hand are on the axis of its joint if they are nearer than this (cosine of the angle) to it."""
FLAT = 1e-3
"""A frame is in the plane of a suction cup if its distance (m) from it is at most this."""
STRAIGHT = np.cos(np.radians(10.0))
"""A direction out of the hand that is nearer than this (cosine of the angle) to an axis of the palm is that axis."""


def finger_frame(
    model: Any, palm: int, faces: Faces, closed: FloatArray, opened: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the middle (m) of two closed faces, the closing direction and the direction out of the hand, (3,) each.

    ``closed`` and ``opened`` are the positions of all joints. The closing direction leads from the second face to the
    first one.
    """
    data = _placed(model, closed)
    middle = np.mean([_center(model, data, face) for face in faces[:2]], axis=0)
    data = _placed(model, opened)
    across = _center(model, data, faces[0]) - _center(model, data, faces[1])
    across /= np.linalg.norm(across)
    return middle, across, _direction_out(model, data, palm, middle, across)


def jaw_frame(
    model: Any, palm: int, faces: Faces, closed: FloatArray, opened: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the same as ``finger_frame`` for a first face that closes on a second one, which is part of the hand.

    An open jaw that turns far is beside the hand, so the way on which it meets the other face is the closing direction.
    """
    data = _placed(model, closed)
    middle = np.mean([_center(model, data, face) for face in faces[:2]], axis=0)
    ahead = _direction_of_jaws(model, data, palm, middle)
    ajar = _placed(model, closed + JUST_OPEN * (opened - closed))
    across = _center(model, ajar, faces[0]) - _center(model, data, faces[0])
    across -= (across @ ahead) * ahead
    return middle, across / np.linalg.norm(across), ahead


def _placed(model: Any, positions: FloatArray) -> Any:
    data = mujoco.MjData(model)
    data.qpos[:] = positions
    mujoco.mj_kinematics(model, data)
    return data


def _center(model: Any, data: Any, face: Sequence[str]) -> FloatArray:
    """Return the mean place (m) of the shapes of a gripping face."""
    center: FloatArray = np.mean([data.geom_xpos[model.geom(name).id] for name in face], axis=0)
    return center


def _direction_out(model: Any, data: Any, palm: int, middle: FloatArray, across: FloatArray) -> FloatArray:
    """Return the direction out of a hand, perpendicular to the closing direction ``across``, shape (3,) each.

    It leads to the ``middle`` (m) of the faces from the palm. If the frame of the palm is between its fingers, it leads
    there from the nearest body before the palm that is farther away.
    """
    axes, body = data.xmat[palm].reshape(3, 3), palm
    while body:
        away = middle - data.xpos[body]
        away = away - (away @ across) * across
        length = float(np.linalg.norm(away))
        if length > BETWEEN_FINGERS:
            return away / length if body == palm else _straightened(away / length, axes)
        body = int(model.body_parentid[body])
    return axes[:, 2]


def _direction_of_jaws(model: Any, data: Any, palm: int, middle: FloatArray) -> FloatArray:
    """Return the direction out of a hand on which one jaw closes: the axis on which it turns if that leads to the jaws.

    Jaws that are closed lie askew, and an arm of five axes can point only this axis straight down.
    """
    away = middle - data.xpos[palm]
    away /= np.linalg.norm(away)
    joint = int(model.body_jntadr[palm])
    if joint >= 0:
        axis: FloatArray = data.xaxis[joint] * np.sign(data.xaxis[joint] @ away or 1.0)
        if float(axis @ away) > ALONG:
            return axis
    return _straightened(away, data.xmat[palm].reshape(3, 3))


def outwards(model: Any, data: Any, palm: int, place: FloatArray, axis: FloatArray) -> FloatArray:
    """Return the axis of a suction cup in the sense that leads out of the arm, shape (3,).

    It leads to the ``place`` (m) of the cup from the palm or, if the frame of the palm is in the plane of the cup, from
    the nearest body before it whose frame is not.
    """
    body = palm
    while body:
        along = float((place - data.xpos[body]) @ axis)
        if abs(along) > FLAT:
            return axis if along > 0.0 else -axis
        body = int(model.body_parentid[body])
    return axis


def _straightened(direction: FloatArray, axes: FloatArray) -> FloatArray:
    """Return the axis of a frame (columns, shape (3, 3)) that a direction is near to, else the direction, shape (3,).

    Arms of five axes can point only the axis of their last joint straight down.
    """
    near = max((*axes.T, *-axes.T), key=lambda axis: float(axis @ direction))
    return near if float(near @ direction) > STRAIGHT else direction
