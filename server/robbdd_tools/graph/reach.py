"""Which declarations belong to a file's graph, and which of them are in doubt because of errors."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.graph.source_map import Location
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import Definition, FileAnalysis, PlacedDeclaration

_Key = tuple[str, int]


@dataclass(frozen=True, slots=True)
class Reached:
    """A declaration that belongs to a graph; ``own`` when it stands in the file the graph is made of."""

    file: FileAnalysis
    placed: PlacedDeclaration
    own: bool

    @property
    def uri(self) -> str:
        """The document it stands in."""
        return self.file.document.uri

    @property
    def tree(self) -> tree.DeclarationTree | None:
        """Its tree, ``None`` when it is broken."""
        return self.placed.declaration.tree

    @property
    def key(self) -> _Key:
        """What identifies it among all declarations."""
        return (self.uri, self.placed.offset)

    def holds(self, definition: Definition) -> bool:
        """Tell whether a definition is part of it."""
        return self.covers(Location(definition.uri, definition.span))

    def covers(self, location: Location) -> bool:
        """Tell whether a place is inside it."""
        span = self.placed.span
        return location.uri == self.uri and span.start <= location.span.start < span.end


def reach(closure: Sequence[FileAnalysis]) -> tuple[Reached, ...]:
    """Return all declarations of the first file and those it leads to, imports before their importers."""
    every = [Reached(file, placed, file is closure[0]) for file in closure for placed in file.declarations]
    index = _Index(every)
    found = {entry.key for entry in every if entry.own}
    waiting = [entry for entry in every if entry.own]
    while waiting:
        for used in index.uses(waiting.pop()):
            if used.key not in found:
                found.add(used.key)
                waiting.append(used)
    order = {file.document.uri: position for position, file in enumerate(reversed(closure))}
    return tuple(sorted((entry for entry in every if entry.key in found), key=lambda e: (order[e.uri], e.key[1])))


def doubtful(reached: Sequence[Reached], left_out: Iterable[Location]) -> tuple[Reached, ...]:
    """Return the declarations about which no further finding can be trusted.

    These are the ones with an error or of which something was left out, and those that use one of which something
    is missing: a broken one, or a set, composition or scene with an error. An error inside a template or story says
    nothing about its users.
    """
    places = tuple(left_out)
    suspect = [entry for entry in reached if _has_error(entry) or any(map(entry.covers, places))]
    spreading = [entry for entry in suspect if not isinstance(entry.tree, tree.Template | tree.Story)]
    index = _Index(reached)
    users: dict[_Key, list[Reached]] = {}
    for entry in reached:
        for used in index.uses(entry):
            users.setdefault(used.key, []).append(entry)
    found = {entry.key for entry in suspect}
    reaching = {entry.key for entry in spreading}
    while spreading:
        for user in users.get(spreading.pop().key, ()):
            if user.key not in reaching:
                reaching.add(user.key)
                spreading.append(user)
    return tuple(entry for entry in reached if entry.key in found | reaching)


class _Index:
    """Finds the declaration that a definition is part of."""

    def __init__(self, entries: Iterable[Reached]) -> None:
        self._by_uri: dict[str, list[Reached]] = {}
        for entry in entries:
            self._by_uri.setdefault(entry.uri, []).append(entry)
        self._starts = {uri: [entry.placed.offset for entry in found] for uri, found in self._by_uri.items()}

    def uses(self, entry: Reached) -> list[Reached]:
        """Return the declarations that the references of one lead to."""
        found = (self._at(definition) for definition in entry.placed.targets.values())
        return [used for used in found if used is not None]

    def _at(self, definition: Definition) -> Reached | None:
        starts = self._starts.get(definition.uri, [])
        position = bisect_right(starts, definition.span.start) - 1
        if position < 0:
            return None
        entry = self._by_uri[definition.uri][position]
        return entry if entry.holds(definition) else None


def _has_error(entry: Reached) -> bool:
    if entry.tree is None or any(
        reference.ref not in entry.placed.targets for reference in entry.placed.declaration.references
    ):
        return True
    errors = (fault for fault in entry.file.diagnostics if fault.severity is Severity.ERROR)
    return any(entry.covers(Location(fault.uri, fault.span)) for fault in errors)
