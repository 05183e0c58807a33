"""An agent does not collide with a target: the way that the target is pushed (paper), or the force on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import carriers_of, limit_of, path_length

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

LIMIT = 0.05
"""Metres of accumulated displacement that still count as untouched (paper, section on the experiment)."""
FORCE_LIMIT = 140.0
"""Newtons of contact force on what cannot be pushed. ISO/TS 15066:2016, table A.2: the largest permissible force of a
quasi-static contact with hands and fingers, which are what is clamped between an arm and a work surface.
"""
METRES, NEWTONS, SHARE = "m", "N", ""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return limit minus displacement (m) or limit minus contact force (N) at each sample, shape (n,).

    By force are judged a target that has a ``force_limit``, and one that is not pushed: a fixed object, or an agent;
    by displacement any other: the path that it has travelled since the window opened. A target that is a workspace
    stands for the objects that carry it; the one with the smallest margin counts. Where some of them can be pushed and
    others cannot, each margin is divided by its limit.
    """
    import numpy as np

    agent, carriers = str(arguments["agent"]), carriers_of(evidence, str(arguments["target"]))
    by_force, by_way = _split(evidence, carriers)
    force_limit = limit_of(evidence, carriers, "force_limit") or FORCE_LIMIT
    way_limit = limit_of(evidence, carriers, "displacement_limit") or LIMIT
    forces = [force_limit - evidence.force(agent, carrier) for carrier in by_force]
    ways = [way_limit - path_length(evidence.position(carrier)) for carrier in by_way]
    if forces and ways:
        return np.min([*(one / force_limit for one in forces), *(one / way_limit for one in ways)], axis=0)
    return np.min(forces or ways, axis=0)


def unit(evidence: Evidence, arguments: Arguments) -> str:
    """Return newtons for a target judged by force, metres for one judged by displacement, nothing for a mixed one."""
    by_force, by_way = _split(evidence, carriers_of(evidence, str(arguments["target"])))
    if by_force and by_way:
        return SHARE
    return NEWTONS if by_force else METRES


def _split(evidence: Evidence, carriers: list[str]) -> tuple[list[str], list[str]]:
    """Return the carriers that are judged by force, and those judged by displacement."""
    if limit_of(evidence, carriers, "force_limit") is not None:
        return carriers, []
    by_force = [carrier for carrier in carriers if evidence.is_immovable(carrier)]
    return by_force, [carrier for carrier in carriers if carrier not in by_force]


DOES_NOT_COLLIDE = Predicate(
    name="does-not-collide",
    phrase="<agent> does not collide <target>",
    rdf_type="bdd:DoesNotCollidePredicate",
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("target", Kind.ANY, "bdd:target"),
    ),
    sentence='"{agent}" does not collide "{target}"',
    unit=METRES,
    doc=(
        "The target is not pushed: the path it travels within the window stays below 0.05 m (displacement_limit). What "
        "cannot be pushed (a fixed object, an agent) is not hit: the contact force of the agent, and of what it grips "
        "beyond its weight, stays below 140 N (force_limit), the limit of ISO/TS 15066 for a hand that is clamped. "
        "With a force_limit, any target is judged by force."
    ),
    evaluate=margin,
    unit_for=unit,
)
