"""An object is at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import farthest_point

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

LIMIT = 0.01
"""A point of an object is at rest below this speed (m/s), as for *does not drop*."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return limit minus an upper bound of the speed (m/s) of all object points since the previous sample, shape (n,).

    The bound is the speed of the object's position, plus the angular speed times the distance of its farthest point.
    """
    import numpy as np

    name = str(arguments["object"])
    shift = np.linalg.norm(evidence.velocity(name), axis=1)
    return LIMIT - shift - evidence.turning(name) * farthest_point(evidence, name)


IS_AT_REST = Predicate(
    name="is-at-rest",
    phrase="<object> is at rest",
    rdf_type="rbw:IsAtRestPredicate",
    synonyms=("still", "stationary", "stopped", "motionless", "stands still", "not moving"),
    slots=(Slot("object", Kind.OBJECT, "bdd:ref-object"),),
    sentence='"{object}" is at rest',
    unit="m/s",
    doc="No point of the object moves faster than 0.01 m/s, neither by translation nor by rotation.",
    evaluate=margin,
)
