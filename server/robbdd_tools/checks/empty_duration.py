"""``empty-duration``: a duration starts and ends with the same event, so it is a single instant."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import change, finding
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic, Fix
    from robbdd_tools.names.elements import Site


def empty_duration(site: Site) -> Iterator[Diagnostic]:
    """Report durations that start and end with the same event."""
    for clauses in clauses_of(site.placed.declaration):
        for during in clauses.durations:
            if during.start.path == during.end.path:
                message = f"the duration starts and ends with '{during.start.path}', so it is a single instant: "
                message += "name two events"
                fixes = tuple(_after(site, clauses.node, during))
                yield finding(site, during, Severity.WARNING, "empty-duration", message, fixes=fixes)


def _after(site: Site, node: tree.Node, during: tree.During) -> Iterator[Fix]:
    """Yield the fix that writes the instant as another time constraint.

    There is no such fix for behaviours and templates, because they must have a duration.
    """
    if any(isinstance(clause, tree.Fluent | tree.TextClause) and clause.time is during for clause in walk(node)):
        text = f"after <{during.start.path}>"
        yield change(site, f"Change to '{text}'", during, text)
