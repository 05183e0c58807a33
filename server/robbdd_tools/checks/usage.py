"""Determine the names that a file uses, and whether other files could use its declarations."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.checks.facts import facts_of
from robbdd_tools.checks.finding import removal
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration, SymbolKind


def used_names(file: FileAnalysis) -> frozenset[str]:
    """Return the first parts of all names that a file refers to."""
    return _used_by(tuple(placed.declaration for placed in file.declarations))


@lru_cache(maxsize=8)
def _used_by(declarations: tuple[Declaration, ...]) -> frozenset[str]:
    return frozenset[str]().union(*(facts_of(declaration).heads for declaration in declarations))


def has_story(file: FileAnalysis) -> bool:
    """Return whether a file has scenarios. A file without scenarios is a library for other files."""
    return any(isinstance(placed.declaration.tree, tree.Story) for placed in file.declarations)


def unused_declarations(snapshot: Snapshot, file: FileAnalysis, kind: SymbolKind) -> Iterator[Definition]:
    """Yield the declarations of a kind that neither the file nor the files that import it use.

    A file without scenarios has none, because it is a library.
    """
    if not has_story(file):
        return
    used = used_names(file)
    declared = (placed.declaration.symbols[0] for placed in file.declarations if placed.declaration.symbols)
    paths = [symbol.path for symbol in declared if symbol.kind is kind and symbol.path not in used]
    if not paths:
        return
    importers = (snapshot.file(uri) for uri in snapshot.importers(file.document.uri))
    used_elsewhere = frozenset[str]().union(*(used_names(each) for each in importers if each is not None))
    yield from (file.definitions[path] for path in dict.fromkeys(paths) if path not in used_elsewhere)


def unused(file: FileAnalysis, definition: Definition, code: str) -> Diagnostic:
    """Return the hint that a declaration is unused, with the fix that removes the declaration."""
    words = f"{definition.kind} '{definition.symbol.path}'"
    fix = removal(file.document, f"Remove {words}", definition.extent)
    message = f"the {words} is never used: use it, or remove it"
    return Diagnostic(file.document.uri, definition.span, Severity.HINT, code, message, fixes=(fix,))
