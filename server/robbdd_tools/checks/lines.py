"""Edits of whole lines: add an import, add an event, or remove an import."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix
from robbdd_tools.base.document import Span
from robbdd_tools.base.removals import removal
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.analysis import FileAnalysis, ImportLink


def import_edit(file: FileAnalysis, path: str) -> Edit:
    """Return the edit that adds an import to a file."""
    return line_below(file, (tree.Import,), f'import "{path}"')


def import_removal(file: FileAnalysis, link: ImportLink, title: str) -> Iterator[Fix]:
    """Yield the fix that removes an import."""
    for placed in file.declarations:
        root = placed.declaration.tree
        if isinstance(root, tree.Import) and placed.span.contains(link.span.start):
            yield removal(file.document, title, root.span.shifted(placed.offset))
            return


def line_below(file: FileAnalysis, kinds: tuple[type[tree.Node], ...], line: str) -> Edit:
    """Return the edit that adds a line below the last declaration of a kind.

    ``kinds`` are tried in order, and the first one that the file contains is used.
    """
    document = file.document
    for kind in kinds:
        ends = [
            placed.declaration.tree.span.end + placed.offset
            for placed in file.declarations
            if isinstance(placed.declaration.tree, kind)
        ]
        if ends:
            end = line_end(document, ends[-1])
            return Edit(document.uri, Span(end, end), f"\n{line}")
    start = 1 if document.text.startswith("\ufeff") else 0
    return Edit(document.uri, Span(start, start), f"{line}\n")


def line_end(document: Document, offset: int) -> int:
    """Return the end of the line of an offset if only white space and a comment follow; otherwise return the offset."""
    place = document.position(offset)
    rest = document.line_text(place.line)[place.column :]
    is_last = not rest.strip() or rest.lstrip().startswith("//")
    return offset + len(rest) if is_last else offset
