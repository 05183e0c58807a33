"""Hand an object over to another agent."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

HAND_OVER = Behaviour(
    name="hand-over",
    phrase="<agent> hands over <object> to <receiver>",
    rdf_types=("rbw:HandOver",),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("object", Kind.OBJECT, "bhv:target-object"),
        Slot("receiver", Kind.AGENT, "rbw:receiving-agent"),
    ),
    sentence='"{agent}" hands over "{object}" to "{receiver}"',
    events=("hand-over-start", "laid-down", "hand-over-end"),
    doc=(
        "The agent puts the object down at a place on a table that both arms reach, and moves aside; then the receiver "
        "grasps and lifts the object."
    ),
    synonyms=("gives", "passes", "handover", "transfers"),
)
