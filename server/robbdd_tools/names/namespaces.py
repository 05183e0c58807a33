"""The namespace of declarations that name none: the only one of their file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.syntax.declaration import FILE_NAMESPACE, SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.index import FileIndex
    from robbdd_tools.names.name_table import NameTable


def only_namespace(names: NameTable) -> str | None:
    """Return the name of a file's namespace; ``None`` when it declares none, or several."""
    declared = _namespaces(names)
    return declared[0] if len(declared) == 1 else None


@kept_with_key
def _namespaces(names: NameTable) -> tuple[str, ...]:
    return tuple(path for path, kinds in names.kinds.items() if SymbolKind.NAMESPACE in kinds)


def without_namespace(file: FileIndex) -> Iterator[Diagnostic]:
    """Yield an error for each declaration that leaves its namespace to its file, where the file has not just one."""
    if only_namespace(file.names) is not None:
        return
    for placed in file.declarations:
        declaration = placed.declaration
        whole = declaration.tree is not None and not declaration.faults
        for symbol in declaration.symbols[:1]:
            if whole and symbol.namespace == FILE_NAMESPACE:
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
