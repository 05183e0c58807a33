"""An agent keeps its joints away from their limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the joints' smallest distance from their limits minus the given one, % of the joint's range, (n,)."""
    bound = read_limit(str(arguments["share"]), "ratio")
    return (evidence.joint_clearance(str(arguments["agent"])) - bound.si) / bound.factor


KEEPS_JOINTS_FROM_LIMITS = Predicate(
    name="keeps-joints-from-limits",
    phrase="<agent> keeps its joints #share from their limits",
    rdf_type="rbw:KeepsJointsFromLimitsPredicate",
    synonyms=("joint limits", "joint", "joints"),
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("share", Kind.QUANTITY, "rbw:share", "ratio", unsigned=True),
    ),
    sentence='"{agent}" keeps its joints "{share}" from their limits',
    unit="%",
    doc="Each joint of the arm is at least a share of its range, such as 5 %, away from its position limits.",
    evaluate=margin,
)
