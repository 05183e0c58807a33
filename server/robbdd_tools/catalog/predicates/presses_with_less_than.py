"""An element presses another one with less than a force."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.contacts import TOUCH, contact_force

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit minus the largest contact force since the previous sample, N, shape (n,)."""
    return read_limit(str(arguments["limit"]), "force").si - contact_force(evidence, arguments)


PRESSES_WITH_LESS_THAN = Predicate(
    name="presses-with-less-than",
    phrase="<one> presses <other> with less than #limit",
    rdf_type="rbw:PressesWithLessThanPredicate",
    synonyms=("force", "press", "push with", "pressure"),
    slots=(
        Slot("one", Kind.ANY, "rbw:ref-one"),
        Slot("other", Kind.ANY, "rbw:ref-other"),
        Slot("limit", Kind.QUANTITY, "rbw:limit", "force", unsigned=True),
    ),
    sentence='"{one}" presses "{other}" with less than "{limit}"',
    unit="N",
    doc="The contact force between the two is smaller than a force, such as 20 N, in every step of the physics.",
    measured="nothing",
    evaluate=margin,
    quantities=(TOUCH,),
)
