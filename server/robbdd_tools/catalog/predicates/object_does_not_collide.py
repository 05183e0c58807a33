"""An object does not collide with a target, judged by how far it pushes the target or by contact force."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.contacts import FAINTEST, TOUCH, contact_force
from robbdd_tools.catalog.geometry import carriers_of, limit_of
from robbdd_tools.catalog.predicates.does_not_collide import (
    FORCE_LIMIT,
    LIMIT,
    METRES,
    NEWTONS,
    SHARE,
    is_judged_by_force,
)
from robbdd_tools.catalog.predicates.is_at_rest import LIMIT as REST

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return limit minus displacement (m) or limit minus contact force (N) at each sample, shape (n,).

    Limits are the same as for agents (*does not collide*), and are chosen by the same rule. If both limits apply to the
    objects that carry a workspace, each margin is divided by its limit. Raises ``KeyError`` if contact forces were not
    recorded.
    """
    import numpy as np

    thing, carriers = str(arguments["one"]), carriers_of(evidence, str(arguments["other"]))
    force_limit = limit_of(evidence, carriers, "force_limit") or FORCE_LIMIT
    way_limit = limit_of(evidence, carriers, "displacement_limit") or LIMIT
    mixed = unit(evidence, arguments) == SHARE
    found: list[FloatArray] = []
    for carrier in carriers:
        force = contact_force(evidence, {"one": thing, "other": carrier})
        by_force = is_judged_by_force(evidence, carrier, carriers)
        limit = force_limit if by_force else way_limit
        rest = limit - (force if by_force else _pushed(evidence, carrier, force))
        found.append(rest / limit if mixed else rest)
    return np.min(found, axis=0)


def unit(evidence: Evidence, arguments: Arguments) -> str:
    """Return newtons for a target judged by force, metres for displacement, and no unit for a mix."""
    carriers = carriers_of(evidence, str(arguments["other"]))
    kinds = {is_judged_by_force(evidence, carrier, carriers) for carrier in carriers}
    return SHARE if len(kinds) > 1 else NEWTONS if True in kinds else METRES


def _pushed(evidence: Evidence, carrier: str, force: FloatArray) -> FloatArray:
    """Return the distance (m) by which contacts have moved a carrier up to each sample, shape (n,).

    Movement counts from a contact (``force``, N, at each sample) until the carrier is at rest and untouched, because it
    slides on after a hit.
    """
    import numpy as np

    steps = np.linalg.norm(np.diff(evidence.position(carrier), axis=0), axis=1)
    slow = np.linalg.norm(evidence.velocity(carrier), axis=1)[1:] < REST
    counted, moved = np.zeros(len(steps) + 1), bool(force[0] >= FAINTEST)
    for index, (step, is_slow) in enumerate(zip(steps, slow, strict=True), 1):
        moved = bool(force[index] >= FAINTEST) or (moved and not is_slow)
        counted[index] = step if moved else 0.0
    return np.cumsum(counted)


OBJECT_DOES_NOT_COLLIDE = Predicate(
    name="object-does-not-collide",
    phrase="<one> does not collide with <other>",
    in_texts=("<one> does not collide <other>",),
    rdf_type="rbw:ObjectDoesNotCollidePredicate",
    slots=(
        Slot("one", Kind.OBJECT, "bdd:ref-object"),
        Slot("other", Kind.ANY, "bdd:target"),
    ),
    sentence='"{one}" does not collide with "{other}"',
    unit=METRES,
    doc=(
        "An object does not push another element: the path along which contact moves the element stays below 0.05 m "
        "(displacement_limit). An element that cannot move (a fixed object, an agent) is hit with less than 140 N "
        "(force_limit). 'does not touch' allows no contact at all; 'does not collide' is about an agent."
    ),
    evaluate=margin,
    unit_for=unit,
    quantities=(TOUCH,),
)
