"""An element is nearer than a distance to another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit, read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import distance_between

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Given distance minus the distance of the two positions, in the unit of the given distance, shape (n,)."""
    bound = read_limit(str(arguments["distance"]), "length")
    return (bound.si - distance_between(evidence, str(arguments["one"]), str(arguments["other"]))) / bound.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the distance in the clause."""
    return read_quantity(str(arguments["distance"]), "length").unit


IS_NEARER_THAN = Predicate(
    name="is-nearer-than",
    phrase="<one> is nearer than #distance to <other>",
    rdf_type="rbw:IsNearerThanPredicate",
    synonyms=("near", "close", "closer", "close to", "next to", "at most"),
    slots=(
        Slot("one", Kind.ANY, "rbw:ref-one"),
        Slot("distance", Kind.QUANTITY, "rbw:distance", "length", unsigned=True),
        Slot("other", Kind.ANY, "rbw:ref-other"),
    ),
    sentence='"{one}" is nearer than "{distance}" to "{other}"',
    unit="m",
    doc="The positions of two elements (centre of an object, tool of an agent) are less than a distance apart.",
    measured="length",
    evaluate=margin,
    pointwise=True,
    unit_for=unit,
)
