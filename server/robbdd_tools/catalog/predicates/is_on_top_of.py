"""An object lies directly on another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.contacts import FAINTEST, TOUCH, contact_force
from robbdd_tools.catalog.geometry import outline_in_world

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

DIRECTIONS = 180
"""Number of horizontal directions in which a footprint is measured; it is at most 0.02 % too large."""
APART = 1e-4
"""The gap of objects that do not touch counts as at least this distance (m)."""
BESIDE = 1e-3
"""If the lowest point of an object is not this far (m) above that of the other one, the other one does not bear it."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return how far (m) the centre of ``one`` is above the top and within the footprint of ``other``, shape (n,).

    The smaller of the two values counts. Where the objects do not touch, the margin is at most their negative gap.
    Where ``one`` reaches down as far as ``other``, it stands beside or inside it, and the margin is negative.
    """
    import numpy as np

    one, other = str(arguments["one"]), str(arguments["other"])
    center = evidence.position(one)
    points, radii = outline_in_world(evidence, other)
    angles = np.arange(DIRECTIONS) * (2.0 * np.pi / DIRECTIONS)
    directions = np.array([np.cos(angles), np.sin(angles)])
    reach = np.max(points[:, :, :2] @ directions + radii[:, None, None], axis=0)
    footprint = np.min(reach - center[:, :2] @ directions, axis=1)
    top = np.max(points[:, :, 2] + radii[:, None], axis=0)
    own, own_radii = outline_in_world(evidence, one)
    bottom: FloatArray = np.min(own[:, :, 2] - own_radii[:, None], axis=0)
    above: FloatArray = bottom - np.min(points[:, :, 2] - radii[:, None], axis=0)
    gap = np.abs(bottom - top)
    placed = np.minimum(footprint, center[:, 2] - top)
    placed = np.where((above > BESIDE) | (placed < 0.0), placed, above - BESIDE - APART)
    touching = contact_force(evidence, arguments) >= FAINTEST
    apart: FloatArray = np.minimum(placed, -np.maximum(gap, APART))
    return np.where(touching, placed, apart)


IS_ON_TOP_OF = Predicate(
    name="is-on-top-of",
    phrase="<one> is on top of <other>",
    rdf_type="rbw:IsOnTopOfPredicate",
    synonyms=("on", "lies on", "stacked", "above", "rests on", "stands on"),
    slots=(Slot("one", Kind.OBJECT, "rbw:ref-one"), Slot("other", Kind.OBJECT, "rbw:ref-other")),
    sentence='"{one}" is on top of "{other}"',
    unit="m",
    doc="The object touches the other one and does not stand beside it, and its centre is above the other one's top "
    "and within its footprint.",
    evaluate=margin,
    quantities=(TOUCH,),
)
