"""An agent does not collide with a target: the way that the target is pushed (paper), or the force on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import carriers_of, limit_of, path_length

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

LIMIT = 0.05
"""Metres of accumulated displacement that still count as untouched (paper, section on the experiment)."""
UNITS = {"displacement_limit": "m", "force_limit": "N"}
"""What either variant measures, by the name of the configuration that bounds it."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit minus the path (m) that the target has travelled since the window opened, shape (n,).

    Where the target has a ``force_limit``: that limit minus the contact force (N). A target that is a workspace
    stands for the objects that carry it; the one that moved, or was pressed, most counts.
    """
    import numpy as np

    carriers = carriers_of(evidence, str(arguments["target"]))
    allowed = limit_of(evidence, carriers, "force_limit")
    if allowed is not None:
        forces = [evidence.force(str(arguments["agent"]), carrier) for carrier in carriers]
        return allowed - np.max(forces, axis=0)
    limit = limit_of(evidence, carriers, "displacement_limit")
    travelled = [path_length(evidence.position(carrier)) for carrier in carriers]
    return (LIMIT if limit is None else limit) - np.max(travelled, axis=0)


def unit(evidence: Evidence, arguments: Arguments) -> str:
    """Return newtons where the target has a ``force_limit``, else metres."""
    by_force = limit_of(evidence, carriers_of(evidence, str(arguments["target"])), "force_limit") is not None
    return UNITS["force_limit" if by_force else "displacement_limit"]


DOES_NOT_COLLIDE = Predicate(
    name="does-not-collide",
    phrase="<agent> does not collide <target>",
    rdf_type="bdd:DoesNotCollidePredicate",
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("target", Kind.ANY, "bdd:target"),
    ),
    sentence='"{agent}" does not collide "{target}"',
    unit="m",
    doc=(
        "The target is not pushed: the path it travels within the window stays below 0.05 m (displacement_limit) or, "
        "with a force_limit, the contact force below that."
    ),
    evaluate=margin,
    unit_for=unit,
)
