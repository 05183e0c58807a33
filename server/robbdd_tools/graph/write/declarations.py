"""The declarations in the graph of a file. Some of them are unreliable because of errors."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.syntax.declaration import Declaration

Key = tuple[str, int]
"""Key of a declaration within one revision: its document and its offset."""


@dataclass(frozen=True, slots=True)
class Reached:
    """A declaration in a graph. ``own`` is true if the declaration is in the main file of the graph.

    ``key`` identifies it among all declarations of the revision.
    """

    file: FileAnalysis
    placed: PlacedDeclaration
    own: bool
    key: Key

    @property
    def uri(self) -> str:
        """The URI of its document."""
        return self.key[0]

    @property
    def tree(self) -> tree.ChunkTree | None:
        """Its syntax tree, or ``None`` if it is broken."""
        return self.placed.declaration.tree

    def holds(self, definition: Definition) -> bool:
        """Return whether a definition is a part of the declaration."""
        return self.covers(Location(definition.uri, definition.span))

    def covers(self, location: Location) -> bool:
        """Return whether the declaration contains a place."""
        span = self.placed.span
        return location.uri == self.uri and span.start <= location.span.start < span.end


class Uses:
    """References between the declarations of a file and its imports (``closure``, the file first).

    The declarations of the first file, and those of the files ``together``, are its own.
    """

    def __init__(self, closure: Sequence[FileAnalysis], together: Collection[str] = ()) -> None:
        own = {closure[0].document.uri, *together} if closure else set[str]()
        self._files = {
            file.document.uri: tuple(
                Reached(file, placed, file.document.uri in own, (file.document.uri, placed.offset))
                for placed in file.declarations
            )
            for file in reversed(closure)
        }
        self._found: dict[Key, list[Reached]] = {}
        self._errors: dict[str, list[int]] = {}

    def __iter__(self) -> Iterator[Reached]:
        """Yield all declarations, imported files before the files that import them, each file in text order."""
        return (entry for entries in self._files.values() for entry in entries)

    def of(self, entry: Reached) -> list[Reached]:
        """Return the declarations to which a declaration refers, in the order of its references.

        A declaration without an explicit namespace also refers to the namespace declaration of its file.
        """
        key = entry.key
        if key not in self._found:
            places = entry.placed.targets.declarations()
            found = [self._files[uri][position] for uri, position in places]
            if any(symbol.namespace == FILE_NAMESPACE for symbol in entry.placed.declaration.symbols):
                found += [other for other in self._files[entry.uri] if isinstance(other.tree, tree.Namespace)]
            self._found[key] = found
        return self._found[key]

    def has_error(self, entry: Reached) -> bool:
        """Return whether a declaration has an error or an unresolved reference."""
        if entry.tree is None or len(entry.placed.targets) < _distinct_references(entry.placed.declaration):
            return True
        if entry.uri not in self._errors:
            faults = (fault for fault in entry.file.diagnostics if fault.severity is Severity.ERROR)
            self._errors[entry.uri] = sorted(fault.span.start for fault in faults)
        return _covers_one(entry, self._errors[entry.uri])


def reachable_declarations(uses: Uses) -> tuple[Reached, ...]:
    """Return all declarations of the first file and all declarations that are reachable from them.

    Imported files are before the files that import them.
    """
    every = tuple(uses)
    waiting = [entry for entry in every if entry.own]
    found = {entry.key for entry in waiting}
    while waiting:
        for used in uses.of(waiting.pop()):
            if used.key not in found:
                found.add(used.key)
                waiting.append(used)
    return tuple(entry for entry in every if entry.key in found)


def unreliable_declarations(
    uses: Uses, reached: Sequence[Reached], left_out: Iterable[Location]
) -> tuple[Reached, ...]:
    """Return the declarations about which further findings are not reliable.

    A declaration is unreliable if it has an error or an omitted part, or if it uses an incomplete declaration. A broken
    declaration is incomplete, and so is a set, composition or scene with an error. An error inside a template or a
    story does not make its users unreliable.
    """
    starts: dict[str, list[int]] = {}
    for place in sorted(left_out, key=lambda location: location.span.start):
        starts.setdefault(place.uri, []).append(place.span.start)
    suspect = [entry for entry in reached if uses.has_error(entry) or _covers_one(entry, starts.get(entry.uri, ()))]
    spreading = [entry for entry in suspect if not isinstance(entry.tree, tree.Template | tree.Story)]
    users: dict[Key, list[Reached]] = {}
    for entry in reached if spreading else ():
        for used in uses.of(entry):
            users.setdefault(used.key, []).append(entry)
    found = {entry.key for entry in suspect}
    reaching = {entry.key for entry in spreading}
    while spreading:
        for user in users.get(spreading.pop().key, ()):
            if user.key not in reaching:
                reaching.add(user.key)
                spreading.append(user)
    found |= reaching
    return tuple(entry for entry in reached if entry.key in found)


def _covers_one(entry: Reached, starts: Sequence[int]) -> bool:
    """Return whether one of some sorted offsets in its file is in a declaration."""
    span = entry.placed.span
    first = bisect_left(starts, span.start)
    return first < len(starts) and starts[first] < span.end


@kept_with_key
def _distinct_references(declaration: Declaration) -> int:
    return len({reference.ref for reference in declaration.references})
