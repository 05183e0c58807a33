"""An agent does not collide with a target, judged by the target's displacement (paper) or by contact force."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import carriers_of, limit_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

LIMIT = 0.05
"""A target counts as untouched up to this accumulated displacement (m) (paper, section on the experiment)."""
FORCE_LIMIT = 140.0
"""Contact force (N) on an immovable target. ISO/TS 15066:2016, table A.2: the largest permissible force of a
quasi-static contact with hands and fingers, the body parts that an arm can clamp against a work surface."""
METRES, NEWTONS, SHARE = "m", "N", ""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return limit minus displacement (m) or limit minus contact force (N) at each sample, shape (n,).

    A target is judged by force if it has a ``force_limit`` or is immovable (a fixed object, or an agent), otherwise by
    displacement: the length of its path since the window opened. A workspace is represented by the objects that carry
    it; the smallest margin counts. If some of these objects are judged by force and others by displacement, each margin
    is divided by its limit.
    """
    import numpy as np

    agent, carriers = str(arguments["agent"]), carriers_of(evidence, str(arguments["target"]))
    by_force, by_way = _split(evidence, carriers)
    force_limit = limit_of(evidence, carriers, "force_limit") or FORCE_LIMIT
    way_limit = limit_of(evidence, carriers, "displacement_limit") or LIMIT
    forces = [force_limit - evidence.force(agent, carrier) for carrier in by_force]
    ways = [way_limit - evidence.travelled(carrier, way_limit) for carrier in by_way]
    if forces and ways:
        return np.min([*(one / force_limit for one in forces), *(one / way_limit for one in ways)], axis=0)
    return np.min(forces or ways, axis=0)


def unit(evidence: Evidence, arguments: Arguments) -> str:
    """Return newtons for a target judged by force, metres for displacement, and no unit for a mix."""
    by_force, by_way = _split(evidence, carriers_of(evidence, str(arguments["target"])))
    if by_force and by_way:
        return SHARE
    return NEWTONS if by_force else METRES


def _split(evidence: Evidence, carriers: list[str]) -> tuple[list[str], list[str]]:
    """Return the carriers judged by force, and those judged by displacement."""
    by_force = [carrier for carrier in carriers if is_judged_by_force(evidence, carrier, carriers)]
    return by_force, [carrier for carrier in carriers if carrier not in by_force]


def is_judged_by_force(evidence: Evidence, carrier: str, carriers: list[str]) -> bool:
    """Return whether one of a target's ``carriers`` is judged by contact force instead of displacement."""
    return limit_of(evidence, carriers, "force_limit") is not None or evidence.is_immovable(carrier)


DOES_NOT_COLLIDE = Predicate(
    name="does-not-collide",
    phrase="<agent> does not collide <target>",
    rdf_type="bdd:DoesNotCollidePredicate",
    in_texts=("<agent> does not collide with <target>",),
    synonyms=("collide", "collides", "collision", "hit", "hits", "bump", "bumps", "crash", "crashes"),
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("target", Kind.ANY, "bdd:target"),
    ),
    sentence='"{agent}" does not collide "{target}"',
    unit=METRES,
    doc=(
        "The target is not pushed: the path it travels within the window stays below 0.05 m (displacement_limit). An "
        "immovable target (a fixed object, an agent) is not hit: the contact force of the agent, plus that of a "
        "gripped object in excess of its weight, stays below 140 N (force_limit), the limit of ISO/TS 15066 for a "
        "clamped hand. With a force_limit, any target is judged by force."
    ),
    evaluate=margin,
    unit_for=unit,
    measured="path",
)
