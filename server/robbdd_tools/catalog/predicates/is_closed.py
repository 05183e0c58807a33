"""A thing with a joint is closed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return how far (m or deg) the joint may still move until the thing no longer counts as closed, shape (n,)."""
    return evidence.opening(str(arguments["object"])).short_of_closed()


def unit(evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the joint."""
    return evidence.opening(str(arguments["object"])).unit


IS_CLOSED = Predicate(
    name="is-closed",
    phrase="<object> is closed",
    rdf_type="rbw:IsClosedPredicate",
    synonyms=("shut", "not open"),
    slots=(Slot("object", Kind.OBJECT, "bdd:ref-object"),),
    sentence='"{object}" is closed',
    unit="m",
    doc=(
        "A drawer, door, lid, lever or button: its joint is within 2 % of its range from the closed end, or not beyond "
        "the position `closed` that the scene instance states."
    ),
    measured="otherwise",
    evaluate=margin,
    unit_for=unit,
)
