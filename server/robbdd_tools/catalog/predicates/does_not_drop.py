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
"""A released object may fall by this height (m), because gripper and cup release it above a surface, not on it."""
AT_REST = 0.01
"""An object is at rest below this speed (m/s)."""
REST_TIME = 0.1
"""An object is at rest when it was slow and not held for this time (s): a brief loss of contact is not rest."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the height (m) that the object may still fall, shape (n,).

    While the object is held, this is ``LIMIT``. Otherwise, it is ``LIMIT`` minus the drop since the object was last
    held or at rest. If the object is at rest, it is at most the distance to the faces of the best workspace (negative
    outside). From when another agent holds the object, this agent cannot drop it until it holds it again.
    """
    import numpy as np

    name = str(arguments["object"])
    position = evidence.position(name)
    agent = str(arguments["agent"])
    held = evidence.gripped(agent, name) > 0
    resting = _resting(evidence.times, position, held)
    supported = held | resting
    supported[0] = True
    since = _last(supported)
    margins = LIMIT - (position[since, 2] - position[:, 2])
    if evidence.workspaces:
        inside = inside_margin(evidence, name, evidence.workspaces)
        margins = np.where(resting, np.minimum(margins, inside), margins)
    others = [evidence.gripped(other, name) > 0 for other in evidence.grippers if other != agent]
    is_taken = _last(np.any(others, axis=0)) > _last(held) if others else np.zeros_like(held)
    return np.where(held | is_taken, LIMIT, np.minimum(margins, LIMIT))


def _last(true: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return, for each sample, the last one up to it at which something was true, -1 without one."""
    import numpy as np

    return np.maximum.accumulate(np.where(true, np.arange(len(true)), -1))


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
    doc=(
        "The object is held by the agent or at rest on a workspace; in between it falls by less than 0.05 m. What "
        "another agent has taken over is no longer the agent's."
    ),
    evaluate=margin,
)
