"""The table of the names that a file declares, by path. The table stays the same while no name is edited."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.syntax.declaration import Declaration, SymbolKind


@dataclass(frozen=True, slots=True)
class Entry:
    """A declared name.

    It has a kind, the index of its declaration in the file, and the index of the name in the declaration.
    """

    kind: SymbolKind
    declaration: int
    symbol: int

    @property
    def place(self) -> tuple[int, int]:
        """The sort key that puts entries into text order."""
        return (self.declaration, self.symbol)


@dataclass(frozen=True, eq=False)
class NameTable:
    """The names of one file. Each name has all its declarations in text order.

    Tables are compared by identity. An edit that neither adds, removes nor reorders a name keeps the object.
    """

    entries: Mapping[str, tuple[Entry, ...]]
    kinds: Mapping[str, tuple[SymbolKind, ...]]

    @cached_property
    def of_kind(self) -> Mapping[SymbolKind, Mapping[str, Entry]]:
        """The names of each kind, each with the first declaration of that kind."""
        found: dict[SymbolKind, dict[str, Entry]] = {}
        for path, entries in self.entries.items():
            for entry in entries:
                found.setdefault(entry.kind, {}).setdefault(path, entry)
        return found

    @cached_property
    def repeated(self) -> tuple[str, ...]:
        """The paths that are declared more than once."""
        return tuple(path for path, entries in self.entries.items() if len(entries) > 1)


def make_table(declarations: Sequence[Declaration]) -> NameTable:
    """Return the table of a file's declarations."""
    entries: dict[str, tuple[Entry, ...]] = {}
    _add(entries, enumerate(declarations))
    return NameTable(entries, {path: _kinds(found) for path, found in entries.items()})


def update_table(old: NameTable, before: Sequence[Declaration], after: Sequence[Declaration]) -> NameTable:
    """Return the table of the declarations ``after``, given the table ``old`` of the declarations ``before``.

    If no name has changed, the same object is returned.
    """
    if len(before) != len(after):
        return make_table(after)
    changed = [position for position, declaration in enumerate(after) if declaration is not before[position]]
    renamed = [position for position in changed if _names(before[position]) != _names(after[position])]
    if not renamed:
        return old
    entries = dict(old.entries)
    touched = {path for position in renamed for path, _ in _names(before[position])}
    for path in touched:
        kept = tuple(entry for entry in entries.pop(path) if entry.declaration not in renamed)
        if kept:
            entries[path] = kept
    touched |= _add(entries, [(position, after[position]) for position in renamed])
    kinds = dict(old.kinds)
    for path in touched:
        kinds.pop(path, None)
        if path in entries:
            kinds[path] = _kinds(entries[path])
    return NameTable(entries, kinds)


def changed_paths(old: NameTable, new: NameTable) -> set[str]:
    """Return the paths on which two tables differ."""
    return set() if old is new else {path for path, _ in old.kinds.items() ^ new.kinds.items()}


def _add(entries: dict[str, tuple[Entry, ...]], declarations: Iterable[tuple[int, Declaration]]) -> set[str]:
    added: set[str] = set()
    for position, declaration in declarations:
        for number, (path, kind) in enumerate(_names(declaration)):
            entry = Entry(kind, position, number)
            others = entries.get(path)
            entries[path] = (
                (entry,) if others is None else tuple(sorted((*others, entry), key=lambda entry: entry.place))
            )
            added.add(path)
    return added


def _kinds(entries: tuple[Entry, ...]) -> tuple[SymbolKind, ...]:
    return tuple(entry.kind for entry in entries)


def _names(declaration: Declaration) -> list[tuple[str, SymbolKind]]:
    """Return the names that a declaration declares.

    The parts of a declaration need not be moved to their places for this.
    """
    every = [part.declaration for part in declaration.parts] or [declaration]
    return [(symbol.path, symbol.kind) for one in every for symbol in one.symbols]
