"""The groups of an OBJ file: tools that cut meshes into convex pieces write a group for each piece."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robbdd_tools.catalog.api import FloatArray

Faces = NDArray[np.int64]
"""Triangles: numbers of corners from 0, shape (m, 3)."""

_BEGINNINGS = (b"\no ", b"\ng ")
FLAT = 1e-6
"""A group counts as flat if its extent in one direction is at most this share of the one in another direction."""
SPATIAL = 3
"""Coordinates of a corner."""


def closed_groups(content: bytes) -> tuple[FloatArray, ...]:
    """Return the corners (shape (n, 3)) of each group of an OBJ file if there are several, and all are closed surfaces.

    Otherwise, return nothing: the groups of a drawing may be its materials or its sides. Raises ``ValueError``.
    """
    if sum(content.count(beginning) for beginning in _BEGINNINGS) + content.startswith((b"o ", b"g ")) < 2:
        return ()
    groups = read_groups(content.decode("utf-8", "replace").splitlines())
    found = tuple(corners[np.unique(faces)] for corners, faces in groups if _is_closed(corners, faces))
    return found if len(found) == len(groups) > 1 and not any(map(_is_flat, found)) else ()


def read_groups(lines: Iterable[str]) -> list[tuple[FloatArray, Faces]]:
    """Return the corners (shape (n, 3)) of an OBJ file and the triangles (shape (m, 3), numbers from 0) of each group.

    Groups without faces are left out. Raises ``ValueError`` for what is no number, or no number of a corner.
    """
    corners: list[list[float]] = []
    groups: list[list[tuple[int, int, int]]] = [[]]
    for line in lines:
        kind, *words = line.split() or [""]
        if kind in ("o", "g"):
            groups.append([])
        elif kind == "v":
            corners.append([float(word) for word in words[:SPATIAL]])
        elif kind == "f":
            first, *others = (_number(word, len(corners)) for word in words)
            groups[-1] += [(first, one, other) for one, other in pairwise(others)]
    points = np.array(corners, dtype=float).reshape(-1, SPATIAL)
    found = [np.array(faces, dtype=np.int64) for faces in groups if faces]
    if any(faces.max() >= len(points) or faces.min() < 0 for faces in found):
        raise ValueError("a face has a corner that is not there")
    return [(points, faces) for faces in found]


def _number(word: str, known: int) -> int:
    """Return the number of a corner from 0; negative ones count from the last corner."""
    number = int(word.partition("/")[0])
    return number - 1 if number > 0 else known + number


def _is_flat(corners: FloatArray) -> bool:
    """Return whether corners are in a plane, so that they have no volume."""
    sizes = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    return bool(sizes[-1] <= FLAT * sizes[0])


def _is_closed(corners: FloatArray, faces: Faces) -> bool:
    """Return whether two triangles meet at each edge; corners at the same place count as one."""
    _, same = np.unique(corners, axis=0, return_inverse=True)
    merged: Faces = same.reshape(-1)[faces]
    edges: Faces = np.sort(np.concatenate([merged[:, [0, 1]], merged[:, [1, 2]], merged[:, [2, 0]]]), axis=1)
    _, uses = np.unique(edges[edges[:, 0] != edges[:, 1]], axis=0, return_counts=True)
    return uses.size > 0 and bool((uses == 2).all())
