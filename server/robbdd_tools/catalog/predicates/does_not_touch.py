"""An element does not touch another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.contacts import FAINTEST, TOUCH, contact_force

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the negative contact force since the previous sample, N, shape (n,); 0 where it is too faint to count."""
    import numpy as np

    force = contact_force(evidence, arguments)
    return np.where(force < FAINTEST, 0.0, -force)


DOES_NOT_TOUCH = Predicate(
    name="does-not-touch",
    phrase="<one> does not touch <other>",
    rdf_type="rbw:DoesNotTouchPredicate",
    synonyms=("avoids", "no contact", "without contact", "contact free"),
    slots=(Slot("one", Kind.ANY, "rbw:ref-one"), Slot("other", Kind.ANY, "rbw:ref-other")),
    sentence='"{one}" does not touch "{other}"',
    unit="N",
    doc=(
        "No contact force of 0.01 N or more acts between the two, in any step of the physics. What an agent grips "
        "does not count as part of the agent."
    ),
    measured="nothing",
    evaluate=margin,
    quantities=(TOUCH,),
)
