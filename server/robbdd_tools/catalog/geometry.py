"""Geometry that several evaluators share; numpy is imported when the first of them runs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Evidence, FloatArray


def into_frame(points: FloatArray, origin: FloatArray, orientation: FloatArray) -> FloatArray:
    """Express world points (n, 3) in frames given by origins (n, 3) and unit quaternions (w, x, y, z) (n, 4)."""
    import numpy as np

    relative = points - origin
    axis = -orientation[:, 1:]
    twice = 2.0 * np.cross(axis, relative)
    return relative + orientation[:, :1] * twice + np.cross(axis, twice)


def inside_margin(evidence: Evidence, name: str, workspaces: Iterable[str]) -> FloatArray:
    """Distance (m) of a body's position to the nearest face of the best region, positive inside, shape (n,)."""
    import numpy as np

    position = evidence.position(name)
    margins = np.full(len(position), -np.inf)
    for workspace in workspaces:
        for carrier, region in evidence.regions(workspace):
            local = into_frame(position, evidence.position(carrier), evidence.orientation(carrier))
            outside = np.abs(local - np.asarray(region.center)) - np.asarray(region.half)
            margins = np.maximum(margins, _signed_distance(outside))
    return margins


def carriers_of(evidence: Evidence, target: str) -> list[str]:
    """Return the objects that a workspace stands for, for anything else the target itself."""
    try:
        return [carrier for carrier, _ in evidence.regions(target)]
    except KeyError:
        return [target]


def path_length(positions: FloatArray) -> FloatArray:
    """Distance (m) travelled along positions (n, 3) up to each sample, shape (n,), starting at 0."""
    import numpy as np

    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _signed_distance(outside: FloatArray) -> FloatArray:
    """Margin of points whose overhang beyond each pair of faces is given (n, 3): inside > 0, Euclidean outside."""
    import numpy as np

    beyond = np.linalg.norm(np.maximum(outside, 0.0), axis=1)
    inside: FloatArray = -outside.max(axis=1)
    return np.where(beyond > 0.0, -beyond, inside)
