"""References: find all uses of a name in every file of the project that can access it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.features.imported_statements import places_in_graphs
from robbdd_tools.features.studies import is_study, uses_in_study
from robbdd_tools.features.used_names import name_of, places_of
from robbdd_tools.names.types import columns_of
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


Place = tuple[str, Span]


@dataclass(frozen=True, slots=True)
class Highlight:
    """A place where a name is written.

    ``writes`` is true where the name is declared, and where a variation assigns values to the variable of this name.
    """

    span: Span
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
    own = uses_in_study(snapshot, uri, definition) if is_study(uri) else None
    spans = dict.fromkeys(places_of(snapshot, file, name_of(definition)) if own is None else own)
    written = _written(file) if definition.kind in (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE) else set[Span]()
    if definition.uri == uri:
        spans[definition.span] = None
        written.add(definition.span)
    # Comparing tuples is many times as fast as comparing spans.
    ordered = sorted(spans, key=lambda span: (span.start, span.end))
    return [Highlight(span, span in written) for span in ordered]


def _written(file: FileAnalysis) -> set[Span]:
    """Return the spans in a file where variations name the variables to which they assign values."""
    return {
        Span(ref.span.end - len(ref.path.rpartition(".")[2]), ref.span.end).shifted(placed.offset)
        for placed in file.parts()
        for clauses in clauses_of(placed.declaration)
        if isinstance(clauses.node, tree.Variant)
        for ref, _ in columns_of(clauses.node.variation)
    }


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
