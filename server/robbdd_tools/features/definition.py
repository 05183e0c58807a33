"""Go to definition: from a reference or an import to the place that declares it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.cursor import cursor_at

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import Definition, FileAnalysis
    from robbdd_tools.names.project import Snapshot


def symbol_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, Definition] | None:
    """Return the name under a cursor (absolute span) with its definition, where it is used or declared."""
    analysis = snapshot.file(uri)
    if analysis is None:
        return None
    placed = next((entry for entry in reversed(analysis.declarations) if entry.offset <= offset), None)
    if placed is not None:
        for ref in placed.targets:
            span = ref.span.shifted(placed.offset)
            if span.contains(offset):
                return span, placed.targets[ref]
        for symbol in placed.declaration.symbols:
            span = symbol.span.shifted(placed.offset)
            if span.contains(offset) and symbol.path in analysis.definitions:
                return span, analysis.definitions[symbol.path]
    return _in_broken_text(snapshot, analysis, offset)


def definition(snapshot: Snapshot, uri: str, offset: int) -> tuple[str, Span] | None:
    """Return the document and absolute span that a cursor's name or import leads to."""
    analysis = snapshot.file(uri)
    if analysis is None:
        return None
    for link in analysis.imports:
        if link.span.contains(offset) and link.problem is None:
            return link.uri, Span(0, 0)
    found = symbol_at(snapshot, uri, offset)
    return None if found is None else (found[1].uri, found[1].span)


def _in_broken_text(snapshot: Snapshot, analysis: FileAnalysis, offset: int) -> tuple[Span, Definition] | None:
    """Look a qualified name up by its text where it is missing from the tree of a broken declaration."""
    cursor = cursor_at(analysis, offset)
    if cursor.quoted is not None or cursor.placed is None:
        return None
    text = analysis.document.text
    declaration = cursor.placed.declaration
    is_reference = text.startswith("<", cursor.span.start - 1)
    if declaration.tree is not None and not (declaration.faults and is_reference):
        return None
    end = offset
    while end < len(text) and (text[end].isalnum() or text[end] in "_-."):
        end += 1
    path = text[cursor.span.start : end]
    scope = snapshot.scope(analysis.document.uri)
    for name in (*(f"{prefix}.{path}" for prefix in cursor.scopes), path):
        for file, declared in scope.find(name):
            return Span(cursor.span.start, end), scope.define(file, declared)
    return None
