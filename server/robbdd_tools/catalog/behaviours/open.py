"""Open a thing with a joint."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

OPEN = Behaviour(
    name="open",
    phrase="<agent> opens <object>",
    rdf_types=("rbw:Open",),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("object", Kind.OBJECT, "bhv:target-object"),
    ),
    sentence='"{agent}" opens "{object}"',
    events=("open-start", "open-end"),
    doc="The agent grips the handle of a drawer, door or lid, moves it until the thing is open, and releases it.",
    synonyms=("pulls", "unlocks"),
)
