"""The names that a file can use: its own and, through its imports, those of other files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.names.definition import Definition
from robbdd_tools.names.indirect_names import instance_parts
from robbdd_tools.names.namespaces import namespace_of
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.tree import Namespace

if TYPE_CHECKING:
    from robbdd_tools.names.index import Declared, FileIndex
    from robbdd_tools.names.name_table import Entry, NameTable
    from robbdd_tools.syntax.declaration import Symbol


@dataclass(frozen=True)
class Scope:
    """The files whose names a file can use: itself first, then its imports in order of distance.

    ``unread`` are the URIs of imports that could not be read.
    """

    files: tuple[FileIndex, ...]
    unread: tuple[str, ...]

    @property
    def uris(self) -> list[str]:
        """The files' URIs, in order."""
        return [file.document.uri for file in self.files]

    @property
    def tables(self) -> tuple[NameTable, ...]:
        """The files' name tables: identical as long as no name is added, removed or reordered."""
        return tuple(file.names for file in self.files)

    def find(self, path: str) -> Iterator[tuple[FileIndex, Declared]]:
        """Yield the declarations of a qualified name, nearest first."""
        for file in self.files:
            if path in file.names.entries:
                yield from ((file, declared) for declared in file.declared(path))

    def define(self, file: FileIndex, declared: Declared) -> Definition:
        """Return a declaration of a file in this scope as a definition."""
        symbol = declared.symbol
        span, extent = symbol.span.shifted(declared.offset), symbol.extent.shifted(declared.offset)
        return Definition(file.document.uri, symbol, span, extent, self._iri(file, declared))

    def visible(self, kinds: Iterable[SymbolKind], scopes: tuple[str, ...]) -> dict[str, tuple[FileIndex, Declared]]:
        """Return every name of some kinds as written at a place, nearest declaration first."""
        wanted = dict.fromkeys(kinds)
        names: dict[str, tuple[FileIndex, Declared]] = {}
        for position, file in enumerate(self.files):
            found: dict[str, Entry] = {}
            for kind in wanted:
                for path, entry in file.names.of_kind.get(kind, {}).items():
                    if path not in found or entry.place < found[path].place:
                        found[path] = entry
            for path, entry in found.items():
                written = shortened(path, scopes) if position == 0 else path
                names.setdefault(written, (file, file.at(entry)))
        for written, file, declared in instance_parts(self.files, wanted):
            names.setdefault(written, (file, declared))
        return names

    def _iri(self, file: FileIndex, declared: Declared) -> str | None:
        start = self.namespace_iri(file, namespace_of(file, declared.symbol))
        return None if start is None else start + local_name(declared.symbol)

    def namespace_iri(self, file: FileIndex, namespace: str | None) -> str | None:
        """Return the IRI prefix of a file's declarations in a namespace, ``None`` if unknown."""
        if namespace is None:
            return None
        # A namespace is looked up in the declaration's own file first, then in the files that it imports.
        for other in (file, *(other for other in self.files if other is not file)):
            for entry in other.names.entries.get(namespace, ()):
                root = other.declarations[entry.declaration].declaration.tree
                if isinstance(root, Namespace):
                    return root.iri.value
        return None


def shortened(path: str, scopes: tuple[str, ...]) -> str:
    """Return a qualified name relative to the innermost scope that contains it."""
    for scope in scopes:
        if path.startswith(f"{scope}."):
            return path[len(scope) + 1 :]
    return path


def local_name(symbol: Symbol) -> str:
    """Return the last part of the IRI of a declared name."""
    if symbol.kind is SymbolKind.TREE_NODE:
        # A node may have the same name as the behaviour that it executes.
        return f"node-{symbol.path}"
    return f"var-{symbol.name}" if symbol.kind in ROLE_KINDS["Variable"] else symbol.name
