"""The time between two events is shorter than a limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import read_limit, read_quantity
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def time_left(seconds: float, arguments: Arguments) -> float:
    """Limit minus a duration (s), in the unit of the limit."""
    limit = read_limit(str(arguments["limit"]), "time")
    return (limit.si - seconds) / limit.factor


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Limit minus the time since the first sample, in the unit of the limit, shape (n,). Only plots show it."""
    limit = read_limit(str(arguments["limit"]), "time")
    return (limit.si - (evidence.times - evidence.times[0])) / limit.factor


def unit(_evidence: Evidence, arguments: Arguments) -> str:
    """Return the unit of the limit in the clause."""
    return read_quantity(str(arguments["limit"]), "time").unit


TAKES_LESS_THAN = Predicate(
    name="takes-less-than",
    phrase="it takes less than #limit",
    rdf_type="rbw:TakesLessThanPredicate",
    synonyms=("lasts", "duration", "takes"),
    slots=(Slot("limit", Kind.QUANTITY, "rbw:limit", "time", unsigned=True),),
    sentence='it takes less than "{limit}"',
    unit="s",
    doc="The time from one event until another one is shorter than a limit, such as 12 s.",
    measured="nothing",
    evaluate=margin,
    unit_for=unit,
    duration=time_left,
)
