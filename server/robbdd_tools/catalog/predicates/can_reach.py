"""An agent can reach an object."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Distance (rad) of the best clear grasp of the object to the nearest joint limit, -π without any, shape (n,)."""
    return evidence.reach(str(arguments["agent"]), str(arguments["object"]))


CAN_REACH = Predicate(
    name="can-reach",
    phrase="<agent> can reach <object>",
    rdf_type="bdd:CanReach",
    synonyms=("reachable", "reaches", "reach"),
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
    ),
    sentence='"{agent}" can reach "{object}"',
    unit="rad",
    doc="The agent has a collision-free grasp pose for the object within its joint limits.",
    measured="nothing",
    evaluate=margin,
    quantities=("reach",),
)
