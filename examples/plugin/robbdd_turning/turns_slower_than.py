"""An object turns slower than a limit: a cup that is swung spills, however slowly it moves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit minus the object's angular speed since the previous sample, in the unit of the limit, shape (n,)."""
    import numpy as np

    limit = read_quantity(str(arguments["limit"]), "angular speed")
    speed = np.abs(evidence.turning(str(arguments["object"])))
    return (limit.si - speed) / limit.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the limit in the clause."""
    return read_quantity(str(arguments["limit"]), "angular speed").unit


TURNS_SLOWER_THAN = Predicate(
    name="turns-slower-than",
    phrase="<object> turns slower than #limit",
    rdf_type="https://example.org/robbdd-turning/TurnsSlowerThanPredicate",
    slots=(
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
        Slot("limit", Kind.QUANTITY, "rbw:limit", "angular speed"),
    ),
    sentence='"{object}" turns slower than "{limit}"',
    unit="deg/s",
    doc="The object turns slower than an angular speed, such as 60 deg/s, about any axis.",
    evaluate=margin,
    unit_for=unit,
)
