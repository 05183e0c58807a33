"""Refactorings of variations.

A product can become a table and a table a product. A reference to a set can be replaced by its values. Table rows can
be added from the scene. All refactorings but the last one keep the scenarios the same. Converting between a table and a
product creates a new node in the graph, which has the same bindings.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, product
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix
from robbdd_tools.base.document import Span
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.elements import Site, element_of, elements_of, scene_members, story_sites
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot

MAX_ROWS = 500
"""Maximum number of rows for which a table is offered."""


def variation_refactorings(snapshot: Snapshot, uri: str, span: Span) -> Iterator[Fix]:
    """Yield the refactorings of the variations in a selection."""
    file = snapshot.file(uri)
    for site in story_sites(snapshot, file, span) if file is not None else ():
        if site.placed.declaration.faults:
            continue
        for scenario in scenarios(site):
            if not _touches(site.span(scenario.variant), span) or not is_headed(scenario):
                continue
            yield from _as_table(scenario)
            yield from _as_product(scenario)
            yield from _filled(scenario)
            yield from _inlined(scenario, span)


def _as_table(scenario: Scenario) -> Iterator[Fix]:
    """Convert a product to a table with one row for each combination. The last variable varies fastest."""
    variation = scenario.variant.variation
    if not isinstance(variation, tree.Product) or not variation.assignments:
        return
    columns = [_choices(scenario.site, line.choices) for line in variation.assignments]
    known = [column for column in columns if column is not None]
    rows = list(islice(product(*known), MAX_ROWS + 1))
    if len(known) == len(columns) and 0 < len(rows) <= MAX_ROWS:
        header = [line.variable.path for line in variation.assignments]
        yield _replaced(scenario, "Write the product as a table", _table(scenario, header, rows))


def _as_product(scenario: Scenario) -> Iterator[Fix]:
    """Convert a table to a product. This is possible if its rows are exactly the product of its columns, in order."""
    variation = scenario.variant.variation
    if not isinstance(variation, tree.Table) or not variation.rows:
        return
    rows = [tuple(_text(scenario.site, cell) for cell in row.cells) for row in variation.rows]
    if any(len(row) != len(variation.header) for row in rows) or _has_sets(variation):
        return
    columns = [list(dict.fromkeys(row[number] for row in rows)) for number in range(len(variation.header))]
    if list(product(*columns)) != rows:
        return
    indent = _indent(scenario)
    lines = [
        f"var <{variable.path}>: {{ {', '.join(values)} }}"
        for variable, values in zip(variation.header, columns, strict=True)
    ]
    yield _replaced(scenario, "Write the table as a product", f"\n{indent}".join(lines))


def _filled(scenario: Scenario) -> Iterator[Fix]:
    """Add all missing rows to a table, with the elements of the scene as values. This creates new scenarios."""
    site, variation = scenario.site, scenario.variant.variation
    is_known = scene_members(site.follow(scenario.variant.scene)) is not None
    if not isinstance(variation, tree.Table) or not is_known or _has_sets(variation):
        return
    columns: list[list[str]] = []
    for position, column in enumerate(scenario.columns):
        if column.variable is None or column.variable.kind is not SymbolKind.VARIABLE:
            return
        written = [_text(site, row.cells[position]) for row in variation.rows if position < len(row.cells)]
        columns.append(list(dict.fromkeys(scenario.fitting_for(column.variable) or written)))
    rows = [tuple(_text(site, cell) for cell in row.cells) for row in variation.rows]
    new = [row for row in islice(product(*columns), MAX_ROWS + 1) if row not in rows]
    if new and len(rows) + len(new) <= MAX_ROWS:
        header = [variable.path for variable in variation.header]
        title = f"Fill the table from the scene ({len(new)} more row{'' if len(new) == 1 else 's'})"
        yield _replaced(scenario, title, _table(scenario, header, [*rows, *new]))


def _inlined(scenario: Scenario, span: Span) -> Iterator[Fix]:
    """Replace a reference to a constant set by the set's values; the scenarios stay the same."""
    site = scenario.site
    for column in scenario.columns:
        for written in column.written:
            if not isinstance(written, tree.Link) or written.reference.role != "ConstantSet":
                continue
            source = site.follow(written.reference)
            if source is None or not isinstance(source.tree, tree.ConstantSet) or not source.whole(source.tree):
                continue
            if _touches(site.span(written), span):
                values = ", ".join(_text(source, value) for value in source.tree.values)
                edit = Edit(site.uri, site.span(written), f"{{ {values} }}")
                yield Fix(f"Write the values of '{written.reference.path}' here", (edit,))


def _choices(site: Site, written: object) -> list[str] | None:
    """Return the values in one line of a product as written. Return ``None`` if table cells cannot express them."""
    match written:
        case tree.ValueList():
            return [_text(site, value) for value in written.values]
        case tree.Link():
            source = site.follow(written.reference)
            if source is not None and isinstance(source.tree, tree.ConstantSet):
                return [_text(source, value) for value in source.tree.values] if source.whole(source.tree) else None
            found = elements_of(source)
            return None if found is None else [f"<{element.name}>" for element in found]
        case _:
            return None


def _text(site: Site, node: tree.Node) -> str:
    """Return a value as written, but with qualified names, so that it can be used in another declaration."""
    if isinstance(node, tree.Ref):
        element = element_of(site, node)
        return f"<{element.name if element is not None else node.path}>"
    span = site.span(node)
    return " ".join(site.file.document.text[span.start : span.end].split())


def _has_sets(table: tree.Table) -> bool:
    return any(isinstance(cell, tree.Link | tree.ValueList) for row in table.rows for cell in row.cells)


def _table(scenario: Scenario, header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    names = [f"<{name}>" for name in header]
    widths = [max(map(len, column)) for column in zip(names, *rows, strict=True)]
    rule = "|" + "|".join("-" * (width + 2) for width in widths) + "|"
    cells = [" | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in (names, *rows)]
    lines = [f"| {cells[0]} |", rule, *(f"| {row} |" for row in cells[1:])]
    return f"\n{_indent(scenario)}".join(lines)


def _indent(scenario: Scenario) -> str:
    document = scenario.site.file.document
    line = document.line_text(document.position(scenario.site.span(scenario.variant.variation).start).line)
    return line[: len(line) - len(line.lstrip())]


def _replaced(scenario: Scenario, title: str, text: str) -> Fix:
    site = scenario.site
    return Fix(title, (Edit(site.uri, site.span(scenario.variant.variation), text),))


def is_headed(scenario: Scenario) -> bool:
    """Return whether a variation begins with ``variation:``. The published syntax has neither this line nor tables."""
    start = scenario.site.span(scenario.variant.variation).start
    return scenario.site.file.document.text[:start].rstrip().endswith(":")


def _touches(one: Span, other: Span) -> bool:
    return one.start <= other.end and other.start <= one.end
