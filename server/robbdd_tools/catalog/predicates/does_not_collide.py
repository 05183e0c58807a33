"""An agent does not collide with a target (paper: accumulated displacement of the target)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import carriers_of, path_length

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

LIMIT = 0.05
"""Metres of accumulated displacement that still count as untouched (paper, section on the experiment)."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit minus the path (m) that the target has travelled since the window opened, shape (n,).

    A target that is a workspace stands for the objects that carry it; the one that moved most counts.
    """
    import numpy as np

    carriers = carriers_of(evidence, str(arguments["target"]))
    travelled = [path_length(evidence.position(carrier)) for carrier in carriers]
    return LIMIT - np.max(travelled, axis=0)


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
    doc="The target is not pushed: the path it travels within the window stays below 0.05 m.",
    evaluate=margin,
)
