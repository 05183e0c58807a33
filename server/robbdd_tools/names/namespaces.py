"""Determine the namespace of declarations that do not state one.

This is the only namespace of their file. If the file has several namespaces, events and tasks have the namespace of the
templates that use them, provided that these templates agree.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.syntax.declaration import FILE_NAMESPACE, SymbolKind
from robbdd_tools.syntax.tree import Template

if TYPE_CHECKING:
    from robbdd_tools.names.index import FileIndex
    from robbdd_tools.names.name_table import NameTable
    from robbdd_tools.syntax.declaration import Symbol


def only_namespace(names: NameTable) -> str | None:
    """Return the name of the only namespace of a file; ``None`` if the file declares none or several."""
    declared = _namespaces(names)
    return declared[0] if len(declared) == 1 else None


@kept_with_key
def _namespaces(names: NameTable) -> tuple[str, ...]:
    return tuple(path for path, kinds in names.kinds.items() if SymbolKind.NAMESPACE in kinds)


def namespace_of(file: FileIndex, symbol: Symbol) -> str | None:
    """Return the name of the namespace of a symbol; ``None`` if it has none or if it is ambiguous."""
    return symbol.namespace if symbol.namespace != FILE_NAMESPACE else implied_namespace(file, symbol.kind, symbol.path)


def implied_namespace(file: FileIndex, kind: SymbolKind, path: str) -> str | None:
    """Return the name of the namespace of a declaration that states none; ``None`` if it is ambiguous."""
    return only_namespace(file.names) or _by_use(file).get((kind, path))


_USED = {"Event": SymbolKind.EVENT, "Task": SymbolKind.TASK}


@kept_with_key
def _by_use(file: FileIndex) -> Mapping[tuple[SymbolKind, str], str]:
    """Map the events and tasks that templates of the file use to the namespace of these templates, if they agree."""
    found: dict[tuple[SymbolKind, str], set[str]] = {}
    for placed in file.declarations:
        declaration = placed.declaration
        if isinstance(declaration.tree, Template) and declaration.tree.namespace is not None:
            namespace = declaration.tree.namespace.reference.path
            for reference in declaration.references:
                if reference.ref.role in _USED:
                    found.setdefault((_USED[reference.ref.role], reference.ref.path), set()).add(namespace)
    return {name: min(namespaces) for name, namespaces in found.items() if len(namespaces) == 1}


def without_namespace(file: FileIndex) -> Iterator[Diagnostic]:
    """Yield an error for each declaration whose namespace is neither written nor implied."""
    if only_namespace(file.names) is not None:
        return
    for placed in file.declarations:
        declaration = placed.declaration
        whole = declaration.tree is not None and not declaration.faults
        for symbol in declaration.symbols[:1]:
            if whole and symbol.namespace == FILE_NAMESPACE and namespace_of(file, symbol) is None:
                yield _missing(file, symbol.name, symbol.span.shifted(placed.offset))


def _missing(file: FileIndex, name: str, span: Span) -> Diagnostic:
    declared = sorted(_namespaces(file.names))
    if declared:
        reason = f"this file has {len(declared)} namespaces, so '{name}' must say which: write '(ns={declared[0]})'"
    else:
        reason = f"'{name}' has no namespace: declare one, such as ns t = 'https://example.org/t/'"
    before = Span(span.start, span.start)
    fixes = tuple(
        Fix(f"Put '{name}' into '{choice}'", (Edit(file.document.uri, before, f"(ns={choice}) "),))
        for choice in declared
    )
    return Diagnostic(file.document.uri, span, Severity.ERROR, "namespace-missing", reason, fixes=fixes)
