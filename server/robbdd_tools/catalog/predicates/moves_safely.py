"""An agent moves safely: its tool stays slow."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import limit_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

LIMIT = 0.25
"""Largest speed (m/s) of the tool centre point next to people: the reduced speed of ISO 10218-1."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit (the agent's ``max_speed``, else ``LIMIT``) minus the speed of the agent's tool, m/s, shape (n,)."""
    import numpy as np

    agent = str(arguments["agent"])
    limit = limit_of(evidence, (agent,), "max_speed")
    return (LIMIT if limit is None else limit) - np.linalg.norm(evidence.velocity(agent), axis=1)


MOVES_SAFELY = Predicate(
    name="moves-safely",
    phrase="<agent> moves safely",
    rdf_type="bdd:MoveSafelyPredicate",
    slots=(Slot("agent", Kind.AGENT, "bdd:ref-agent"),),
    sentence='"{agent}" moves safely',
    unit="m/s",
    doc="The agent's tool is no faster than 0.25 m/s, the reduced speed of ISO 10218-1, or than its max_speed.",
    measured="speed",
    evaluate=margin,
)
