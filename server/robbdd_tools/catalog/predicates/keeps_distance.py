"""An element keeps a distance to another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import GAP, carriers_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the gap between two elements' surfaces minus the given distance, in the distance's unit, shape (n,).

    The objects that carry a workspace represent it; the nearest object counts. Raises ``KeyError`` if the gap was not
    measured.
    """
    import numpy as np

    bound = read_quantity(str(arguments["distance"]), "length")
    one, other = str(arguments["one"]), str(arguments["other"])
    pairs = [(a, b) for a in carriers_of(evidence, one) for b in carriers_of(evidence, other)]
    return (np.min([evidence.gap(*pair) for pair in pairs], axis=0) - bound.si) / bound.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the distance in the clause."""
    return read_quantity(str(arguments["distance"]), "length").unit


KEEPS_DISTANCE = Predicate(
    name="keeps-distance",
    phrase="<one> keeps a distance of #distance to <other>",
    rdf_type="rbw:KeepsDistancePredicate",
    synonyms=("keeps", "clear of", "clearance", "stays away"),
    slots=(
        Slot("one", Kind.ANY, "rbw:ref-one"),
        Slot("distance", Kind.QUANTITY, "rbw:distance", "length"),
        Slot("other", Kind.ANY, "rbw:ref-other"),
    ),
    sentence='"{one}" keeps a distance of "{distance}" to "{other}"',
    unit="m",
    doc="The surfaces of two elements, for an agent those of its whole arm, are at least a distance apart.",
    evaluate=margin,
    quantities=(GAP,),
    unit_for=unit,
)
