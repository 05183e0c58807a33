"""Pick an object and place it at a workspace."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

PICK_PLACE = Behaviour(
    name="pick-place",
    phrase="<agent> picks <object> and places at <workspace>",
    rdf_types=("bhv:Pick", "bhv:Place"),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("object", Kind.OBJECT, "bhv:target-object"),
        Slot("workspace", Kind.WORKSPACE, "bhv:target-workspace"),
    ),
    sentence='"{agent}" picks "{object}" and places it at "{workspace}"',
    events=("pick-start", "pick-end", "place-start", "place-end"),
    doc="The agent grasps the object at its place, carries it to the workspace and releases it there.",
    aliases=("<agent> picks <object> and places it at <workspace>",),
    synonyms=("brings", "carries", "transports", "delivers", "loads", "puts", "grabs and", "takes and"),
)
