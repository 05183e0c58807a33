"""A set of objects is sorted into a set of workspaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import inside_margin

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Margin (m) of the object that is least inside any of the workspaces, shape (n,)."""
    import numpy as np

    workspaces = arguments["workspaces"]
    margins = [inside_margin(evidence, name, workspaces) for name in arguments["objects"]]
    return np.min(margins, axis=0)


SORTED_INTO = Predicate(
    name="sorted-into",
    phrase="<objects> are sorted into <workspaces>",
    rdf_type="bdd:SortedIntoPredicate",
    slots=(
        Slot("objects", Kind.OBJECT_SET, "bdd:ref-object"),
        Slot("workspaces", Kind.WORKSPACE_SET, "bdd:ref-workspace"),
    ),
    sentence='"{objects}" are sorted into "{workspaces}"',
    unit="m",
    doc="Every object of the set lies in some workspace of the set.",
    evaluate=margin,
)
