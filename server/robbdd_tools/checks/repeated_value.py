"""``repeated-value``: a variation has two columns or lines for the same variable."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Fix, Severity
from robbdd_tools.base.removals import removal
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.checks.table_edits import column_removed
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.types import variable_key
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site


def repeated_value(site: Site) -> Iterator[Diagnostic]:
    """Report each further column or line of a variable."""
    for scenario in scenarios(site):
        first: dict[str, tree.Ref] = {}
        for column in scenario.columns:
            if column.variable is None:
                continue
            before = first.setdefault(variable_key(column.variable), column.ref)
            if before is not column.ref:
                what = "column" if isinstance(scenario.variant.variation, tree.Table) else "line"
                yield finding(
                    site,
                    column.ref,
                    Severity.ERROR,
                    "repeated-value",
                    f"'{column.ref.path}' already has values: remove this {what} or the first one",
                    (related_to(site, before, "the first values"),),
                    _removals(scenario, column.ref),
                )


def _removals(scenario: Scenario, ref: tree.Ref) -> tuple[Fix, ...]:
    site, variation = scenario.site, scenario.variant.variation
    if isinstance(variation, tree.Table):
        number = next(number for number, column in enumerate(variation.header) if column is ref)
        edits = column_removed(site, variation, number)
        return (Fix("Remove this column", edits),) if edits else ()
    lines = (line for line in variation.assignments if line.variable is ref)
    return tuple(removal(site.file.document, "Remove this line", site.span(line)) for line in lines)
