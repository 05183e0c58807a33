"""A set of objects is sorted into a set of workspaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import inside_margin, is_configured, refuse_empty_sets

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return the smallest margin (m) of any object to be inside one of the workspaces, shape (n,).

    If an object or a workspace has the configuration ``exactly_one``, the object must not be inside a second workspace.
    """
    import numpy as np

    refuse_empty_sets(arguments)
    workspaces = tuple(arguments["workspaces"])
    strict = any(is_configured(evidence, each, "exactly_one") for each in _elements(evidence, workspaces))
    margins: list[FloatArray] = []
    for name in arguments["objects"]:
        inside = np.sort([inside_margin(evidence, name, (workspace,)) for workspace in workspaces], axis=0)
        alone = len(inside) > 1 and (strict or is_configured(evidence, name, "exactly_one"))
        margins.append(np.minimum(inside[-1], -inside[-2]) if alone else inside[-1])
    return np.min(margins, axis=0)


def _elements(evidence: Evidence, workspaces: tuple[str, ...]) -> list[str]:
    return [carrier for workspace in workspaces for carrier, _ in evidence.regions(workspace)]


SORTED_INTO = Predicate(
    name="sorted-into",
    phrase="<objects> are sorted into <workspaces>",
    rdf_type="bdd:SortedIntoPredicate",
    synonyms=("sort", "sorted"),
    slots=(
        Slot("objects", Kind.OBJECT_SET, "bdd:ref-object"),
        Slot("workspaces", Kind.WORKSPACE_SET, "bdd:ref-workspace"),
    ),
    sentence='"{objects}" are sorted into "{workspaces}"',
    unit="m",
    doc="Every object of the set lies in some workspace of the set; with exactly_one in only one.",
    measured="length",
    evaluate=margin,
    pointwise=True,
)
