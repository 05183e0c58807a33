"""Geometry that several evaluators share; numpy is imported when the first of them runs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.catalog.settings import setting_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Evidence, FloatArray, Region, Vector


def into_frame(points: FloatArray, origin: FloatArray, orientation: FloatArray) -> FloatArray:
    """Express world points (n, 3) in frames given by origins (n, 3) and unit quaternions (w, x, y, z) (n, 4)."""
    import numpy as np

    relative = points - origin
    axis = -orientation[:, 1:]
    twice = 2.0 * np.cross(axis, relative)
    return relative + orientation[:, :1] * twice + np.cross(axis, twice)


def out_of_frame(point: Vector, origin: FloatArray, orientation: FloatArray) -> FloatArray:
    """Express a point of moving frames, given as in ``into_frame``, in the world, shape (n, 3)."""
    import numpy as np

    relative = np.tile(np.asarray(point), (len(origin), 1))
    axis = orientation[:, 1:]
    twice = 2.0 * np.cross(axis, relative)
    return origin + relative + orientation[:, :1] * twice + np.cross(axis, twice)


def inside_margin(evidence: Evidence, name: str, workspaces: Iterable[str]) -> FloatArray:
    """Distance (m) of a body to the nearest face of the best region, positive inside, shape (n,).

    The body's position counts; with the configuration ``whole_object`` all of it does, but at the lowest face, which
    carries it.
    """
    import numpy as np

    position = evidence.position(name)
    outline = evidence.outline(name) if is_configured(evidence, name, "whole_object") else ()
    balls = [(out_of_frame(center, position, evidence.orientation(name)), radius) for center, radius in outline]
    margins = np.full(len(position), -np.inf)
    for workspace in workspaces:
        for carrier, region in evidence.regions(workspace):
            frame = evidence.position(carrier), evidence.orientation(carrier)
            inside = _signed_distance(_outside(into_frame(position, *frame), region))
            for centers, radius in balls:
                local = into_frame(centers, *frame)
                local[:, 2] = np.maximum(local[:, 2], region.center[2])
                inside = np.minimum(inside, _signed_distance(_outside(local, region)) - radius)
            margins = np.maximum(margins, inside)
    return margins


def limit_of(evidence: Evidence, elements: Iterable[str], name: str) -> float | None:
    """Return the smallest value of a configuration among elements, ``None`` when none of them has it."""
    found: list[float] = []
    for element in elements:
        try:
            found.append(setting_of(name).read(evidence.setting(element, name))[0])
        except KeyError:
            continue
    return min(found, default=None)


def is_configured(evidence: Evidence, element: str, name: str) -> bool:
    """Tell whether a yes-or-no configuration of an element says yes."""
    return limit_of(evidence, (element,), name) == 1.0


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


def _outside(local: FloatArray, region: Region) -> FloatArray:
    """How far points (n, 3) of a region's frame lie beyond each pair of its faces, m, negative within, (n, 3)."""
    import numpy as np

    return np.abs(local - np.asarray(region.center)) - np.asarray(region.half)


def _signed_distance(outside: FloatArray) -> FloatArray:
    """Margin of points whose overhang beyond each pair of faces is given (n, 3): inside > 0, Euclidean outside."""
    import numpy as np

    beyond = np.linalg.norm(np.maximum(outside, 0.0), axis=1)
    inside: FloatArray = -outside.max(axis=1)
    return np.where(beyond > 0.0, -beyond, inside)
