"""The declarations in the graph of a file. Some of them are unreliable because of errors.

A story with scenarios is treated scenario by scenario: the part before its scenarios (its *head*) and each scenario are
entries of their own. So an error or an edit in one scenario does not concern the others.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, groupby
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.syntax.declaration import Declaration

Key = tuple[str, int]
"""Key of a declaration within one revision: its document and its offset."""


@dataclass(frozen=True, slots=True)
class Reached:
    """A declaration, or a part of a story, in a graph. ``own`` is true if it is in the main file of the graph.

    ``key`` identifies it among all declarations and parts of the revision. ``story`` is the story of a part.
    """

    file: FileAnalysis
    placed: PlacedDeclaration
    own: bool
    key: Key
    story: PlacedDeclaration | None = None

    @property
    def uri(self) -> str:
        """The URI of its document."""
        return self.key[0]

    @property
    def tree(self) -> tree.ChunkTree | None:
        """Its syntax tree. It is ``None`` if the declaration is broken, and for the head of a story."""
        return self.placed.declaration.tree

    @property
    def is_head(self) -> bool:
        """Whether the part is the head of a story."""
        return self.story is not None and self.placed.offset == self.story.offset

    def holds(self, definition: Definition) -> bool:
        """Return whether a definition is a part of the declaration."""
        return self.covers(Location(definition.uri, definition.span))

    def covers(self, location: Location) -> bool:
        """Return whether the declaration contains a place."""
        span = self.placed.span
        return location.uri == self.uri and span.start <= location.span.start < span.end


class Uses:
    """References between the declarations of a file and its imports (``closure``, the file first).

    The declarations of the first file and of the files ``together`` count as its own.
    """

    def __init__(self, closure: Sequence[FileAnalysis], together: Collection[str] = ()) -> None:
        own = {closure[0].document.uri, *together} if closure else set[str]()
        self._files = {
            file.document.uri: tuple(_entries(file, placed, file.document.uri in own) for placed in file.declarations)
            for file in reversed(closure)
        }
        self._found: dict[Key, list[Reached]] = {}
        self._errors: dict[str, list[int]] = {}
        self._stories: dict[Key, tuple[Reached, ...]] = {
            entries[0].key: entries for entries in chain(*self._files.values()) if entries[0].story is not None
        }
        self._by_path: dict[Key, dict[str, list[Reached]]] = {}

    def __iter__(self) -> Iterator[Reached]:
        """Yield all declarations, imported files before the files that import them, each file in text order.

        For a story with scenarios, its parts are yielded.
        """
        return chain.from_iterable(chain.from_iterable(self._files.values()))

    def story(self, entry: Reached) -> tuple[Reached, ...]:
        """Return all parts of the story to which a part belongs, the head first; empty for a whole declaration."""
        return () if entry.story is None else self._stories[entry.uri, entry.story.offset]

    def of(self, entry: Reached) -> list[Reached]:
        """Return the declarations to which a declaration refers, in the order of its references.

        A declaration without an explicit namespace also refers to the namespace declaration of its file.
        """
        key = entry.key
        if key not in self._found:
            found: list[Reached] = []
            for uri, position, path in entry.placed.targets.declarations():
                entries = self._files[uri][position]
                found += entries if len(entries) == 1 else self._declarers(entries, path)
            if any(symbol.namespace == FILE_NAMESPACE for symbol in entry.placed.declaration.symbols):
                found += [other for (other, *_) in self._files[entry.uri] if isinstance(other.tree, tree.Namespace)]
            self._found[key] = found
        return self._found[key]

    def _declarers(self, story: tuple[Reached, ...], path: str) -> list[Reached]:
        """Return the parts of a story that declare a qualified name."""
        key = story[0].key
        if key not in self._by_path:
            declared: dict[str, list[Reached]] = {}
            for part in story:
                for symbol in part.placed.declaration.symbols:
                    declared.setdefault(symbol.path, []).append(part)
            self._by_path[key] = declared
        return self._by_path[key].get(path, [story[0]])

    def has_error(self, entry: Reached) -> bool:
        """Return whether a declaration has an error or an unresolved reference.

        The head of a story has an error if any part of the story has one.
        """
        if entry.is_head and entry.story is not None:
            return self._has_error_in(entry, entry.story.span) or any(map(self.has_error, self.story(entry)[1:]))
        if entry.tree is None or len(entry.placed.targets) < _distinct_references(entry.placed.declaration):
            return True
        return self._has_error_in(entry, entry.placed.span)

    def _has_error_in(self, entry: Reached, span: Span) -> bool:
        if entry.uri not in self._errors:
            faults = (fault for fault in entry.file.diagnostics if fault.severity is Severity.ERROR)
            self._errors[entry.uri] = sorted(fault.span.start for fault in faults)
        return _covers_one(span, self._errors[entry.uri])


def _entries(file: FileAnalysis, placed: PlacedDeclaration, own: bool) -> tuple[Reached, ...]:
    """Split a story with scenarios into its head and its scenarios. Any other declaration is a single entry."""
    uri = file.document.uri
    if not placed.declaration.parts or placed.declaration.tree is None:
        return (Reached(file, placed, own, (uri, placed.offset)),)
    return tuple(Reached(file, part, own, (uri, part.offset), placed) for part in placed.parts[:-1])


def reachable_declarations(uses: Uses, described: Collection[str] = ()) -> tuple[Reached, ...]:
    """Return all declarations of the first file and all declarations that are reachable from them.

    Imported files are before the files that import them. If a part of a story is reachable, the whole story is. The
    elements and sets among the nodes ``described`` by imported graphs are reachable, too: without their types, these
    statements would be wrong. Stories and templates are not, because a file has the criteria of its own only.
    """
    every = tuple(uses)
    waiting = [entry for entry in every if entry.own]
    elements = [entry for entry in every if not entry.own and isinstance(entry.tree, tree.ElementSet | tree.SimilarSet)]
    waiting += chain.from_iterable(declarers_of(elements, described).values())
    found = {entry.key for entry in waiting}
    while waiting:
        entry = waiting.pop()
        for used in (*uses.of(entry), *(uses.story(entry) if entry.is_head or not entry.own else ())):
            if used.key not in found:
                found.add(used.key)
                waiting.append(used)
    return tuple(entry for entry in every if entry.key in found)


def declarers_of(entries: Iterable[Reached], nodes: Collection[str]) -> dict[str, list[Reached]]:
    """Map each of some nodes (IRIs) to those of the ``entries`` that declare it. Other nodes are left out."""
    found: dict[str, list[Reached]] = {}
    for _, several in groupby(entries if nodes else (), key=lambda entry: entry.uri):
        inside = list(several)
        starts = [entry.placed.offset for entry in inside]
        for definition in inside[0].file.definitions.values():
            iri, position = definition.iri, bisect_right(starts, definition.span.start) - 1
            if iri is not None and iri in nodes and position >= 0 and inside[position].holds(definition):
                found.setdefault(iri, []).append(inside[position])
    return found


def unreliable_declarations(
    uses: Uses, reached: Sequence[Reached], left_out: Iterable[Location]
) -> tuple[Reached, ...]:
    """Return the declarations about which further findings are not reliable.

    A declaration is unreliable if it has an error or an omitted part, or if it uses an incomplete declaration. A broken
    declaration is incomplete, and so is a set, composition or scene with an error. An error inside a template or a
    story does not make its users unreliable. The head of a story is unreliable if one of its scenarios is.
    """
    starts: dict[str, list[int]] = {}
    for place in sorted(left_out, key=lambda location: location.span.start):
        starts.setdefault(place.uri, []).append(place.span.start)
    suspect = [
        entry for entry in reached if uses.has_error(entry) or _covers_one(_extent(entry), starts.get(entry.uri, ()))
    ]
    spreading = [
        entry for entry in suspect if entry.story is None and not isinstance(entry.tree, tree.Template | tree.Story)
    ]
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


def _extent(entry: Reached) -> Span:
    return entry.story.span if entry.is_head and entry.story is not None else entry.placed.span


def _covers_one(span: Span, starts: Sequence[int]) -> bool:
    """Return whether a span contains any of the sorted offsets."""
    first = bisect_left(starts, span.start)
    return first < len(starts) and starts[first] < span.end


@kept_with_key
def _distinct_references(declaration: Declaration) -> int:
    return len({reference.ref for reference in declaration.references})
