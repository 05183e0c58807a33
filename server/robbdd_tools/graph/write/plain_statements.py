"""Add statements to a graph. Terms are CURIEs of the vocabulary."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph, URIRef
    from rdflib.term import Node


@dataclass(frozen=True, slots=True)
class Statements:
    """Writes to ``graph``."""

    graph: Graph

    def node(self, iri: str, *types: str) -> URIRef:
        """Return a node, and state its classes."""
        from rdflib import URIRef
        from rdflib.namespace import RDF

        node = URIRef(iri)
        for type_ in types:
            self.graph.add((node, RDF.type, URIRef(expand(type_))))
        return node

    def link(self, node: URIRef, term: str, target: Node | str) -> None:
        """Link two nodes."""
        from rdflib import URIRef
        from rdflib.term import Node

        value = target if isinstance(target, Node) else URIRef(target)
        self.graph.add((node, URIRef(expand(term)), value))

    def say(self, node: URIRef, term: str, value: str | float | bool) -> None:
        """Add a literal. A float becomes an xsd:double."""
        from rdflib import URIRef

        self.graph.add((node, URIRef(expand(term)), self.literal(value)))

    def literal(self, value: str | float | bool) -> Node:
        """Return a literal. A float becomes an xsd:double."""
        from rdflib import Literal, URIRef

        double = URIRef(expand("xsd:double"))
        return Literal(repr(value), datatype=double) if isinstance(value, float) else Literal(value)

    def enlist(self, node: URIRef, term: str, items: Iterable[Node]) -> None:
        """Link a node to a list."""
        from rdflib import BNode, URIRef
        from rdflib.collection import Collection
        from rdflib.namespace import RDF

        items = list(items)
        head = Collection(self.graph, BNode(), items).uri if items else RDF.nil
        self.graph.add((node, URIRef(expand(term)), head))
