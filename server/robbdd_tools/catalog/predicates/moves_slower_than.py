"""An agent's tool moves slower than a limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit, read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit minus the speed of the agent's tool since the previous sample, in the unit of the limit, shape (n,)."""
    import numpy as np

    limit = read_limit(str(arguments["limit"]), "speed")
    speed = np.linalg.norm(evidence.velocity(str(arguments["agent"])), axis=1)
    return (limit.si - speed) / limit.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the limit in the clause."""
    return read_quantity(str(arguments["limit"]), "speed").unit


MOVES_SLOWER_THAN = Predicate(
    name="moves-slower-than",
    phrase="<agent> moves slower than #limit",
    rdf_type="rbw:MovesSlowerThanPredicate",
    synonyms=("speed", "velocity", "slow", "slowly", "fast", "faster"),
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("limit", Kind.QUANTITY, "rbw:limit", "speed", unsigned=True),
    ),
    sentence='"{agent}" moves slower than "{limit}"',
    unit="m/s",
    doc="The agent's tool moves slower than a speed, such as 0.25 m/s.",
    measured="speed",
    evaluate=margin,
    pointwise=True,
    unit_for=unit,
)
