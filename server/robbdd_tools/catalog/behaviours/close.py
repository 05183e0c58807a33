"""Close a thing with a joint."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

CLOSE = Behaviour(
    name="close",
    phrase="<agent> closes <object>",
    rdf_types=("rbw:Close",),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("object", Kind.OBJECT, "bhv:target-object"),
    ),
    sentence='"{agent}" closes "{object}"',
    events=("close-start", "close-end"),
    doc="The agent grips the handle of a drawer, door or lid, moves it until the thing is closed, and releases it.",
    synonyms=("shuts", "locks"),
)
