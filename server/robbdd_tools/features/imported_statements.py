"""Statements of imported graphs about a declaration, for hover and references."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING
from urllib.parse import unquote

from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.features.markdown import code, literal
from robbdd_tools.names.index import FileIndex

if TYPE_CHECKING:
    from robbdd_tools.graph.write.imported_graphs import ImportedGraph, Statement
    from robbdd_tools.graph.write.source_map import Location
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

MAX_STATEMENTS = 20
"""Maximum number of statements in a hover."""


def describe_statements(snapshot: Snapshot, definition: Definition) -> Iterator[str]:
    """Yield a list, in Markdown, of the statements of imported graphs about a declaration."""
    about = _graph_about(snapshot, definition)
    lines = [] if about is None else statement_lines(snapshot, about, definition.iri or "")
    if lines:
        yield "\n".join(lines)


def statement_lines(snapshot: Snapshot, graph: ImportedGraph, node: str) -> list[str]:
    """Return the first statements of a graph about a node, as the entries of a list in Markdown."""
    lines = [f"- {_sentence(snapshot, one)}" for one in graph.statements(node)]
    if len(lines) > MAX_STATEMENTS:
        lines[MAX_STATEMENTS:] = [f"- … and {len(lines) - MAX_STATEMENTS} more"]
    return lines


def describe_graph(snapshot: Snapshot, uri: str) -> str | None:
    """Describe an imported graph by the number of its statements; ``None`` if the file is not a graph."""
    if not graph_format(uri):
        return None
    from robbdd_tools.graph.write.imported_graphs import graph_of

    found = graph_of(snapshot, [uri])
    count, many = len(found.triples), len(found.subjects)
    statements = f"{count} statement{'' if count == 1 else 's'} about {many} thing{'' if many == 1 else 's'}"
    return f"**graph** {code(unquote(uri.rsplit('/', 1)[-1]))}\n\nadds {statements}"


def places_in_graphs(snapshot: Snapshot, definition: Definition) -> Iterator[Location]:
    """Yield the first place where imported graphs describe a declaration."""
    about = _graph_about(snapshot, definition)
    place = None if about is None else about.places.get((definition.iri or "",))
    if place is not None:
        yield place


def _graph_about(snapshot: Snapshot, definition: Definition) -> ImportedGraph | None:
    """Return the graphs that the file of a declaration and its importers import; ``None`` if there are none."""
    files = [snapshot.sources.get(uri) for uri in (definition.uri, *snapshot.importers(definition.uri))]
    links = dict.fromkeys(
        link.uri for file in files if isinstance(file, FileIndex) for link in file.imports if graph_format(link.uri)
    )
    if not links or definition.iri is None:
        return None
    from robbdd_tools.graph.write.imported_graphs import graph_of

    return graph_of(snapshot, list(links))


def _sentence(snapshot: Snapshot, statement: Statement) -> str:
    value = code(statement.value) if statement.is_name else literal(statement.value)
    text = f"{code(statement.property)}: {value}" if statement.property else f"type {value}"
    place = statement.place
    if place is None:
        return text
    line = snapshot.document(place.uri).position(place.span.start).line + 1
    return f"{text} ({literal(unquote(place.uri.rsplit('/', 1)[-1]))}:{line})"
