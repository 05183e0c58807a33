"""Geometry that several evaluators share. numpy is imported at the first evaluation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.catalog.settings import setting_of
from robbdd_tools.monitor.unobserved import Unobserved

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments, Evidence, FloatArray, Outline, Region, Vector


GAP = "gap"
"""Name of the quantity of the predicate about gaps: distances of surfaces, which are measured on demand."""
CONTACT = 1e-3
"""An object at rest may penetrate its support this deep (m): settled contacts of the simulation stay below it."""


def refuse_empty_sets(arguments: Arguments) -> None:
    """Raise ``Unobserved`` if a set among the arguments has no elements: such a clause says nothing."""
    for slot, value in arguments.items():
        if not value:
            raise Unobserved(f"the set of {slot} is empty")


def into_frame(points: FloatArray, origin: FloatArray, orientation: FloatArray) -> FloatArray:
    """Return world points (n, 3) in other frames.

    The frames are given by their origins (n, 3) and orientations as unit quaternions (w, x, y, z) (n, 4).
    """
    relative = points - origin
    axis = -orientation[:, 1:]
    twice = 2.0 * cross(axis, relative)
    return relative + orientation[:, :1] * twice + cross(axis, twice)


def out_of_frame(point: Vector, origin: FloatArray, orientation: FloatArray) -> FloatArray:
    """Return the world position, shape (n, 3), of a point that is fixed in moving frames (see ``into_frame``)."""
    import numpy as np

    relative = np.tile(np.asarray(point), (len(origin), 1))
    axis = orientation[:, 1:]
    twice = 2.0 * cross(axis, relative)
    return origin + relative + orientation[:, :1] * twice + cross(axis, twice)


def cross(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the cross products of vectors (n, 3).

    The result is bit-identical to ``numpy.cross``, which spends most of its time on general shapes: half of the time of
    judging where an object is.
    """
    import numpy as np

    product = np.empty(np.broadcast_shapes(first.shape, second.shape))
    for axis, (one, other) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.multiply(first[:, one], second[:, other], out=product[:, axis])
        product[:, axis] -= first[:, other] * second[:, one]
    return product


def inside_margin(
    evidence: Evidence, name: str, workspaces: Iterable[str], outline: Outline | None = None
) -> FloatArray:
    """Return the distance (m) from a body to the nearest face of some workspaces' space, positive inside, shape (n,).

    The space of a workspace is the union of the regions of its objects and of the workspaces composed into it, minus
    the parts that are inside other regions with a higher floor: an object on a shelf is on the shelf, not on the table
    below. The body's position counts. With an ``outline`` or the configuration ``whole_object``, its whole outline
    counts, except at the lowest face, which carries the body. Regions that the body itself carries are ignored. Raises
    ``KeyError`` for a workspace without regions other than the body's own.
    """
    import numpy as np

    position = evidence.position(name)
    if outline is None:
        outline = evidence.outline(name) if is_configured(evidence, name, "whole_object") else ()
    balls = [(out_of_frame(center, position, evidence.orientation(name)), radius) for center, radius in outline]
    own = _without(name, (place for workspace in workspaces for place in _space(evidence, workspace)))
    if not own:
        raise KeyError(name)
    every = _without(name, (place for workspace in evidence.workspaces for place in evidence.regions(workspace)))
    others = [(_floor(evidence, other), _into(evidence, other, position)) for other in every if other not in own]
    margins = np.full(len(position), -np.inf)
    for place in own:
        region, frame = place[1], _frame(evidence, place)
        inside = _into(evidence, place, position)
        for centers, radius in balls:
            local = into_frame(centers, *frame)
            local[:, 2] = np.maximum(local[:, 2], region.center[2])
            inside = np.minimum(inside, _signed_distance(_outside(local, region)) - radius)
        floor = _floor(evidence, place) if others else 0.0
        for higher, taken in others:
            inside = np.where(higher > floor, np.minimum(inside, -taken), inside)
        margins = np.maximum(margins, inside)
    return margins


def farthest_point(evidence: Evidence, name: str) -> float:
    """Return the largest distance (m) of a point of an object from its position. Raises ``KeyError`` like ``whole``."""
    from math import hypot

    return max(hypot(*center) + radius for center, radius in whole(evidence, name))


def outline_in_world(evidence: Evidence, name: str) -> tuple[FloatArray, FloatArray]:
    """Return the balls of an object's outline: centres in the world (k, n, 3) and radii (k,), m.

    Raises ``KeyError`` like ``whole``.
    """
    import numpy as np

    position, orientation, balls = evidence.position(name), evidence.orientation(name), whole(evidence, name)
    centers = np.array([out_of_frame(center, position, orientation) for center, _ in balls])
    return centers, np.array([radius for _, radius in balls])


def whole(evidence: Evidence, name: str) -> Outline:
    """Return the outline of an object. Raises ``KeyError`` if it is unknown: its position is not enough."""
    outline = evidence.outline(name)
    if not outline:
        raise KeyError(f"outline of {name}")
    return outline


