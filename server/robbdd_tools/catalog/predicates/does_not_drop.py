"""An agent does not drop an object."""

from robbdd_tools.catalog.api import Kind, Predicate, Slot

DOES_NOT_DROP = Predicate(
    name="does-not-drop",
    phrase="<agent> does not drop <object>",
    rdf_type="bdd:DoesNotDropPredicate",
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
    ),
    sentence='"{agent}" does not drop "{object}"',
    unit="",
    doc="The agent keeps hold of the object until it rests on a workspace.",
)
