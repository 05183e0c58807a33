"""The request ``robbdd/graph``: draw the graph of a document while it is edited.

The parameters are ``uri`` and, optionally, ``position`` (of the cursor), ``iri`` (of the selected node) and ``most``
(the number of nodes to draw). ``docs/schemas/graph.schema.json`` describes the answer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robbdd_tools.features.graph_picture import MAX_DRAWN, GraphPicture, graph_picture
from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.last_valid import LastValid
from robbdd_tools.lsp.parameters import Parameters

if TYPE_CHECKING:
    from robbdd_tools.graph.ask.structure import Node
    from robbdd_tools.graph.write.source_map import Location
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.names.project import Snapshot

GRAPH = "robbdd/graph"
NOTHING: dict[str, Any] = {"svg": "", "nodes": [], "places": [], "shown": 0, "total": 0, "root": None}


def register_graph(server: RobbddServer) -> None:
    """Add the request to a server."""
    kept = LastValid()
    server.when_closed.append(kept.forget)

    @server.feature(GRAPH)
    async def show(ls: RobbddServer, params: Any) -> dict[str, Any]:
        asked = Parameters(params)

        def answer(snapshot: Snapshot) -> dict[str, Any]:
            uri = asked.text("uri")
            made, problem = kept.of(snapshot, uri, None, lambda: _drawn(snapshot, ls.convert, asked))
            return {"uri": uri, "problem": problem, **(made or NOTHING)}

        return await ls.in_background(answer)


def _drawn(snapshot: Snapshot, convert: Converter, asked: Parameters) -> dict[str, Any]:
    uri = asked.text("uri")
    position = asked.optional_position("position")
    offset = None if position is None else convert.offset(document_of(snapshot, uri), position)
    before = asked.optional_text("iri") or ""
    most = asked.optional_number("most") or MAX_DRAWN
    return _answer(snapshot, convert, graph_picture(snapshot, uri, offset, before, most))


def _answer(snapshot: Snapshot, convert: Converter, made: GraphPicture) -> dict[str, Any]:
    def place(location: Location) -> dict[str, Any]:
        return {"uri": location.uri, "range": convert.range(document_of(snapshot, location.uri), location.span)}

    def node(entry: Node) -> dict[str, Any]:
        source = None if entry.location is None else place(entry.location)
        return {"iri": entry.iri, "concept": entry.concept, "name": entry.name, "source": source}

    return {
        "svg": made.svg,
        "nodes": [node(entry) for entry in made.nodes],
        "places": [{"iri": iri, **place(location)} for iri, location in made.places],
        "shown": len(made.nodes),
        "total": made.total,
        "root": None if made.root is None else node(made.root),
    }
