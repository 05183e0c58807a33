"""Pick an object."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

PICK = Behaviour(
    name="pick",
    phrase="<agent> picks <object>",
    rdf_types=("bhv:Pick",),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("object", Kind.OBJECT, "bhv:target-object"),
    ),
    sentence='"{agent}" picks "{object}"',
    events=("pick-start", "pick-end"),
    doc="The agent grasps the object at its place and lifts it.",
    synonyms=("grabs", "grips", "grasps", "takes", "lifts", "fetches", "collects"),
)
