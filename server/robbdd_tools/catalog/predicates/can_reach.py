"""An agent can reach an object."""

from robbdd_tools.catalog.api import Kind, Predicate, Slot

CAN_REACH = Predicate(
    name="can-reach",
    phrase="<agent> can reach <object>",
    rdf_type="bdd:CanReach",
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
    ),
    sentence='"{agent}" can reach "{object}"',
    unit="",
    doc="The agent has a collision-free grasp pose for the object within its joint limits.",
)