def _without(carrier: str, places: Iterable[tuple[str, Region]]) -> dict[tuple[str, Region], None]:
    """Return each region once and in order, without the regions of one carrier."""
    return dict.fromkeys(place for place in places if place[0] != carrier)


def _space(evidence: Evidence, workspace: str) -> Iterator[tuple[str, Region]]:
    """Yield the regions of a workspace's objects and of the workspaces inside it. Raises ``KeyError``."""
    inner = [name for name in evidence.contents(workspace) if name in evidence.workspaces]
    if workspace in evidence.workspaces or not inner:
        yield from evidence.regions(workspace)
    for name in inner:
        yield from evidence.regions(name)


def _into(evidence: Evidence, place: tuple[str, Region], position: FloatArray) -> FloatArray:
    """Return the distance (m) of points (n, 3) to the faces of a region, positive inside, shape (n,).

    A point less than ``CONTACT`` below the bottom counts as on it.
    """
    region = place[1]
    local = into_frame(position, *_frame(evidence, place))
    bottom = region.center[2] - region.half[2]
    resting = (local[:, 2] < bottom) & (local[:, 2] >= bottom - CONTACT)
    local[resting, 2] = bottom
    return _signed_distance(_outside(local, region))


def _floor(evidence: Evidence, place: tuple[str, Region]) -> FloatArray:
    """Return the height (m, world frame) of the centre of a region's bottom, shape (n,)."""
    region = place[1]
    x, y, z = region.center
    bottom = (x, y, z - region.half[2])
    return out_of_frame(bottom, *_frame(evidence, place))[:, 2]


def _frame(evidence: Evidence, place: tuple[str, Region]) -> tuple[FloatArray, FloatArray]:
    """Return origins (n, 3) m and orientations (n, 4) of a frame in which a region's edges are along the axes.

    It is the frame of the carrier, rotated about the centre of the region.
    """
    import numpy as np

    carrier, region = place
    position, orientation = evidence.position(carrier), evidence.orientation(carrier)
    if not region.turn:
        return position, orientation
    w, x, y, z = region.turn
    turned = orientation @ np.array([[w, x, y, z], [-x, w, -z, y], [-y, z, w, -x], [-z, -y, x, w]])
    center = out_of_frame(region.center, position, orientation)
    return center - out_of_frame(region.center, np.zeros_like(position), turned), turned


def limit_of(evidence: Evidence, elements: Iterable[str], name: str) -> float | None:
    """Return the smallest value of a configuration among some elements; ``None`` if none of them has it."""
    found: list[float] = []
    for element in elements:
        try:
            found.append(setting_of(name).read(evidence.setting(element, name))[0])
        except KeyError:
            continue
    return min(found, default=None)


def is_configured(evidence: Evidence, element: str, name: str) -> bool:
    """Return whether a Boolean configuration of an element is set."""
    return limit_of(evidence, (element,), name) == 1.0


def carriers_of(evidence: Evidence, target: str) -> list[str]:
    """Return the objects that carry a workspace. For any other target, return the target itself."""
    try:
        return [carrier for carrier, _ in evidence.regions(target)]
    except KeyError:
        return [target]


def distance_between(evidence: Evidence, one: str, other: str) -> FloatArray:
    """Return the distance (m) of the positions of two elements at each sample, shape (n,).

    The objects that carry a workspace represent it; the nearest object counts.
    """
    import numpy as np

    pairs = [(a, b) for a in carriers_of(evidence, one) for b in carriers_of(evidence, other)]
    return np.min([np.linalg.norm(evidence.position(a) - evidence.position(b), axis=1) for a, b in pairs], axis=0)


def only_position(evidence: Evidence, target: str) -> FloatArray:
    """Return the position of an element, or of the object that carries a workspace, m, shape (n, 3).

    Raises ``KeyError`` if several objects carry the workspace, because it then has no single position.
    """
    carriers = list(dict.fromkeys(carriers_of(evidence, target)))
    if len(carriers) != 1:
        raise KeyError(f"one place of {target}")
    return evidence.position(carriers[0])


def distance_from_segment(point: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the distance (m) of points from straight lines that end at ``start`` and ``end``, all (n, 3), as (n,)."""
    import numpy as np

    along, offset = end - start, point - start
    square = np.sum(along * along, axis=1)
    share = np.clip(np.sum(offset * along, axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return np.linalg.norm(offset - share[:, None] * along, axis=1)


def _outside(local: FloatArray, region: Region) -> FloatArray:
    """Return how far (m) points (n, 3) in a region's frame are beyond each pair of faces, negative inside, (n, 3)."""
    import numpy as np

    return np.abs(local - np.asarray(region.center)) - np.asarray(region.half)


def _signed_distance(outside: FloatArray) -> FloatArray:
    """Return the margin (m) of points from how far they are beyond each pair of faces (n, 3): positive inside, the
    negative Euclidean distance outside."""
    import numpy as np

    beyond = np.linalg.norm(np.maximum(outside, 0.0), axis=1)
    inside: FloatArray = -outside.max(axis=1)
    return np.where(beyond > 0.0, -beyond, inside)
