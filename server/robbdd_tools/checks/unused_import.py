"""``unused-import``: a file uses neither an imported file nor the imports of that file."""

from __future__ import annotations

from collections.abc import Iterator, Set
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.checks.lines import import_removal
from robbdd_tools.checks.usage import has_story, used_names

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, ImportLink
    from robbdd_tools.names.project import Snapshot


def unused_import(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report unused imports as hints. Libraries and imported files are skipped: other files use their imports."""
    if not has_story(file):
        return
    used = used_names(snapshot, file.document.uri)
    found = [link for link in file.imports if link.problem is None and _is_unused(snapshot, file, link, used)]
    if not found or snapshot.is_imported(file.document.uri):
        return
    for link in found:
        name = link.uri.rsplit("/", 1)[-1]
        fixes = tuple(import_removal(file, link, f"Remove the import of '{name}'"))
        message = f"nothing of '{name}' is used: remove this import"
        yield Diagnostic(file.document.uri, link.span, Severity.HINT, "unused-import", message, fixes=fixes)


def _is_unused(snapshot: Snapshot, file: FileAnalysis, link: ImportLink, used: Set[str]) -> bool:
    """Return whether a file uses no name of an import. This is uncertain if the imported file has an error.

    The import of a graph is never unused, because it provides statements instead of names.
    """
    scope = snapshot.scope(link.uri)
    if scope.unread or graph_format(link.uri):
        return False
    for index in scope.walk():
        if index.document.uri == file.document.uri:
            continue
        if not used.isdisjoint(index.names.entries) or any(placed.declaration.faults for placed in index.declarations):
            return False
    return True
