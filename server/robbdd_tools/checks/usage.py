"""Determine the names that a file uses, and whether other files could use its declarations."""

from __future__ import annotations

from collections.abc import Iterator, Set
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.removals import removal
from robbdd_tools.checks.facts import facts_of
from robbdd_tools.checks.tally import Tally
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import SymbolKind

_HEADS = Tally[str](lambda declaration: facts_of(declaration).heads)


def used_names(snapshot: Snapshot, uri: str) -> Set[str]:
    """Return the first parts of all names that a readable file refers to."""
    return _HEADS.of(snapshot.scope(uri).own).by_fact.keys()


def has_story(file: FileAnalysis) -> bool:
    """Return whether a file has scenarios. A file without scenarios is a library for other files."""
    return bool(file.of(tree.Story))


def unused_declarations(snapshot: Snapshot, file: FileAnalysis, kind: SymbolKind) -> Iterator[Definition]:
    """Yield the top-level declarations of a kind that neither the file nor the files that import it use.

    In a file without scenarios, no declaration is unused, because the file is a library.
    """
    if not has_story(file):
        return
    used = used_names(snapshot, file.document.uri)
    declared = snapshot.scope(file.document.uri).own.names.of_kind.get(kind, {})
    paths = sorted(
        (path for path in declared if "." not in path and path not in used), key=lambda path: declared[path].place
    )
    if not paths:
        return
    importers = (snapshot.file(uri) for uri in snapshot.importers(file.document.uri))
    declarations = (placed.declaration for each in importers if each is not None for placed in each.declarations)
    used_elsewhere = frozenset[str]().union(*(facts_of(declaration).heads for declaration in declarations))
    yield from (file.definitions[path] for path in paths if path not in used_elsewhere)


def unused(file: FileAnalysis, definition: Definition, code: str) -> Diagnostic:
    """Return the hint that a declaration is unused, with the fix that removes the declaration."""
    words = f"{definition.kind} '{definition.symbol.path}'"
    fix = removal(file.document, f"Remove {words}", definition.extent)
    message = f"the {words} is never used: use it, or remove it"
    return Diagnostic(file.document.uri, definition.span, Severity.HINT, code, message, fixes=(fix,))
