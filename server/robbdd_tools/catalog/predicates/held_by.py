"""An object is held by an agent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return 1 where the gripping faces hold the object and -1 elsewhere, shape (n,)."""
    return 2.0 * evidence.gripped(str(arguments["agent"]), str(arguments["object"])) - 1.0


HELD_BY = Predicate(
    name="held-by",
    phrase="<object> is held by <agent>",
    rdf_type="bdd:IsHeldPredicate",
    synonyms=(
        "hold",
        "holds",
        "holding",
        "grip",
        "grips",
        "gripped",
        "grasp",
        "grasps",
        "grasped",
        "carries",
        "carried",
        "picked up",
        "in the hand",
    ),
    slots=(
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
    ),
    sentence='"{object}" is held by "{agent}"',
    unit="",
    doc="The agent's gripping faces are in contact with the object from both sides.",
    measured="nothing",
    evaluate=margin,
    pointwise=True,
)
