"""Read the RDF lists of a graph as Python lists. Each list is read once and without recursion."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node


class Lists:
    """The well-formed lists of a graph.

    A cell of such a list is a blank node with exactly one ``rdf:first``, one ``rdf:rest`` and no other property.
    """

    def __init__(self, graph: Graph) -> None:
        from rdflib import BNode
        from rdflib.namespace import RDF

        self._nil = RDF.nil
        self._next: dict[Node, tuple[Node, Node]] = {}
        uses: dict[Node, int] = {}
        for cell, rest in graph.subject_objects(RDF.rest):
            uses[rest] = uses.get(rest, 0) + 1
            outgoing = list(graph.predicate_objects(cell))
            first = [value for predicate, value in outgoing if predicate == RDF.first]
            if isinstance(cell, BNode) and len(outgoing) == 2 and len(first) == 1:
                self._next[cell] = (first[0], rest)
        self._inner = {cell for cell in self._next if uses.get(cell)}
        self._lists: dict[Node, tuple[Node, ...]] = {}
        self._cells: set[Node] = set()
        for head in self._next:
            if head not in self._inner and self._is_used_once(graph, head):
                self._read(head)

    def items(self, head: Node) -> tuple[Node, ...] | None:
        """Return the items of the list that begins with the cell ``head``, or ``None`` if no list does."""
        return () if head == self._nil else self._lists.get(head)

    def is_cell(self, node: Node) -> bool:
        """Return whether a node is nothing but a cell of a well-formed list."""
        return node in self._cells

    def _is_used_once(self, graph: Graph, head: Node) -> bool:
        return sum(1 for _ in graph.subjects(None, head)) == 1

    def _read(self, head: Node) -> None:
        items: dict[Node, Node] = {}
        cell = head
        while cell in self._next and cell not in items:
            item, rest = self._next[cell]
            items[cell] = item
            cell = rest
        if cell == self._nil:
            self._lists[head] = tuple(items.values())
            self._cells.update(items)
