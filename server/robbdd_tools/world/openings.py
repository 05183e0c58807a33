"""How the things of a scene open: the joint of each, and the positions at which it counts as closed and as open."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING

from robbdd_tools.base.articulation import CLOSED_SHARE, OPEN_SHARE, Opening
from robbdd_tools.base.quantity_units import QuantityError, read_quantity
from robbdd_tools.catalog.executable import OpeningModel
from robbdd_tools.world.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robbdd_tools.base.articulation import PassiveJoint
    from robbdd_tools.catalog.executable import ModelSource

NEARER = 0.25
"""An end of a joint's range is the closed one if the file's position is within this share of the range from it."""
DIMENSIONS = {"slide": "length", "hinge": "angle"}
OVERRIDE = "state them in its model: opening { joint: … closed: … open: … }"


def opening_of(
    element: str, joints: Mapping[str, tuple[str, PassiveJoint]], source: ModelSource | None
) -> Opening | str:
    """Return how an element opens, or the reason why this is not known.

    ``joints`` maps the name of each joint in the file to the moving element and its joint. Raises ``SceneError`` if the
    data in the scene instance do not fit the file.
    """
    stated = (source.opening if source is not None else None) or OpeningModel()
    origin = None if source is None else source.origin
    if stated.joint and stated.joint not in joints:
        known = ", ".join(sorted(joints)) or "no joint that moves it"
        raise SceneError(f"'{element}' opens with the joint '{stated.joint}', but its file has {known}", origin=origin)
    if not stated.joint and len(joints) != 1:
        if stated != OpeningModel():
            raise SceneError(f"'{element}' has {len(joints)} joints, not one: {OVERRIDE}", origin=origin)
        return f"{element} has several joints: {OVERRIDE}" if joints else f"{element} has no joint"
    part, joint = joints[stated.joint] if stated.joint else next(iter(joints.values()))
    try:
        dimension = DIMENSIONS[joint.kind]
        closed, opened = (read_quantity(text, dimension).si if text else None for text in (stated.closed, stated.open))
    except QuantityError as error:
        raise SceneError(f"the joint of '{element}' is a {joint.kind}: {error}", origin=origin) from error
    if closed is not None and closed == opened:
        raise SceneError(f"the closed and the open position of '{element}' must differ", origin=origin)
    ends = _ends(joint, closed, opened)
    if ends is None:
        return f"which end of the joint of {element} is the closed one is not known: {OVERRIDE}"
    start, end = ends
    closed = start + CLOSED_SHARE * (end - start) if closed is None else closed
    opened = start + OPEN_SHARE * (end - start) if opened is None else opened
    if (opened - closed) * (end - start) <= 0:
        raise SceneError(f"'{element}' counts as open before it no longer counts as closed", origin=origin)
    low, high = sorted(ends)
    if not (low <= closed <= high and low <= opened <= high):
        unit, factor = ("m", 1.0) if joint.kind == "slide" else ("deg", degrees(1.0))
        which, value = ("open", opened) if low <= closed <= high else ("closed", closed)
        span = f"{factor * low:.4g} to {factor * high:.4g} {unit}"
        text = f"'{which}' of '{element}', {factor * value:.4g} {unit}, is outside of the range of its joint: {span}"
        raise SceneError(text, origin=origin)
    return Opening(part, joint.kind, ends, closed, opened)


def _ends(joint: PassiveJoint, closed: float | None, opened: float | None) -> tuple[float, float] | None:
    """Return the fully closed and the fully open position, ``None`` if they are not known.

    The file shows a thing closed. So the end of the range nearer to the position in the file is the closed one.
    """
    if joint.bounds is None:
        return None if closed is None or opened is None else (closed, opened)
    low, high = joint.bounds
    if closed is not None and opened is not None:
        return (low, high) if opened > closed else (high, low)
    share = (joint.zero - low) / (high - low)
    if share <= NEARER:
        return low, high
    return (high, low) if share >= 1 - NEARER else None
