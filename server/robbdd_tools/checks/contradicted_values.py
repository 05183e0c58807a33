"""Remove shape findings on the values of variables that the clauses of a template use for different kinds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.checks.superseded import role_shapes
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.names.elements import Site, story_sites
from robbdd_tools.names.types import uses_by_variable, variable_key
from robbdd_tools.names.uses import ANYTHING, clauses_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.project import Snapshot


def without_contradicted(snapshot: Snapshot, shapes: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the shape findings that another value could avoid.

    If clauses of a template contradict each other about a variable, every value in every variant violates one of them.
    ``type-conflict`` reports the clause. Sibling templates may share the variable.
    """
    codes = role_shapes()
    spans: dict[str, list[Span]] = {}
    for uri in {shape.uri for shape in shapes if shape.code in codes}:
        spans[uri] = list(_values(snapshot, uri))
    return [
        shape
        for shape in shapes
        if shape.code not in codes
        or not any(span.start <= shape.span.start and shape.span.end <= span.end for span in spans[shape.uri])
    ]


def _values(snapshot: Snapshot, uri: str) -> Iterator[Span]:
    """Yield the places of the values of contradicted variables in the variants of a file."""
    contradicted = set(_contradicted(snapshot, uri))
    file = snapshot.file(uri)
    for site in story_sites(snapshot, file) if file is not None and contradicted else ():
        for scenario in scenarios(site):
            for column in scenario.columns:
                if column.variable is not None and variable_key(column.variable) in contradicted:
                    yield from (site.span(written) for written in column.written)
                    yield site.span(column.ref)


def _contradicted(snapshot: Snapshot, uri: str) -> Iterator[str]:
    """Yield the keys of the variables that a template of a file or of its imports uses for different kinds."""
    for file in snapshot.closure(uri):
        for placed in file.of(tree.Template):
            site = Site(snapshot, file, placed)
            for clauses in clauses_of(placed.declaration):
                for key, uses in uses_by_variable(site, clauses).items():
                    left = ANYTHING
                    for use in uses:
                        left &= use.kinds
                    if not left:
                        yield key
