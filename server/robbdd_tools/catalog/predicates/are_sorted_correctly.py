"""Each object of a set is inside a workspace that is correct for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import inside_margin, refuse_empty_sets

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


MISPLACED = 1e-4
"""If no workspace is correct for an object, its distance counts as at least this (m)."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the smallest margin (m) of any object to be inside a workspace that is correct for it, shape (n,).

    If none of the workspaces is correct for an object, its margin is the negative distance from the faces of the
    nearest workspace. Raises ``Unobserved`` if the scene states no correct workspace for an object.
    """
    import numpy as np

    refuse_empty_sets(arguments)
    workspaces = tuple(arguments["workspaces"])
    margins: list[FloatArray] = []
    for name in arguments["objects"]:
        correct = evidence.correct_places(name)
        chosen = [workspace for workspace in workspaces if workspace in correct]
        inside = np.max([inside_margin(evidence, name, (place,)) for place in chosen or workspaces], axis=0)
        margins.append(inside if chosen else np.minimum(-np.abs(inside), -MISPLACED))
    return np.min(margins, axis=0)


ARE_SORTED_CORRECTLY = Predicate(
    name="are-sorted-correctly",
    phrase="<objects> are sorted correctly into <workspaces>",
    rdf_type="rbw:AreSortedCorrectlyPredicate",
    slots=(
        Slot("objects", Kind.OBJECT_SET, "bdd:ref-object"),
        Slot("workspaces", Kind.WORKSPACE_SET, "bdd:ref-workspace"),
    ),
    sentence='"{objects}" are sorted correctly into "{workspaces}"',
    unit="m",
    doc=(
        "Every object of the set lies in a workspace of the set that is correct for it: `workspace bin { correct for: "
        "obj <part> }` in the scene. Unknown for an object without a stated workspace."
    ),
    measured="length",
    evaluate=margin,
    pointwise=True,
)
