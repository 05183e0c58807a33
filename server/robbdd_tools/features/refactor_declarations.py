"""Refactorings of whole declarations: to the current form, a scene to a file of its own, clauses to their template."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix
from robbdd_tools.base.document import Span
from robbdd_tools.checks.published_form import published_form
from robbdd_tools.checks.variants import scenarios
from robbdd_tools.features.describe import variants_of
from robbdd_tools.features.fixes import import_edit
from robbdd_tools.features.references import uses
from robbdd_tools.features.unimported import import_path
from robbdd_tools.names.elements import Site
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class NewFile:
    """A file that a refactoring makes."""

    uri: str
    text: str


def modernised(snapshot: Snapshot, uri: str) -> Fix | None:
    """Return the edits that write all of a file in the current form; its graph stays the same."""
    file = snapshot.file(uri)
    found = list(published_form(snapshot, file)) if file is not None else []
    edits = tuple(edit for diagnostic in found for fix in diagnostic.fixes for edit in fix.edits)
    return Fix("Write the whole file in the current form", edits) if edits else None


def split_scene(snapshot: Snapshot, uri: str, offset: int) -> tuple[Fix, NewFile] | None:
    """Return how the scene at a cursor moves into a file of its own; every graph that has it stays the same.

    The new file imports the one that the scene came from; the files that use the scene import the new one.
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
    return Fix(f"Move the scene to '{root.name.text}.scene'", tuple(edits)), NewFile(target, text)


def extracted_clauses(snapshot: Snapshot, uri: str, offset: int) -> Fix | None:
    """Return how the clauses of the variant at a cursor move into its template, whose only variant it must be.

    The scenarios stay the same; in the graph the clauses belong to the template from then on.
    """
    file = snapshot.file(uri)
    placed = None if file is None else _declaration_at(file, offset)
    if file is None or placed is None or not isinstance(placed.declaration.tree, tree.Story):
        return None
    site = Site(snapshot, file, placed)
    for scenario in scenarios(site):
        variant, template = scenario.variant, scenario.template
        definition = site.target(variant.template)
        if not site.span(variant).contains(offset) or definition is None or template is None or template.uri != uri:
            continue
        if len(list(variants_of(snapshot, definition))) > 1 or not isinstance(template.tree, tree.Template):
            continue
        parts = [("Given", variant.given, template.tree.body.given), ("Then", variant.then, template.tree.body.then)]
        edits = [edit for label, own, there in parts if own for edit in _moved(site, template, label, own, there)]
        if edits:
            return Fix(f"Move the clauses to the template '{template.tree.name.text}'", tuple(edits))
    return None


def _moved(
    site: Site, template: Site, label: str, own: tree.Expression, there: tree.Expression | None
) -> Iterator[Edit]:
    """Yield the edits that take clauses (with their label) out of a variant and put them behind a template's."""
    text = site.file.document.text
    span = site.span(own)
    labelled = re.compile(rf"[ \t]*{label}\s*:\s*\Z").search(text, 0, span.start)
    if there is None or labelled is None:
        return
    end = template.span(there).end
    column = template.file.document.position(template.span(there).start).column
    line = text.find("\n", span.end)
    yield Edit(template.uri, Span(end, end), f"\n{' ' * column}{text[span.start : span.end]}")
    rest = text[span.end : line] if line >= 0 else text[span.end :]
    yield Edit(site.uri, Span(labelled.start(), span.end if rest.strip() or line < 0 else line + 1), "")


def _declaration_at(file: FileAnalysis, offset: int) -> PlacedDeclaration | None:
    return next((placed for placed in reversed(file.declarations) if placed.offset <= offset), None)


def _with_line_end(file: FileAnalysis, placed: PlacedDeclaration) -> Span:
    """Return a declaration's text with the blank space behind it, up to the next declaration or comment."""
    text = placed.declaration.text
    comment = re.search(r"\n[ \t]*//", text)
    end = placed.span.end if comment is None else placed.offset + comment.start() + 1
    return Span(placed.offset, min(end, len(file.document.text)))
