"""Edit the table of a variation: add and remove columns, and find the contents of cells."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Span
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robbdd_tools.names.elements import Site

_GAP = r"(?:\s|//[^\n]*)*"
_END = re.compile(rf"{_GAP}\|")
_RULE = re.compile(rf"{_GAP}(\|(?:\s*-+\s*\|)+)")


def cell_span(site: Site, cell: tree.Node) -> Span:
    """Return the span of a cell's contents; the span of a reference excludes its brackets."""
    span = site.span(cell)
    if not isinstance(cell, tree.Ref):
        return span
    text = site.file.document.text
    return Span(text.rindex("<", 0, span.start), text.index(">", span.end) + 1)


def columns_added(site: Site, table: tree.Table, names: Sequence[str], cells: Sequence[str]) -> tuple[Edit, ...]:
    """Return the edits that append columns, each filled with one value. If rows differ in width, return none."""
    header = _header_end(site, table)
    if header is None or not _is_even(table):
        return ()
    values = "".join(f" {cell} |" for cell in cells)
    written = [(header, "".join(f" {name} |" for name in names)), *((site.span(row).end, values) for row in table.rows)]
    rule = _rule(site, header, len(table.header))
    if rule is not None:
        written.append((rule.end, "---|" * len(names)))
    return tuple(Edit(site.uri, Span(end, end), text) for end, text in sorted(written))


def column_removed(site: Site, table: tree.Table, number: int) -> tuple[Edit, ...]:
    """Return the edits that remove one of several columns. If rows differ in width, return none."""
    header = _header_end(site, table)
    if header is None or not _is_even(table) or len(table.header) == 1:
        return ()
    cells = (row.cells for row in table.rows)
    spans = [_with_bar(site, row, number) for row in (table.header, *cells)]
    rule = _rule(site, header, len(table.header))
    if rule is not None:
        bars = list(_bars(site.file.document.text, rule))
        spans.append(Span(bars[number] + 1, bars[number + 1] + 1))
    return tuple(Edit(site.uri, span, "") for span in sorted(spans))


def _with_bar(site: Site, cells: tuple[tree.Node, ...], number: int) -> Span:
    if number == 0:
        return Span(cell_span(site, cells[0]).start, cell_span(site, cells[1]).start)
    return Span(cell_span(site, cells[number - 1]).end, cell_span(site, cells[number]).end)


def _is_even(table: tree.Table) -> bool:
    return all(len(row.cells) == len(table.header) for row in table.rows)


def _header_end(site: Site, table: tree.Table) -> int | None:
    """Return the end of the bar after the last name in the header; ``None`` if there is none."""
    match = _END.match(site.file.document.text, cell_span(site, table.header[-1]).end)
    return None if match is None else match.end()


def _rule(site: Site, header: int, columns: int) -> Span | None:
    """Return the line of dashes under a header if it has as many cells as the header."""
    match = _RULE.match(site.file.document.text, header)
    return Span(*match.span(1)) if match is not None and match[1].count("|") == columns + 1 else None


def _bars(text: str, within: Span) -> Iterator[int]:
    return (position for position in range(within.start, within.end) if text[position] == "|")
