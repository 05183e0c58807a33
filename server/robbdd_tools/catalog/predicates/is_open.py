"""A thing with a joint is open."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return how far (m or deg) the joint is beyond the position from which the thing counts as open, shape (n,)."""
    return evidence.opening(str(arguments["object"])).beyond_open()


def unit(evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the joint."""
    return evidence.opening(str(arguments["object"])).unit


IS_OPEN = Predicate(
    name="is-open",
    phrase="<object> is open",
    rdf_type="rbw:IsOpenPredicate",
    synonyms=("opened", "not closed"),
    slots=(Slot("object", Kind.OBJECT, "bdd:ref-object"),),
    sentence='"{object}" is open',
    unit="m",
    doc=(
        "A drawer, door, lid, lever or button: its joint has passed 90 % of the way from the closed to the open end of "
        "its range, or the position `open` that the scene instance states."
    ),
    measured="otherwise",
    evaluate=margin,
    unit_for=unit,
)
