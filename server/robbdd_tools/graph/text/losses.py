"""Compare a graph, triple by triple, with the graph of its text. Labels of blank nodes do not matter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.catalog.term_prefixes import WORKBENCH
from robbdd_tools.graph.rdf.lists import Lists
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.write.foreign import node_names

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

_PARTS = ("bdd:of-scenario", "bdd:has-scene", "bdd:given", "bdd:when", "bdd:then", "bdd:has-variation")


@dataclass(frozen=True, slots=True)
class Losses:
    """The differences between two graphs as lines of text.

    ``lost`` are triples that only the first graph contains. ``added`` are triples on nodes of the first graph that only
    the second graph contains. ``renamed`` are pairs of an old and a new name.
    """

    lost: tuple[str, ...]
    added: tuple[str, ...]
    renamed: tuple[tuple[str, str], ...]


def compare(before: Graph, after: Graph, renamed: Mapping[str, str]) -> Losses:
    """Compare a graph with the graph of its text.

    ``renamed`` maps each node whose name differs in the text to this name.
    """
    from rdflib.namespace import RDF

    first, second = _Side(before, node_names(before)), _Side(after, node_names(after))
    mapping = dict(renamed)
    _align(first, second, mapping)
    old = {first.line(triple, mapping): triple for triple in first.triples()}
    new = {second.line(triple, {}): triple for triple in second.triples()}
    known = {mapping.get(str(node), str(node)) for node in before.subjects()}
    lost = tuple(sorted(first.shown(old[line]) for line in old.keys() - new.keys()))
    added = (new[line] for line in new.keys() - old.keys())
    published = (
        triple
        for triple in added
        if str(triple[0]) in known and not str(triple[1]).startswith(WORKBENCH) and triple[2] != RDF.nil
    )
    names = first.names
    written = tuple(
        (names[node], second.names.get(iri, iri))
        for node, iri in sorted(renamed.items())
        if node in names and not first.is_blank(node) and not _is_made(iri)
    )
    return Losses(lost, tuple(sorted(second.shown(triple) for triple in published)), written)


def _is_made(iri: str) -> bool:
    """Return whether a name is generated. Only generated names contain a dot."""
    return "." in iri.replace("#", "/").rpartition("/")[2]


@dataclass(slots=True)
class _Side:
    graph: Graph
    names: Mapping[str, str]
    _lists: Lists = field(init=False)

    def __post_init__(self) -> None:
        self._lists = Lists(self.graph)

    def triples(self) -> Iterator[tuple[Node, Node, Node]]:
        return (triple for triple in self.graph if not self._lists.is_cell(triple[0]))

    def line(self, triple: tuple[Node, Node, Node], mapping: Mapping[str, str]) -> str:
        """Return a triple as text that is equal for both graphs."""
        return " ".join(self._term(node, mapping) for node in triple)

    def _term(self, node: Node, mapping: Mapping[str, str]) -> str:
        from rdflib import Literal

        items = self._lists.items(node)
        if items is None and self._is_empty(node):
            items = ()
        if items is not None:
            return f"({' '.join(self._term(item, mapping) for item in items)})"
        if isinstance(node, Literal):
            value = node.value if isinstance(node.value, int | float) else str(node)
            return f"{value!r}^^{node.datatype or expand('xsd:string')}@{node.language or ''}"
        return f"<{mapping.get(str(node), str(node))}>"

    def shown(self, triple: tuple[Node, Node, Node]) -> str:
        """Return a triple in readable form."""
        return " ".join(self._shown(node) for node in triple)

    def _shown(self, node: Node) -> str:
        from rdflib import Literal
        from rdflib.namespace import RDF

        items = self._lists.items(node)
        if items is not None:
            return f"({' '.join(self._shown(item) for item in items)})"
        if isinstance(node, Literal):
            return node.n3()
        return "a" if node == RDF.type else self.names.get(str(node), str(node))

    def _is_empty(self, node: Node) -> bool:
        """Return whether a blank node has no properties. Published graphs use such a node as an empty list."""
        from rdflib import BNode

        return isinstance(node, BNode) and (node, None, None) not in self.graph

    def is_blank(self, node: str) -> bool:
        from rdflib import BNode

        return (BNode(node), None, None) in self.graph

    def values(self, node: Node, term: str) -> list[Node]:
        from rdflib import URIRef

        return sorted(self.graph.objects(node, URIRef(expand(term))), key=str)

    def types(self, node: Node) -> frozenset[str]:
        return frozenset(map(str, self.values(node, "rdf:type")))


def _align(first: _Side, second: _Side, mapping: dict[str, str]) -> None:
    """Match the nodes without a written name by the paths that lead to them.

    Such nodes are parts of templates and variants.
    """
    from rdflib import URIRef

    waiting = sorted(set(first.graph.subjects()), key=str)
    while waiting:
        node = waiting.pop()
        twin = URIRef(mapping.get(str(node), str(node)))
        for term in _PARTS:
            others = second.values(twin, term)
            for part in first.values(node, term):
                if str(part) in mapping or part in others:
                    continue
                same = [other for other in others if second.types(other) == first.types(part)]
                if len(same) == 1:
                    mapping[str(part)] = str(same[0])
                    waiting.append(part)
