"""Collect triples with their source positions. Only this module makes nodes while a graph is built."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.vocabulary import QUANTITY, expand
from robbdd_tools.graph.write.source_map import Location, SourceMapBuilder
from robbdd_tools.syntax.tree import Quantity

if TYPE_CHECKING:
    from rdflib import Graph, URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.declarations import Key
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.syntax.tree import ChunkTree, Name, Number, Ref, Text, Truth
    from robbdd_tools.syntax.tree import Node as TreeNode

_ABSOLUTE = re.compile(r"[A-Za-z][A-Za-z0-9+.\-]*:[^\x00-\x20<>\"{}|\\^`\ud800-\udfff]*")


class Sink:
    """A graph under construction. Invalid nodes are silently left out, for example an IRI that contains a space."""

    def __init__(self) -> None:
        from rdflib import Graph
        from rdflib.namespace import RDF

        self.graph: Graph = Graph("SimpleMemory", bind_namespaces="none")
        self.sources = SourceMapBuilder()
        self.claims: dict[URIRef, Location] = {}
        self.clashes: list[tuple[URIRef, Location, Location]] = []
        self.authors: dict[str, dict[Key, None]] = {}
        self._author: Key | None = None
        self._behaviours: dict[URIRef, str] = {}
        self._type = RDF.type
        self._blank_nodes = 0

    def iri(self, text: str | None) -> URIRef | None:
        """Return the node of an absolute IRI, or ``None`` for any other text."""
        from rdflib import URIRef

        return URIRef(text) if text is not None and _ABSOLUTE.fullmatch(text) else None

    def literal(self, value: str | int | float | bool, datatype: str | None = None) -> Node:
        """Return a literal. Without a ``datatype``, it is an xsd:string, xsd:integer, xsd:double or xsd:boolean."""
        from rdflib import Literal, URIRef

        if isinstance(value, str):
            return Literal(value)  # A plain literal *is* an xsd:string, but rdflib distinguishes them.
        kinds = {bool: "xsd:boolean", int: "xsd:integer", float: "xsd:double"}
        lexical = str(value).lower() if isinstance(value, bool) else str(value)
        return Literal(lexical, datatype=URIRef(expand(datatype or kinds[type(value)])))

    def quantity(self, text: str) -> Node:
        """Return the literal of a number with a unit."""
        from rdflib import Literal, URIRef

        return Literal(text, datatype=URIRef(QUANTITY))

    def value(self, value: Number | Text | Quantity | Truth) -> Node:
        """Return the literal of a value in a set, a variation or a property."""
        return self.quantity(value.text) if isinstance(value, Quantity) else self.literal(value.value)

    def claim(self, node: URIRef, location: Location) -> bool:
        """Reserve a node for one declaration. Return true if no other declaration has reserved it."""
        first = self.claims.setdefault(node, location)
        if first != location:
            self.clashes.append((node, location, first))
        return first == location

    def claim_behaviour(self, node: URIRef, word: str, location: Location) -> bool:
        """Reserve a node for a behaviour. Templates may share the node if their behaviour has the same catalog word."""
        first = self.claims.setdefault(node, location)
        if self._behaviours.setdefault(node, word) == word and (first == location or node in self._behaviours):
            return True
        self.clashes.append((node, location, first))
        return False

    def add_types(self, node: Node, types: Iterable[str], location: Location | None = None) -> None:
        """Declare a node with its classes (CURIEs)."""
        from rdflib import URIRef

        for name in types:
            self.graph.add((node, self._type, URIRef(expand(name))))
        if location is not None:
            self.mark_node(node, location)

    def mark_node(self, node: Node, location: Location) -> None:
        """Record the place where a node is declared."""
        self.sources.mark([(str(node),)], location)
        self._credit(node)

    def begin(self, author: Key) -> None:
        """Set the declaration that is the author of the triples added from now on."""
        self._author = author

    def _credit(self, node: Node) -> None:
        if self._author is not None:
            self.authors.setdefault(str(node), {})[self._author] = None

    def add(self, node: Node, term: str, value: Node | None, location: Location | None = None) -> None:
        """Add a property of a node. If the value is ``None``, nothing is added."""
        from rdflib import URIRef

        if value is None:
            return
        self.graph.add((node, URIRef(expand(term)), value))
        self._credit(node)
        if location is not None:
            self.mark(node, term, value, location)

    def mark(self, node: Node, term: str, value: Node, location: Location) -> None:
        """Record the position of a value of a property."""
        key = (str(node), expand(term))
        self.sources.mark([key, (*key, str(value))], location)

    def mark_choice(self, variation: URIRef, variable: URIRef, value: Node, location: Location) -> None:
        """Record the place where a variation assigns a value to a variable."""
        self.sources.mark([(str(variation), str(variable), str(value))], location)

    def make_list(self, items: Iterable[Node | None]) -> Node:
        """Add an RDF list and return its head. Items that are ``None`` are left out."""
        from rdflib import BNode
        from rdflib.namespace import RDF

        present = [item for item in items if item is not None]
        cells = [(BNode(f"l{self._blank_nodes + index}"), item) for index, item in enumerate(present)]
        self._blank_nodes += len(cells)
        following = RDF.nil
        for cell, item in reversed(cells):
            self.graph.add((cell, RDF.first, item))
            self.graph.add((cell, RDF.rest, following))
            following = cell
        return following


class Frame:
    """A declaration while its triples are written: the sink, its place, and the targets of its references."""

    def __init__(self, sink: Sink, file: FileAnalysis, placed: PlacedDeclaration) -> None:
        self.sink = sink
        self.file = file
        self.placed = placed
        self._uri = file.document.uri
        self._definitions = file.definitions

    @property
    def tree(self) -> ChunkTree | None:
        """The syntax tree of the declaration."""
        return self.placed.declaration.tree

    def begin(self) -> None:
        """Make this declaration the author of the triples added from now on."""
        self.sink.begin((self._uri, self.placed.offset))

    def at(self, node: TreeNode) -> Location:
        """Return the absolute place of a node in the syntax tree of the declaration."""
        return Location(self._uri, node.span.shifted(self.placed.offset))

    def target(self, ref: Ref) -> URIRef | None:
        """Return the graph node to which a reference leads, or ``None`` if the reference is unresolved."""
        definition = self.placed.targets.get(ref)
        return None if definition is None else self.sink.iri(definition.iri)

    def node(self, path: str) -> URIRef | None:
        """Return the graph node of a name that this file declares."""
        definition = self._definitions.get(path)
        return None if definition is None else self.sink.iri(definition.iri)

    def claimed(self, path: str, name: Name) -> URIRef | None:
        """Return the graph node of a name that must be unique; ``None`` if another declaration has reserved it."""
        definition = self._definitions.get(path)
        location = self.at(name)
        if definition is None or definition.span != location.span:
            return None
        node = self.sink.iri(definition.iri)
        return node if node is not None and self.sink.claim(node, location) else None


def namespace_of(node: str, name: str) -> str:
    """Return the namespace of a node's IRI, given its local name."""
    return node.removesuffix(name)
