"""``selection-size``: ``select N`` selects more elements than the set has, or none."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.chosen_elements import chosen_elements
from robbdd_tools.checks.finding import change, finding, related_to
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site


def selection_size(site: Site) -> Iterator[Diagnostic]:
    """Report selections that have no result."""
    for scenario in scenarios(site):
        for column in scenario.columns:
            for written in column.written:
                if isinstance(written, tree.Selection):
                    yield from _checked(site, written)


def _checked(site: Site, selection: tree.Selection) -> Iterator[Diagnostic]:
    count = selection.count.value
    source = selection.source
    elements = chosen_elements(site, source, selection.where)
    related = (related_to(site, source, "the set"),)
    if not isinstance(count, int) or count < 1:
        message = f"'select {count}' selects nothing: write a whole number of at least 1"
        fix = change(site, "Select 1", selection.count, "1")
        yield finding(site, selection.count, Severity.ERROR, "selection-size", message, fixes=(fix,))
    elif elements and not selection.repeated and count > len(elements):
        size = len(elements)
        message = f"'{source.path}' has only {size} element{'' if size == 1 else 's'}: select {size} or fewer"
        if selection.kind == "combinations":
            message += ", or 'repeated combinations'"
        fix = change(site, f"Select {size}", selection.count, str(size))
        yield finding(site, selection.count, Severity.ERROR, "selection-size", message, related, (fix,))
