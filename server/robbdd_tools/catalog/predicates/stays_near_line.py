"""An element stays near the line between two others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit, read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import distance_from_segment, only_position

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the given distance minus the position's distance from the line, in the given unit, shape (n,).

    The line connects the positions of the two other elements at the same sample. Raises ``KeyError`` for a workspace
    that several objects carry.
    """
    bound = read_limit(str(arguments["distance"]), "length")
    point, start, end = (only_position(evidence, str(arguments[slot])) for slot in ("one", "origin", "destination"))
    return (bound.si - distance_from_segment(point, start, end)) / bound.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the distance in the clause."""
    return read_quantity(str(arguments["distance"]), "length").unit


STAYS_NEAR_LINE = Predicate(
    name="stays-near-line",
    phrase="<one> stays within #distance of the line from <origin> to <destination>",
    rdf_type="rbw:StaysNearLinePredicate",
    synonyms=("follows", "path", "straight line", "trajectory"),
    slots=(
        Slot("one", Kind.ANY, "rbw:ref-one"),
        Slot("distance", Kind.QUANTITY, "rbw:distance", "length", unsigned=True),
        Slot("origin", Kind.ANY, "rbw:ref-origin"),
        Slot("destination", Kind.ANY, "rbw:ref-destination"),
    ),
    sentence='"{one}" stays within "{distance}" of the line from "{origin}" to "{destination}"',
    unit="m",
    doc="The position (centre of an object, tool of an agent) is near the straight line between two other positions.",
    evaluate=margin,
    unit_for=unit,
)
