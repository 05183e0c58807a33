"""Push an object to a workspace."""

from robbdd_tools.catalog.api import Behaviour, Kind, Slot

PUSH = Behaviour(
    name="push",
    phrase="<agent> pushes <object> to <workspace>",
    rdf_types=("rbw:Push",),
    slots=(
        Slot("agent", Kind.AGENT, "bhv:target-agent"),
        Slot("object", Kind.OBJECT, "bhv:target-object"),
        Slot("workspace", Kind.WORKSPACE, "bhv:target-workspace"),
    ),
    sentence='"{agent}" pushes "{object}" to "{workspace}"',
    events=("push-start", "push-end"),
    doc="The agent pushes the object over its support with the closed gripper until it is in the workspace.",
    synonyms=("shoves", "slides", "presses", "pushes away"),
)
