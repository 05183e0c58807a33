"""An element touches another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.contacts import FAINTEST, TOUCH, contact_force

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the contact force since the previous sample minus the faintest force that counts, N, shape (n,)."""
    return contact_force(evidence, arguments) - FAINTEST


TOUCHES = Predicate(
    name="touches",
    phrase="<one> touches <other>",
    rdf_type="rbw:TouchesPredicate",
    synonyms=("contacts", "touch", "touching", "contact"),
    slots=(Slot("one", Kind.ANY, "rbw:ref-one"), Slot("other", Kind.ANY, "rbw:ref-other")),
    sentence='"{one}" touches "{other}"',
    unit="N",
    doc="Some contact force of at least 0.01 N acts between the two. What an agent grips is not part of it.",
    measured="nothing",
    evaluate=margin,
    quantities=(TOUCH,),
)
