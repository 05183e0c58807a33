"""Read a graph with plain Python types: properties by CURIE, lists as tuples, and literals as values."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.graph.acceptance_model import Iri, Value
from robbdd_tools.graph.rdf.canonical import sort_text
from robbdd_tools.graph.rdf.vocabulary import expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node


class Incomplete(Exception):
    """A part of a graph is incomplete, so it is left out."""


class Records:
    """Read access to a graph. If a property has several values, they are in alphabetical order."""

    def __init__(self, graph: Graph) -> None:
        from rdflib import Literal
        from rdflib.namespace import RDF

        self._literal = Literal
        self._type, self._first, self._rest, self._nil = (
            str(term) for term in (RDF.type, RDF.first, RDF.rest, RDF.nil)
        )
        self._values: dict[str, dict[str, list[Node]]] = {}
        self._instances: dict[str, list[Iri]] = {}
        subjects: dict[str, Node] = {}
        values: dict[str, dict[str, list[Node]]] = {}
        for subject, predicate, value in graph:
            subjects[str(subject)] = subject
            values.setdefault(str(subject), {}).setdefault(str(predicate), []).append(value)
        # Only subjects, and values of one property, are sorted: sorting all triples takes several times as long.
        for node in sorted(subjects, key=lambda name: sort_text(subjects[name])):
            self._values[node] = values[node]
            for several in values[node].values():
                if len(several) > 1:
                    several.sort(key=sort_text)
            for kind in values[node].get(self._type, ()):
                self._instances.setdefault(str(kind), []).append(Iri(node))

    def all(self, node: str, term: str) -> tuple[Node, ...]:
        """Return all values of a property."""
        return tuple(self._values.get(node, {}).get(expand(term), ()))

    def properties(self, node: str) -> tuple[str, ...]:
        """Return the IRIs of a node's properties in alphabetical order."""
        return tuple(sorted(self._values.get(node, {})))

    def types(self, node: str) -> frozenset[str]:
        """Return the IRIs of a node's classes."""
        return frozenset(str(kind) for kind in self._values.get(node, {}).get(self._type, ()))

    def is_a(self, node: str, term: str) -> bool:
        """Return whether a node is an instance of a class."""
        return expand(term) in self.types(node)

    def instances(self, term: str) -> tuple[Iri, ...]:
        """Return the instances of a class in alphabetical order."""
        return tuple(self._instances.get(expand(term), ()))

    def subjects(self, term: str) -> tuple[Iri, ...]:
        """Return the nodes that have a property, in alphabetical order."""
        return tuple(Iri(node) for node in self._values if self.all(node, term))

    def is_blank(self, node: Node) -> bool:
        """Return whether a node has no properties in the graph and is not an empty list."""
        return str(node) not in self._values and str(node) != self._nil

    def one(self, node: str, term: str) -> Iri:
        """Return the value of a property that must be exactly one IRI. Raises ``Incomplete`` otherwise."""
        values = self.all(node, term)
        if len(values) != 1 or isinstance(values[0], self._literal):
            raise Incomplete(f"{node} has {len(values)} values of {term}")
        return Iri(values[0])

    def literal(self, node: str, term: str) -> str | int | float | None:
        """Return the first literal value of a property, if any."""
        found = (value for value in self.all(node, term) if isinstance(value, self._literal))
        first = next(found, None)
        return None if first is None else self.value(first)

    def text(self, node: str, term: str) -> str:
        """Return the value of a property as text, or ``""`` if it is missing."""
        value = self.literal(node, term)
        return "" if value is None else str(value)

    def list_of(self, node: str, term: str) -> tuple[Node, ...]:
        """Return the items of a property's list. Raises ``Incomplete`` if the property is missing or not a list."""
        values = self.all(node, term)
        items = self.items(values[0]) if len(values) == 1 else None
        if items is None:
            raise Incomplete(f"{node} has no list {term}")
        return items

    def items(self, head: Node) -> tuple[Node, ...] | None:
        """Return the items of the RDF list that begins with the cell ``head``, or ``None`` if no list does."""
        items: list[Node] = []
        seen: set[str] = set()
        cell = str(head)
        while cell != self._nil:
            record = self._values.get(cell, {})
            first, rest = record.get(self._first, []), record.get(self._rest, [])
            if cell in seen or len(first) != 1 or len(rest) != 1:
                return None
            seen.add(cell)
            items.append(first[0])
            cell = str(rest[0])
        return tuple(items)

    def ordered(self, node: str, term: str, list_term: str) -> tuple[Node, ...]:
        """Return a property's values in list order; values missing from the list come last."""
        values = self.all(node, term)
        listed = self.all(node, list_term)
        items = (self.items(listed[0]) if listed else None) or ()
        known = set(values)
        first = tuple(item for item in items if item in known)
        known.difference_update(first)
        return first + tuple(value for value in values if value in known)

    def iris(self, nodes: Iterable[Node]) -> tuple[Iri, ...]:
        """Return the nodes that are IRIs, without all other nodes."""
        return tuple(Iri(node) for node in nodes if not isinstance(node, self._literal))

    def value(self, node: Node) -> Value:
        """Return a node as a plain value. A literal is returned as text if its datatype is not numeric."""
        if not isinstance(node, self._literal):
            return Iri(node)
        value: object = node.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            numeric = str(node.datatype) == expand("xsd:decimal") and value is not None
            return float(str(node)) if numeric else str(node)
        return value


def items_of(records: Records, node: str, term: str) -> tuple[Node, ...]:
    """Return the items of a list property; empty if there is no list."""
    heads = records.all(node, term)
    return (records.items(heads[0]) if len(heads) == 1 else None) or ()


def elements_of(records: Records, set_: str) -> tuple[Node, ...]:
    """Return the elements of a set in written order."""
    return items_of(records, set_, "rbw:element-list") or records.all(set_, "bdd:elements")
