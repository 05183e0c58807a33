"""Read models that are graphs in Turtle or JSON-LD, from any author, with the source position of each node."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.graph.rdf.prefixes import bind_prefixes, user_prefixes
from robbdd_tools.graph.rdf.records import Records
from robbdd_tools.graph.rdf.serialize import UnreadableGraph
from robbdd_tools.graph.read.acceptance import incomplete_variants
from robbdd_tools.graph.write.built import BuiltGraph
from robbdd_tools.graph.write.foreign_imports import merge_imports
from robbdd_tools.graph.write.foreign_namespaces import foreign_namespaces
from robbdd_tools.graph.write.node_positions import json_occurrences, turtle_occurrences
from robbdd_tools.graph.write.older_clauses import complete_clauses
from robbdd_tools.graph.write.published_executions import complete_executions
from robbdd_tools.graph.write.source_map import Location, SourceMap

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

    from robbdd_tools.base.document import Document

    Owners = list[tuple[Node, Node]]
    """Blank node → the named node to which it belongs."""


def read_graph_file(document: Document, others: Sequence[Document] = ()) -> BuiltGraph:
    """Return the graph of a document. If it cannot be parsed, return an empty graph with a fault."""
    from rdflib import Graph

    uri = document.uri
    try:
        merged = merge_imports(document, others)
    except UnreadableGraph as error:
        fault = Diagnostic(uri, Span(error.offset, error.offset), Severity.ERROR, "graph-syntax", str(error))
        return BuiltGraph(uri, Graph(), SourceMap({}), {}, (), (), frozenset(), (fault,), True)
    graph = merged.graph
    complete_clauses(graph)
    complete_executions(graph)
    owners = blank_owners(graph)
    places = graph_places(merged.documents, graph, owners)
    names = node_names(graph, owners)
    records = Records(graph)
    faults = (*merged.faults, *foreign_namespaces(document, graph), *_left_out(uri, records, places, names))
    return BuiltGraph(uri, graph, places, names, (), (), frozenset(), faults, True, records=records)


def node_names(graph: Graph, owners: Owners | None = None) -> dict[str, str]:
    """Return the names of nodes for findings, which are CURIEs.

    A blank node has the name of the node to which it belongs. ``owners`` are the owners in the graph, if known.
    """
    from rdflib import BNode, Graph, URIRef

    short = Graph(bind_namespaces="none")
    prefixes = bind_prefixes(short, user_prefixes(graph))
    ordered = sorted(((namespace, prefix) for prefix, namespace in prefixes.items()), key=lambda pair: -len(pair[0]))
    names: dict[str, str] = {}
    for node in {str(node) for triple in graph for node in triple if isinstance(node, URIRef)}:
        names[node] = node
        for namespace, prefix in ordered:
            if node.startswith(namespace) and len(node) > len(namespace):
                names[node] = f"{prefix}:{node[len(namespace) :]}"
                break
    for owner, node in blank_owners(graph) if owners is None else owners:
        if isinstance(node, BNode) and str(owner) in names:
            names.setdefault(str(node), f"a node of {names[str(owner)]}")
    return names


def blank_owners(graph: Graph) -> Owners:
    """Return a map from each blank node to the named node that leads to it."""
    from rdflib import BNode

    inner: dict[Node, list[Node]] = {}
    for subject, _, value in graph:
        if isinstance(value, BNode):
            inner.setdefault(subject, []).append(value)
    found: Owners = []
    seen: set[Node] = set()
    for root in sorted((subject for subject in inner if not isinstance(subject, BNode)), key=str):
        waiting = list(inner[root])
        while waiting:
            node = waiting.pop()
            if node not in seen:
                seen.add(node)
                found.append((root, node))
                waiting += inner.get(node, ())
    return found


def graph_places(documents: Iterable[Document], graph: Graph, owners: Owners | None = None) -> SourceMap:
    """Return the positions of the nodes of a graph in its texts.

    A blank node has the position of the node to which it belongs. If several texts contain a node, the last one
    determines its position, because earlier texts import the text that describes the node. ``owners`` are the owners in
    the graph, if known.
    """
    namespaces = {prefix: str(namespace) for prefix, namespace in graph.namespaces()}
    places: dict[str, Location] = {}
    for document in documents:
        find = json_occurrences if graph_format(document.uri) == "json-ld" else turtle_occurrences
        found = find(document.text, namespaces, document.uri)
        places |= {node: Location(document.uri, span) for node, span in found.items()}
    for owner, node in blank_owners(graph) if owners is None else owners:
        if str(owner) in places:
            places[str(node)] = places[str(owner)]
    return SourceMap({(node,): (place,) for node, place in places.items()})


def _left_out(uri: str, records: Records, places: SourceMap, names: dict[str, str]) -> list[Diagnostic]:
    """Report the scenario variants that runs would leave out."""
    found: list[Diagnostic] = []
    for variant, reason in incomplete_variants(records).items():
        place = places.node(variant) or Location(uri, Span(0, 0))
        for node in sorted({word for word in reason.split() if word in names}, key=len, reverse=True):
            reason = reason.replace(node, f"'{names[node]}'")
        message = f"'{names.get(variant, variant)}' cannot become scenarios: {reason}"
        found.append(Diagnostic(uri, place.span, Severity.ERROR, "incomplete-variant", message))
    return found
