"""The import graph of a snapshot and an index of the names that its files declare, computed once for all files.

A file *reaches* itself and everything that it imports, directly or indirectly. Files that import each other reach the
same files, so reachability is stored for each strongly connected component, with one bit for each other component.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from weakref import WeakKeyDictionary

from robbdd_tools.base.files import Unreadable
from robbdd_tools.names.imports import components
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.indirect_names import targets_in
from robbdd_tools.names.name_table import changed_paths
from robbdd_tools.syntax.declaration import SymbolKind

Source = FileIndex | Unreadable


class Reachability:
    """The imports among the files of one snapshot. Everything is computed at the first access."""

    def __init__(self, sources: Mapping[str, Source]) -> None:
        self.sources = sources

    @cached_property
    def cycles(self) -> Mapping[str, int]:
        """URI of a file → a number. Files that import each other, directly or indirectly, have the same number."""
        return components({uri: _imports(source) for uri, source in self.sources.items()})

    def cycle(self, uri: str) -> tuple[str, ...]:
        """Return a file and all files that import it and are imported by it, even indirectly, in alphabetical order."""
        return self.members[self.cycles[uri]] if uri in self.cycles else (uri,)

    @cached_property
    def members(self) -> Mapping[int, tuple[str, ...]]:
        """Number in ``cycles`` → its files in alphabetical order."""
        found: dict[int, list[str]] = {}
        for uri, number in self.cycles.items():
            found.setdefault(number, []).append(uri)
        return {number: tuple(sorted(uris)) for number, uris in found.items()}

    @cached_property
    def _reached(self) -> Mapping[int, int]:
        """Number in ``cycles`` → the components that its files reach, with one bit for each."""
        bits = {number: 1 << position for position, number in enumerate(self.members)}
        found: dict[int, int] = {}
        # Components are found before those that lead to them.
        for number, uris in self.members.items():
            mask = bits[number]
            for uri in uris:
                for other in _imports(self.sources[uri]):
                    if other in self.cycles and self.cycles[other] != number:
                        mask |= found[self.cycles[other]]
            found[number] = mask
        return found

    @cached_property
    def _bits(self) -> Mapping[int, int]:
        return {number: position for position, number in enumerate(self.members)}

    def reaches(self, one: str, other: str) -> bool:
        """Return whether two files are the same, or the first one imports the other one, directly or indirectly."""
        if one not in self.cycles or other not in self.cycles:
            return one == other
        return bool(self._reached[self.cycles[one]] >> self._bits[self.cycles[other]] & 1)

    def reaches_same(self, uri: str, other: Reachability) -> bool:
        """Return whether a file reaches exactly the same revisions of the same files in another snapshot.

        The comparison is made once for all files that import each other.
        """
        first, known = self.cycle(uri)[0], self._compared.setdefault(other, {})
        if first not in known:
            known[first] = self._read(first) == other._read(first)
        return known[first]

    @cached_property
    def _compared(self) -> WeakKeyDictionary[Reachability, dict[str, bool]]:
        return WeakKeyDictionary()

    def changed_names(self, uri: str, before: Reachability) -> frozenset[str] | None:
        """Return the names in all reached files that differ in an earlier snapshot; ``None`` if imports differ.

        The names are found once for all files that import each other.
        """
        first, known = self.cycle(uri)[0], self._changed.setdefault(before, {})
        if first not in known:
            known[first] = _changed_names(before._read(first), self._read(first))
        return known[first]

    @cached_property
    def _changed(self) -> WeakKeyDictionary[Reachability, dict[str, frozenset[str] | None]]:
        return WeakKeyDictionary()

    def _read(self, uri: str) -> dict[str, FileIndex | None]:
        """Return the files that a file reaches, by URI. The value is ``None`` for a file that cannot be read."""
        found = ((other, self.sources.get(other)) for other in self.walk(uri))
        return {other: source if isinstance(source, FileIndex) else None for other, source in found}

    def walk(self, uri: str) -> Iterator[str]:
        """Yield a file and all files that it imports, directly or indirectly, breadth first."""
        waiting, seen = [uri], {uri}
        for current in waiting:
            yield current
            fresh = [other for other in _imports(self.sources.get(current)) if other not in seen]
            waiting += dict.fromkeys(fresh)
            seen.update(fresh)

    def unread(self, uri: str) -> tuple[str, ...]:
        """Return the direct and indirect imports of a file that cannot be read."""
        return tuple(other for other in self._unread if self.reaches(uri, other))

    @cached_property
    def _unread(self) -> tuple[str, ...]:
        return tuple(uri for uri, source in self.sources.items() if not isinstance(source, FileIndex))

    @cached_property
    def declaring(self) -> Mapping[str, list[str]]:
        """Qualified name → the files that declare it."""
        found: dict[str, list[str]] = {}
        for uri, source in self.sources.items():
            for path in source.names.entries if isinstance(source, FileIndex) else ():
                found.setdefault(path, []).append(uri)
        return found

    @cached_property
    def declaring_as(self) -> Mapping[tuple[str, SymbolKind], list[str]]:
        """Qualified name and kind → the files that declare the name as this kind."""
        found: dict[tuple[str, SymbolKind], list[str]] = {}
        for path, uris in self.declaring.items():
            for uri in uris:
                source = self.sources[uri]
                for kind in dict.fromkeys(source.names.kinds[path]) if isinstance(source, FileIndex) else ():
                    found.setdefault((path, kind), []).append(uri)
        return found

    @cached_property
    def standing_for(self) -> Mapping[str, list[str]]:
        """Alias → the files that define it (see ``indirect_names``)."""
        found: dict[str, list[str]] = {}
        for uri, source in self.sources.items():
            for name in targets_in(source) if isinstance(source, FileIndex) else ():
                found.setdefault(name, []).append(uri)
        return found


def _imports(source: Source | None) -> list[str]:
    return [link.uri for link in source.imports] if isinstance(source, FileIndex) else []


def _changed_names(
    before: Mapping[str, FileIndex | None], after: Mapping[str, FileIndex | None]
) -> frozenset[str] | None:
    changed: set[str] = set()
    if before.keys() != after.keys():
        return None
    for uri, new in after.items():
        old = before[uri]
        if old is new:
            continue
        if old is None or new is None or _imports(old) != _imports(new):
            return None
        changed |= changed_paths(old.names, new.names)
    return frozenset(changed)
