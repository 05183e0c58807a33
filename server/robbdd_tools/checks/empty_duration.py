"""``empty-duration``: ``from <a> until <a>``, which is a single instant."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import finding
from robbdd_tools.names.uses import clauses_of

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site


def empty_duration(site: Site) -> Iterator[Diagnostic]:
    """Report durations that start and end with one event."""
    for clauses in clauses_of(site.placed.declaration):
        for during in clauses.durations:
            if during.start.path == during.end.path:
                message = f"the duration starts and ends with '{during.start.path}', so it is a single instant: "
                message += "name two events"
                yield finding(site, during, Severity.WARNING, "empty-duration", message)
