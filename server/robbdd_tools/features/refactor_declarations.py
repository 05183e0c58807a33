"""Refactorings of whole declarations: rewrite them in the current syntax, or move a scene to a new file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, NewFile
from robbdd_tools.base.document import Span
from robbdd_tools.checks.lines import import_edit
from robbdd_tools.checks.published_form import published_form
from robbdd_tools.features.references import uses
from robbdd_tools.names.imports import import_path
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot


def modernised(snapshot: Snapshot, uri: str) -> Fix | None:
    """Return the edits that rewrite a whole file in the current syntax. The graph of the file stays the same."""
    file = snapshot.file(uri)
    found = list(published_form(snapshot, file)) if file is not None else []
    edits = tuple(edit for diagnostic in found for fix in diagnostic.fixes for edit in fix.edits)
    return Fix("Rewrite the whole file in the current form", edits) if edits else None


def split_scene(snapshot: Snapshot, uri: str, offset: int) -> Fix | None:
    """Return the fix that moves the scene at an offset into a new file.

    The new file imports the old file, and the files that use the scene import the new file. The contents of all graphs
    that contain the scene stay the same.
    """
    file = snapshot.file(uri)
    placed = None if file is None else _declaration_at(file, offset)
    root = None if placed is None else placed.declaration.tree
    if file is None or placed is None or not isinstance(root, tree.Scene) or placed.declaration.faults:
        return None
    definition = file.definitions[root.name.text]
    target = f"{uri.rpartition('/')[0]}/{root.name.text}.scene"
    back = import_path(target, uri)
    if target in snapshot.sources or back is None:
        return None
    users = sorted({user for user, _ in uses(snapshot, definition)} - {uri})
    edits = [Edit(uri, _with_line_end(file, placed), "")]
    for user in users:
        importing, path = snapshot.file(user), import_path(user, target)
        if importing is not None and path is not None:
            edits.append(import_edit(importing, path))
    text = f'import "{back}"\n\n{placed.declaration.text.rstrip()}\n'
    return Fix(f"Move the scene to '{root.name.text}.scene'", tuple(edits), NewFile(target, text))


def _declaration_at(file: FileAnalysis, offset: int) -> PlacedDeclaration | None:
    return next((placed for placed in reversed(file.declarations) if placed.offset <= offset), None)


def _with_line_end(file: FileAnalysis, placed: PlacedDeclaration) -> Span:
    """Return the span of a declaration, including the white space up to the next declaration or comment."""
    text = placed.declaration.text
    comment = re.search(r"\n[ \t]*//", text)
    end = placed.span.end if comment is None else placed.offset + comment.start() + 1
    return Span(placed.offset, min(end, len(file.document.text)))
