"""How far something has moved along its path."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

PIECE = 20
"""Errors across a piece of this many errors lengthen it by less than 1 %."""


def path_length(positions: FloatArray) -> FloatArray:
    """Return the distance (m) travelled along positions (n, 3) m up to each of them, shape (n,), starting at 0."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))])


def length_beyond_errors(positions: FloatArray, error: float) -> FloatArray:
    """Return how long (m) a path is up to each of its observed positions (n, 3) m, without their errors, shape (n,).

    Each position is at most ``error`` (m) from the true one. The path is measured between points that are ``PIECE``
    errors apart, and to points where it turns back by more than two errors, of which two errors are not counted. What
    does not move has a length of 0. A straight path is measured at most four errors too short, and two too long.
    """
    found = np.zeros(len(positions))
    begin: list[float] = positions[0].tolist()
    farthest, away, length = begin, 0.0, 0.0
    for row, place in enumerate(positions.tolist()):
        distance, back = math.dist(begin, place), math.dist(farthest, place)
        if back > 2 * error and (distance <= away or back > distance):
            length, begin = length + max(away - 2 * error, 0.0), farthest
            farthest, away = place, back
        elif distance > away:
            farthest, away = place, distance
        if away > PIECE * error:
            length, begin, away = length + away, farthest, 0.0
        found[row] = length + max(away - 2 * error, 0.0)
    return found
