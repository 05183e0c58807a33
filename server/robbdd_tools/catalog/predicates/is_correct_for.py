"""A workspace is correct for an object, by a relation that the scene states."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return 1 at each sample if the workspace is correct for the object, else -1, shape (n,).

    Raises ``Unobserved`` if the scene states no correct workspace for the object.
    """
    import numpy as np

    correct = str(arguments["workspace"]) in evidence.correct_places(str(arguments["object"]))
    return np.full(len(evidence.times), 1.0 if correct else -1.0)


IS_CORRECT_FOR = Predicate(
    name="is-correct-for",
    phrase="<workspace> is correct for <object>",
    rdf_type="rbw:IsCorrectForPredicate",
    synonyms=("right for", "belongs to", "correct bin", "isCorrect"),
    slots=(
        Slot("workspace", Kind.WORKSPACE, "bdd:ref-workspace"),
        Slot("object", Kind.OBJECT, "bdd:ref-object"),
    ),
    sentence='"{workspace}" is correct for "{object}"',
    unit="",
    doc=(
        "The object belongs in the workspace: `workspace bin { correct for: obj <part> }` in the scene. "
        "Unknown for an object without a stated workspace."
    ),
    measured="nothing",
    evaluate=margin,
    pointwise=True,
    set_up=True,
)
