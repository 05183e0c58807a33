"""An element is farther than a distance from another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit, read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import distance_between

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Distance of the two positions minus the given distance, in the unit of the given distance, shape (n,)."""
    bound = read_limit(str(arguments["distance"]), "length")
    return (distance_between(evidence, str(arguments["one"]), str(arguments["other"])) - bound.si) / bound.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the distance in the clause."""
    return read_quantity(str(arguments["distance"]), "length").unit


IS_FARTHER_THAN = Predicate(
    name="is-farther-than",
    phrase="<one> is farther than #distance from <other>",
    rdf_type="rbw:IsFartherThanPredicate",
    synonyms=("far", "far from", "away", "at least"),
    slots=(
        Slot("one", Kind.ANY, "rbw:ref-one"),
        Slot("distance", Kind.QUANTITY, "rbw:distance", "length", unsigned=True),
        Slot("other", Kind.ANY, "rbw:ref-other"),
    ),
    sentence='"{one}" is farther than "{distance}" from "{other}"',
    unit="m",
    doc="The positions of two elements (centre of an object, tool of an agent) are more than a distance apart.",
    measured="length",
    evaluate=margin,
    pointwise=True,
    unit_for=unit,
)
