"""Place an object at a workspace."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

PLACE = Behaviour(
    name="place",
    phrase="<agent> places <object> at <workspace>",
    rdf_types=("bhv:Place",),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("object", Kind.OBJECT, "bhv:target-object"),
        Slot("workspace", Kind.WORKSPACE, "bhv:target-workspace"),
    ),
    sentence='"{agent}" places "{object}" at "{workspace}"',
    events=("place-start", "place-end"),
    doc="The agent carries the held object to the workspace and releases it there.",
    synonyms=("puts", "sets", "drops", "lays", "releases", "deposits"),
)
