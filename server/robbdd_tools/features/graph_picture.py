"""Draw the graph of a model as a picture whose nodes are linked to their places in the text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.names.clause_places import clauses_in

if TYPE_CHECKING:
    from robbdd_tools.graph.ask.structure import Node
    from robbdd_tools.names.project import Snapshot

MAX_DRAWN = 600
"""Maximum number of nodes in one picture; more are unreadable and slow."""


@dataclass(frozen=True, slots=True)
class GraphPicture:
    """A picture of a graph.

    - ``svg``: the picture. Each of its nodes has the attribute ``data-iri``.
    - ``nodes``: the drawn nodes.
    - ``places``: pairs of an IRI and a source range, for the declaration of each node and for every reference to it.
    - ``total``: the number of nodes of the whole graph.
    - ``root``: the node whose dependencies are drawn; ``None`` if the whole graph is drawn.
    """

    svg: str
    nodes: tuple[Node, ...]
    places: tuple[tuple[str, Location], ...]
    total: int
    root: Node | None


def graph_picture(
    snapshot: Snapshot, uri: str, offset: int | None = None, before: str = "", most: int = MAX_DRAWN
) -> GraphPicture:
    """Draw the graph of a file without errors.

    If the graph has more than ``most`` nodes, only one story is drawn: the story at ``offset`` or, if there is none,
    the story that contains the node ``before``.
    """
    from robbdd_tools.graph.ask.excerpt import limited
    from robbdd_tools.graph.ask.structure import structure_of
    from robbdd_tools.graph.ask.svg import draw
    from robbdd_tools.graph.write.build import build_graph

    structure = structure_of(build_graph(snapshot, uri))
    drawn = {node.iri for node in structure.nodes()}
    places = [entry for entry in _places(snapshot, uri) if entry[0] in drawn]
    part = limited(structure, most, [*_around(places, uri, offset), before])
    nodes = tuple(part.structure.nodes())
    shown = {node.iri for node in nodes}
    svg = draw(part.structure, lambda location: location.uri.rpartition("/")[2])
    return GraphPicture(svg, nodes, tuple(entry for entry in places if entry[0] in shown), len(drawn), part.root)


def _places(snapshot: Snapshot, uri: str) -> Iterator[tuple[str, Location]]:
    for file in snapshot.closure(uri):
        name = file.document.uri
        for definition in file.definitions.values():
            if definition.iri is not None:
                yield definition.iri, Location(name, definition.extent)
        for clause in clauses_in(snapshot, name):
            yield clause.iri, Location(name, clause.span)
        for placed in file.declarations:
            for ref, target in placed.targets.items():
                if target.iri is not None:
                    yield target.iri, Location(name, ref.span.shifted(placed.offset))


def _around(places: Sequence[tuple[str, Location]], uri: str, offset: int | None) -> list[str]:
    """Return the nodes whose source ranges contain an offset, innermost first."""
    if offset is None:
        return []
    found = [
        (location.span.end - location.span.start, iri)
        for iri, location in places
        if location.uri == uri and location.span.start <= offset <= location.span.end
    ]
    return [iri for _, iri in sorted(found)]
