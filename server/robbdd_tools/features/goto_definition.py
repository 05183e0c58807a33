"""Go to definition: find the declaration of a referenced name, or the file of an import."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.cursor import cursor_at
from robbdd_tools.features.studies import is_study, study_name_at
from robbdd_tools.names.name_parts import find_path, parts_of

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


def symbol_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, Definition] | None:
    """Return the name at an offset and its definition. The offset may be at a use or at the declaration.

    The span of the name is absolute. In a qualified name, the part at the offset is returned.
    """
    analysis = snapshot.file(uri)
    if analysis is None:
        return None
    if is_study(uri):
        return study_name_at(snapshot, uri, offset)
    placed = analysis.part_at(offset)
    if placed is not None:
        inside = offset - placed.offset
        for reference in placed.declaration.references:
            if reference.ref.span.contains(inside) and reference.ref in placed.targets:
                parts = parts_of(snapshot, uri, placed, reference)
                return next((part for part in parts if part[0].contains(offset)), None)
        for symbol in placed.declaration.symbols:
            if symbol.span.contains(inside) and symbol.path in analysis.definitions:
                return symbol.span.shifted(placed.offset), analysis.definitions[symbol.path]
    return _in_broken_text(snapshot, analysis, offset)


def definition(snapshot: Snapshot, uri: str, offset: int) -> tuple[str, Span] | None:
    """Return the document and the absolute span of the definition of the name or import at an offset."""
    analysis = snapshot.file(uri)
    if analysis is None:
        return None
    for link in analysis.imports:
        if link.span.contains(offset) and link.problem is None:
            return link.uri, Span(0, 0)
    found = symbol_at(snapshot, uri, offset)
    return None if found is None else (found[1].uri, found[1].span)


def _in_broken_text(snapshot: Snapshot, analysis: FileAnalysis, offset: int) -> tuple[Span, Definition] | None:
    """Look up the text of a name.

    This is used in a broken declaration, and for a name with an unresolved part.
    """
    cursor = cursor_at(analysis, offset)
    if cursor.quoted is not None or cursor.placed is None:
        return None
    text = analysis.document.text
    is_reference = text.startswith("<", cursor.span.start - 1)
    if cursor.placed.declaration.tree is not None and not is_reference:
        return None
    end = offset
    while end < len(text) and (text[end].isalnum() or text[end] in "_-"):
        end += 1
    path = text[cursor.span.start : end]
    paths = (*(f"{scope}.{path}" for scope in cursor.scopes), path)
    found = find_path(snapshot.scope(analysis.document.uri), paths)
    return None if found is None else (Span(end - len(path.rpartition(".")[2]), end), found)
