"""``row-width``: a table row has more or fewer cells than the table has columns."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.checks.table_edits import cell_span
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site


def row_width(site: Site) -> Iterator[Diagnostic]:
    """Report each row that has the wrong width.

    A fix may complete a short row with values of an adjacent row or of the scene.
    """
    for scenario in scenarios(site):
        table = scenario.variant.variation
        for row in table.rows if isinstance(table, tree.Table) else ():
            if isinstance(table, tree.Table) and len(row.cells) != len(table.header):
                yield _report(scenario, table, row)


def _report(scenario: Scenario, table: tree.Table, row: tree.TableRow) -> Diagnostic:
    site = scenario.site
    cells, columns = len(row.cells), len(table.header)
    if cells < columns:
        fix = "add a value for " + ", ".join(f"'{ref.path}'" for ref in table.header[cells:])
    else:
        fix = "remove the surplus ones"
    message = f"this row has {_counted(cells, 'cell')}, but the table has {_counted(columns, 'column')}: {fix}"
    header = related_to(site, table.header[0], "the columns")
    return finding(site, row, Severity.ERROR, "row-width", message, (header,), tuple(_fixes(scenario, table, row)))


def _fixes(scenario: Scenario, table: tree.Table, row: tree.TableRow) -> Iterator[Fix]:
    site = scenario.site
    cells, columns = len(row.cells), len(table.header)
    document = site.file.document
    if cells > columns:
        start = cell_span(site, row.cells[columns - 1]).end
        yield Fix("Remove the surplus cells", (Edit(site.uri, Span(start, site.span(row).end), " |"),))
        return
    end = site.span(row).end
    complete = [other for other in table.rows if len(other.cells) == columns]
    if complete:
        nearest = min(complete, key=lambda other: (abs(other.span.start - row.span.start), other.span))
        missing = [cell_span(site, cell) for cell in nearest.cells[cells:]]
        text = "".join(f" {document.text[span.start : span.end]} |" for span in missing)
        yield Fix("Complete the row like the adjacent one", (Edit(site.uri, Span(end, end), text),))
    given = [scenario.cell_for(column.variable) for column in scenario.columns[cells:] if column.variable is not None]
    filled = [cell for cell in given if cell is not None]
    if len(filled) == columns - cells:
        text = "".join(f" {cell} |" for cell in filled)
        yield Fix(f"Complete the row with {' and '.join(filled)}", (Edit(site.uri, Span(end, end), text),))


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
