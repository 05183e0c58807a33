"""An object is inside a workspace with all of its body."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import inside_margin, whole

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the distance (m) of the object's outline to the nearest workspace face, positive inside, shape (n,).

    At the supporting face, only the object's position counts.
    """
    name = str(arguments["object"])
    return inside_margin(evidence, name, (str(arguments["workspace"]),), whole(evidence, name))


IS_ENTIRELY_INSIDE = Predicate(
    name="is-entirely-inside",
    phrase="<object> is entirely inside <workspace>",
    rdf_type="rbw:IsEntirelyInsidePredicate",
    synonyms=("fully in", "completely in", "wholly in", "inside", "contained"),
    slots=(
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
        Slot("workspace", Kind.WORKSPACE, "bdd:ref-workspace"),
    ),
    sentence='"{object}" is entirely inside "{workspace}"',
    unit="m",
    doc="The whole object lies inside the workspace: nothing sticks out at the sides or at the top.",
    measured="length",
    evaluate=margin,
    pointwise=True,
)
