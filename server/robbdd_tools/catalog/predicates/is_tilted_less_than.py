"""An object is tilted less than an angle from upright."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit, read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit minus the angle between the object's z axis and the vertical, in the unit of the limit, shape (n,)."""
    import numpy as np

    limit = read_limit(str(arguments["limit"]), "angle")
    # The vertical component of the rotated z axis; rounding may exceed 1.
    _, x, y, _ = evidence.orientation(str(arguments["object"])).T
    tilt = np.arccos(np.clip(1.0 - 2.0 * (x**2 + y**2), -1.0, 1.0))
    return (limit.si - tilt) / limit.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the limit in the clause."""
    return read_quantity(str(arguments["limit"]), "angle").unit


IS_TILTED_LESS_THAN = Predicate(
    name="is-tilted-less-than",
    phrase="<object> is tilted less than #limit",
    rdf_type="rbw:IsTiltedLessThanPredicate",
    synonyms=("upright", "level", "tilt", "inclined", "vertical"),
    slots=(
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
        Slot("limit", Kind.QUANTITY, "rbw:limit", "angle", unsigned=True),
    ),
    sentence='"{object}" is tilted less than "{limit}"',
    unit="rad",
    doc="The object's own z axis deviates from the vertical by less than an angle, such as 10 deg.",
    measured="angle",
    evaluate=margin,
    pointwise=True,
    unit_for=unit,
)
