"""An object is located at a workspace (paper, section on the experiment: position against 3D bounds)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import inside_margin

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the distance (m) of the object's position to the nearest workspace face, positive inside, shape (n,).

    Several regions of a workspace count as their union. With the configuration ``whole_object``, the whole object
    counts.
    """
    return inside_margin(evidence, str(arguments["object"]), (str(arguments["workspace"]),))


LOCATED_AT = Predicate(
    name="located-at",
    phrase="<object> is located at <workspace>",
    rdf_type="bdd:LocatedAtPredicate",
    synonyms=("in", "into", "inside", "at", "placed", "put", "sits", "lies", "is at", "positioned"),
    slots=(
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
        Slot("workspace", Kind.WORKSPACE, "bdd:ref-workspace"),
    ),
    sentence='"{object}" is located at "{workspace}"',
    unit="m",
    doc="The object's position (with whole_object its whole body) lies inside a bin, or above a table top.",
    measured="length",
    evaluate=margin,
    pointwise=True,
)
