"""The direction out of a hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

BETWEEN_FINGERS = 0.03
"""If the frame of the palm is at most this far (m) from the middle of the closed faces, it is between the fingers."""
STRAIGHT = np.cos(np.radians(10.0))
"""A direction out of the hand that is nearer than this (cosine of the angle) to an axis of the palm is that axis."""


def direction_out(model: Any, data: Any, palm: int, middle: FloatArray, across: FloatArray) -> FloatArray:
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


def _straightened(direction: FloatArray, axes: FloatArray) -> FloatArray:
    """Return the axis of a frame (columns, shape (3, 3)) that a direction is near to, else the direction, shape (3,).

    Arms of five axes can point only the axis of their last joint straight down.
    """
    near = max((*axes.T, *-axes.T), key=lambda axis: float(axis @ direction))
    return near if float(near @ direction) > STRAIGHT else direction
