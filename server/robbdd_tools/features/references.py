"""References: find all uses of a name in every file of the project that can access it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.features.imported_statements import places_in_graphs
from robbdd_tools.features.studies import is_study, uses_in_study
from robbdd_tools.features.used_names import name_of, places_of, uses_by_part
from robbdd_tools.names.types import columns_of
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration


Place = tuple[str, Span]
_Places = set[tuple[int, int]]


class Highlight(NamedTuple):
    """The offsets of a place where a name is written.

    ``writes`` is true where the name is declared, and where a variation assigns values to the variable of this name.
    """

    start: int
    end: int
    writes: bool


def references(snapshot: Snapshot, uri: str, offset: int, with_declaration: bool) -> list[Place]:
    """Return the uses of the name at an offset, sorted by file and place.

    The places where imported graphs describe the declared element are included.
    """
    found = symbol_at(snapshot, uri, offset)
    if found is None:
        return []
    definition = found[1]
    places = set(uses(snapshot, definition))
    places.update((place.uri, place.span) for place in places_in_graphs(snapshot, definition))
    if with_declaration:
        places.add((definition.uri, definition.span))
    return sorted(places, key=lambda place: (place[0], place[1].start, place[1].end))


def highlights(snapshot: Snapshot, uri: str, offset: int) -> list[Highlight]:
    """Return the places of the name at an offset in the same document, in text order."""
    found = symbol_at(snapshot, uri, offset)
    file = snapshot.file(uri)
    if found is None or file is None:
        return []
    definition = found[1]
    # Pairs of numbers instead of spans: a variable may be used ten thousand times.
    if is_study(uri):
        places = {(span.start, span.end) for span in uses_in_study(snapshot, uri, definition)}
    else:
        parts = uses_by_part(snapshot, file, name_of(definition))
        places = {(part.offset + span.start, part.offset + span.end) for part, spans in parts for span in spans}
    written = _written(file) if definition.kind in (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE) else _Places()
    if definition.uri == uri:
        own = (definition.span.start, definition.span.end)
        places.add(own)
        written.add(own)
    return [Highlight(*place, place in written) for place in sorted(places)]


def _written(file: FileAnalysis) -> _Places:
    """Return the places in a file where variations name the variables to which they assign values."""
    return {
        (placed.offset + start, placed.offset + end)
        for placed in file.parts()
        for start, end in _written_in(placed.declaration)
    }


@kept_with_key
def _written_in(declaration: Declaration) -> tuple[tuple[int, int], ...]:
    return tuple(
        (ref.span.end - len(ref.path.rpartition(".")[2]), ref.span.end)
        for clauses in clauses_of(declaration)
        if isinstance(clauses.node, tree.Variant)
        for ref, _ in columns_of(clauses.node.variation)
    )


def uses(snapshot: Snapshot, definition: Definition) -> Iterator[Place]:
    """Yield every use of a name, alone or as a part of a qualified name, sorted by file and place.

    For example, a set is used in the qualified name of its element.
    """
    for uri in sorted({definition.uri, *snapshot.importers(definition.uri)}):
        file = snapshot.file(uri)
        if file is not None and is_study(uri):
            yield from ((uri, span) for span in uses_in_study(snapshot, uri, definition))
        elif file is not None:
            yield from ((uri, span) for span in places_of(snapshot, file, name_of(definition)))
