"""The names that a file can use: its own names and, through its imports, the names of other files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence, Set
from functools import cached_property
from itertools import chain, islice
from typing import TYPE_CHECKING

from robbdd_tools.names.definition import Definition
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.indirect_names import instance_parts, targets_in
from robbdd_tools.names.name_table import changed_paths
from robbdd_tools.names.namespaces import namespace_of
from robbdd_tools.names.roles import VARIABLES
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.tree import Namespace

if TYPE_CHECKING:
    from robbdd_tools.names.index import Declared
    from robbdd_tools.names.name_table import Entry, NameTable
    from robbdd_tools.names.reachability import Reachability
    from robbdd_tools.syntax.declaration import Symbol


MAX_SEARCHED = 64
"""Maximum number of files that are searched one by one; larger scopes use an index of names."""


class Scope:
    """The files whose names a file can use: itself first, then its imports in order of nearness (breadth first)."""

    def __init__(self, own: FileIndex, reachability: Reachability) -> None:
        self.own = own
        self._reachability = reachability

    def __eq__(self, other: object) -> bool:
        """Return whether two scopes have the same files in the same order."""
        if self is other or not isinstance(other, Scope):
            return self is other
        if self.own is not other.own:
            return False
        if self.is_small or other.is_small:
            return self.files == other.files and self.unread == other.unread
        # The files determine their order, so it need not be compared.
        return self._reachability.reaches_same(self.own.document.uri, other._reachability)

    def walk(self) -> Iterator[FileIndex]:
        """Yield the files, nearest first. Files are searched only as far as the caller iterates."""
        sources = self._reachability.sources
        for uri in self._reachability.walk(self.own.document.uri):
            source = sources.get(uri)
            if isinstance(source, FileIndex):
                yield source

    @cached_property
    def nearest(self) -> tuple[FileIndex, ...]:
        """The nearest files, at most ``MAX_SEARCHED``."""
        return tuple(islice(self.walk(), MAX_SEARCHED))

    @cached_property
    def is_small(self) -> bool:
        """Whether ``nearest`` contains all files."""
        cycle = self._reachability.cycle(self.own.document.uri)
        return len(cycle) <= MAX_SEARCHED and next(islice(self.walk(), MAX_SEARCHED, None), None) is None

    @cached_property
    def files(self) -> tuple[FileIndex, ...]:
        """All files. In a large cycle of imports, each file has a scope of this size: look names up instead."""
        return self.nearest if self.is_small else tuple(self.walk())

    @cached_property
    def unread(self) -> tuple[str, ...]:
        """The URIs of imports that could not be read."""
        return self._reachability.unread(self.own.document.uri)

    def reaches(self, uri: str) -> bool:
        """Return whether the scope contains a file, even one that could not be read."""
        return self._reachability.reaches(self.own.document.uri, uri)

    @property
    def uris(self) -> list[str]:
        """The URIs of the files, in order."""
        return [file.document.uri for file in self.files]

    @property
    def tables(self) -> tuple[NameTable, ...]:
        """The name tables of the files. They stay identical as long as no name is added, removed or reordered."""
        return tuple(file.names for file in self.files)

    def changed_names(self, before: Scope) -> Set[str] | None:
        """Return the qualified names that differ from an earlier scope; ``None`` if the files or their order differ."""
        if not (self.is_small or before.is_small):
            return self._reachability.changed_names(self.own.document.uri, before._reachability)
        if before.uris != self.uris:
            return None
        pairs = zip(before.files, self.files, strict=True)
        return {path for old, new in pairs for path in changed_paths(old.names, new.names)}

    def file(self, uri: str) -> FileIndex:
        """Return a file of the scope."""
        found = self._reachability.sources[uri]
        assert isinstance(found, FileIndex)
        return found

    def declaring(self, path: str, kind: SymbolKind | None = None) -> Iterator[FileIndex]:
        """Yield the files that declare a qualified name, nearest first. It must have the ``kind``, if given."""
        if kind is None:
            return self._having(lambda file: path in file.names.entries, lambda reach: reach.declaring.get(path, ()))
        return self._having(
            lambda file: kind in file.names.kinds.get(path, ()), lambda reach: reach.declaring_as.get((path, kind), ())
        )

    def standing_for(self, name: str) -> Iterator[str]:
        """Yield the targets of an alias, nearest first (see ``indirect_names``)."""
        files = self._having(lambda file: name in targets_in(file), lambda reach: reach.standing_for.get(name, ()))
        return (target for file in files for target in targets_in(file)[name])

    def _having(
        self, has: Callable[[FileIndex], bool], indexed: Callable[[Reachability], Sequence[str]]
    ) -> Iterator[FileIndex]:
        """Yield the files that ``has`` accepts, nearest first. In a large scope, they are taken from the index."""
        if self.is_small:
            yield from filter(has, self.nearest)
            return
        is_own, uris = has(self.own), indexed(self._reachability)
        if is_own:
            yield self.own
        if len(uris) - is_own > 1:
            yield from filter(has, islice(self.walk(), 1, None))
        elif len(uris) > is_own:
            yield from (self.file(uri) for uri in uris if uri != self.own.document.uri and self.reaches(uri))

    def find(self, path: str) -> Iterator[tuple[FileIndex, Declared]]:
        """Yield the declarations of a qualified name, nearest first."""
        for file in self.declaring(path):
            yield from ((file, declared) for declared in file.declared(path))

    def define(self, file: FileIndex, declared: Declared) -> Definition:
        """Return the definition of a declaration in one of the files."""
        symbol = declared.symbol
        span, extent = symbol.span.shifted(declared.offset), symbol.extent.shifted(declared.offset)
        return Definition(file.document.uri, symbol, span, extent, self._iri(file, declared))

    def visible(self, kinds: Iterable[SymbolKind], scopes: tuple[str, ...]) -> dict[str, tuple[FileIndex, Declared]]:
        """Return every name of some kinds, in the form in which it can be written inside ``scopes``.

        If several declarations have the name, the nearest one is used.
        """
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
        """Return the IRI prefix of declarations of a file in a namespace, or ``None`` if it is unknown."""
        if namespace is None:
            return None
        # The namespace is looked up in the file of the declaration first, then in the files that this file imports.
        # In a large cycle, other files are not searched if the first file has it.
        for other in chain((file,), (other for other in self.declaring(namespace) if other is not file)):
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
    if symbol.kind is SymbolKind.PARAMETER:
        # Templates of a namespace share variables, but each predicate has its own parameters.
        return f"parameter-{symbol.path}"
    return f"var-{symbol.name}" if symbol.kind in VARIABLES else symbol.name
