"""Graphs as lines of text, so that tests can list expected statements."""

from __future__ import annotations

from rdflib import BNode, Graph, Literal
from rdflib.namespace import RDF
from rdflib.term import Node

from kit import fixture
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.write.build import BuiltGraph, build_graph

SHORT = {**PREFIXES, "t": "https://example.org/t/", "lab": "https://example.org/env/"}


def built(text: str) -> BuiltGraph:
    """Build the graph of a fixture's first file."""
    case = fixture(text)
    return build_graph(case.snapshot, case.uri)


def statements(graph: Graph) -> set[str]:
    """Return ``subject predicate object`` lines; ``a`` for types, lists in parentheses, names shortened."""
    cells = (RDF.first, RDF.rest)
    return {
        f"{term(graph, s)} {'a' if p == RDF.type else term(graph, p)} {term(graph, o)}"
        for s, p, o in graph
        if p not in cells
    }


def of(graph: Graph, subject: str) -> list[str]:
    """Return the statements about one subject, sorted, without the subject."""
    found = (line for line in statements(graph) if line.startswith(f"{subject} "))
    return sorted(line.removeprefix(f"{subject} ") for line in found)


def term(graph: Graph, node: Node) -> str:
    if node == RDF.nil or isinstance(node, BNode):
        return f"({' '.join(term(graph, item) for item in graph.items(node))})"
    if isinstance(node, Literal):
        return node.n3()
    for prefix, namespace in SHORT.items():
        if str(node).startswith(namespace):
            return f"{prefix}:{str(node).removeprefix(namespace)}"
    return f"<{node}>"
