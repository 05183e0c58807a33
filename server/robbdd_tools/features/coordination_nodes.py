"""Nodes of coordination models in imported graphs, to which behaviours are linked by their IRIs."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.features.markdown import code
from robbdd_tools.features.outside_place import OutsidePlace
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.graph.write.imported_graphs import ImportedGraph
    from robbdd_tools.names.project import Snapshot

_TYPED = re.compile(r"\bnode\s*:\s*[\"']([^\"']*)\Z")


def coordination_node_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, str] | None:
    """Return the IRI of the node that is written at an offset, with its span."""
    file = snapshot.file(uri)
    placed = None if file is None else file.part_at(offset)
    root = None if placed is None else placed.declaration.tree
    for node in walk(root) if root is not None else ():
        if placed is not None and isinstance(node, tree.BehaviourUse) and node.external is not None:
            span = node.external.span.shifted(placed.offset)
            if span.contains(offset):
                return span, node.external.value
    return None


def describe_coordination_node(snapshot: Snapshot, uri: str, iri: str) -> str:
    """Return the description of a node in Markdown, with the statements of imported graphs about it."""
    from robbdd_tools.features.imported_statements import statement_lines

    graph = _imported(snapshot, uri)
    head = f"**node of a coordination model** {code(iri)}"
    lines = statement_lines(snapshot, graph, iri)
    if not lines:
        lines = ["No imported graph describes it. Behaviours that it executes are exported only."]
    return "\n\n".join((head, "\n".join(lines)))


def coordination_node_definition(snapshot: Snapshot, uri: str, iri: str) -> OutsidePlace | None:
    """Return the place where an imported graph describes a node."""
    place = _imported(snapshot, uri).places.get((iri,))
    return None if place is None else OutsidePlace(place.uri, snapshot.document(place.uri).text, place.span)


def typed_nodes(snapshot: Snapshot, uri: str, line: str) -> Iterator[tuple[str, str, str, str]]:
    """Yield the nodes of imported graphs inside the open quotes at the end of a line, as ``quoted`` does.

    Elements that models declare are left out.
    """
    match = _TYPED.search(line)
    if match is None or not any(graph_format(link.uri) for one in snapshot.closure(uri) for link in one.imports):
        return
    declared = {definition.iri for file in snapshot.closure(uri) for definition in file.definitions.values()}
    for iri in sorted(_imported(snapshot, uri).places):
        if len(iri) == 1 and ":" in iri[0] and iri[0] not in declared and iri[0].startswith(match[1]):
            yield iri[0], "node", match[1], ""


def _imported(snapshot: Snapshot, uri: str) -> ImportedGraph:
    from robbdd_tools.graph.write.imported_graphs import imported_graph

    return imported_graph(snapshot, uri)
