"""A graph with derived statements. The shapes need these statements, but SHACL cannot compute them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.catalog.term_prefixes import WORKBENCH
from robbdd_tools.graph.rdf.records import Records
from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

Key = tuple[str, ...]
"""A key of the source map."""


def use_of(word: str) -> str:
    """Return the class of all clauses that use a catalog word."""
    return f"{WORKBENCH}use-of-{word}"


@dataclass(slots=True)
class Derived:
    """A graph to validate, with derived statements.

    ``anchors`` maps a node and one of its derived values (``""`` for the node itself) to source-map keys.
    """

    graph: Graph
    records: Records
    anchors: dict[tuple[str, str], list[Key]] = field(default_factory=dict[tuple[str, str], list[Key]])
    _nodes: int = 0

    def new_node(self, types: Iterable[str]) -> Node:
        """Create a derived node with its classes."""
        from rdflib import BNode

        self._nodes += 1
        node = BNode(f"d{self._nodes}")
        for type_ in types:
            self.add(node, "rdf:type", expand(type_))
        return node

    def add(self, node: Node | str, term: str, value: Node | str | int | bool) -> None:
        """Add a derived statement. A value that is a string is the IRI or CURIE of a node."""
        from rdflib import Literal, URIRef
        from rdflib.term import Identifier

        subject = node if isinstance(node, Identifier) else URIRef(str(node))
        if isinstance(value, bool | int):
            value = Literal(value)
        elif not isinstance(value, Identifier):
            value = URIRef(str(value))
        self.graph.add((subject, URIRef(expand(term)), value))

    def anchor(self, node: Node | str, value: str, *keys: Key) -> None:
        """Record the source-map keys of a derived value of a node.

        If the value is ``""``, the keys belong to the derived node itself.
        """
        self.anchors.setdefault((str(node), value), []).extend(keys)
