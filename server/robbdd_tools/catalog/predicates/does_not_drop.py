"""An agent does not drop an object: the object is held, at rest on a workspace, or falls only slightly in between."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import inside_margin

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray

LIMIT = 0.05
"""Height (m) that a released object may fall: gripper and cup release above a surface, not on it."""
AT_REST = 0.01
"""Speed (m/s) below which an object is at rest."""
REST_TIME = 0.1
"""Seconds without a grip for which an object must have been that slow: a brief loss of contact is not rest."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the height (m) that the object may still fall, shape (n,).

    ``LIMIT`` while it is held; otherwise ``LIMIT`` minus its drop since it was last held or at rest and, if it is at
    rest, at most its distance to the faces of the best workspace (negative outside).
    """
    import numpy as np

    name = str(arguments["object"])
    position = evidence.position(name)
    held = evidence.gripped(str(arguments["agent"]), name) > 0
    resting = _resting(evidence.times, position, held)
    supported = held | resting
    supported[0] = True
    since = np.maximum.accumulate(np.where(supported, np.arange(len(position)), 0))
    margins = LIMIT - (position[since, 2] - position[:, 2])
    if evidence.workspaces:
        inside = inside_margin(evidence, name, evidence.workspaces)
        margins = np.where(resting, np.minimum(margins, inside), margins)
    return np.where(held, LIMIT, np.minimum(margins, LIMIT))


def _resting(times: FloatArray, position: FloatArray, held: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return at which samples an object (positions (n, 3) m) has been slow and free for ``REST_TIME`` within the
    window."""
    import numpy as np

    way = np.linalg.norm(np.diff(position, axis=0), axis=1)
    moving = np.concatenate([[False], way > AT_REST * np.diff(times)])
    busy = np.where(held | moving, times, -np.inf)
    return times - np.maximum.accumulate(busy) > REST_TIME


DOES_NOT_DROP = Predicate(
    name="does-not-drop",
    phrase="<agent> does not drop <object>",
    rdf_type="bdd:DoesNotDropPredicate",
    synonyms=("drop", "drops", "lose", "loses", "fall", "falls"),
    slots=(
        Slot("agent", Kind.AGENT, "bdd:ref-agent"),
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
    ),
    sentence='"{agent}" does not drop "{object}"',
    unit="m",
    doc="The object is held by the agent or at rest on a workspace; in between it falls by less than 0.05 m.",
    evaluate=margin,
)
