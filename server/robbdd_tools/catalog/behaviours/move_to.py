"""Move a mobile robot to a workspace."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

MOVE_TO = Behaviour(
    name="move-to",
    phrase="<agent> moves to <workspace>",
    rdf_types=("rbw:MoveTo",),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("workspace", Kind.WORKSPACE, "bhv:target-workspace"),
    ),
    sentence='"{agent}" moves to "{workspace}"',
    events=("move-start", "move-end"),
    doc="The mobile base of the agent drives, with what the arm holds, to where the arm reaches the workspace.",
    synonyms=("goes", "drives", "navigates", "travels", "walks"),
)
