"""Write sets that conditions select from other sets: ``obj set <parts> where colour = red``.

The selected elements are written, too, so that readers of the published vocabulary find an ordinary constant set. The
elements of a set variable differ from scenario to scenario, so only the conditions on them are written.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from robbdd_tools.base.property_conditions import Properties, PropertyCondition, chosen
from robbdd_tools.graph.property_facts import Fact, conditions_of, declared_facts, grouped, imported_facts
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import MAX_COPIES

if TYPE_CHECKING:
    from rdflib import URIRef
    from rdflib.term import Node

    from robbdd_tools.graph.write.imported_graphs import ImportedGraph
    from robbdd_tools.graph.write.sink import Frame

Placed = Sequence[tuple["tree.ChunkTree | None", "Frame"]]
SET_BY_PROPERTY = "rbw:SetByProperty"


class PropertySets:
    """Selects elements by their properties, from the declarations of a graph and the graphs that they import."""

    def __init__(self, placed: Placed, imported: ImportedGraph) -> None:
        self._placed = placed
        self._imported = imported
        self._sets: Mapping[URIRef, tuple[URIRef, ...]] | None = None
        self._properties: Mapping[str, Properties] = {}
        self._written: set[URIRef] = set()

    def members(self, frame: Frame, link: tree.Link) -> tuple[URIRef, ...] | None:
        """Return the elements of a set, or those that conditions select from the set; ``None`` if they are unknown."""
        base = frame.target(link.reference)
        conditions = () if link.where is None else conditions_of(frame.placed, link.where)
        elements = None if base is None else self._known_sets().get(base)
        if elements is None or conditions is None:
            return None
        selected = frozenset(chosen(map(str, elements), self._properties, conditions))
        return tuple(one for one in elements if str(one) in selected)

    def target(self, frame: Frame, ref: tree.Ref, where: tree.Where | None) -> URIRef | None:
        """Return the node of a set, or the node of the elements that conditions select from it; ``None`` if unknown."""
        base = frame.target(ref)
        if base is None or where is None:
            return base
        conditions = conditions_of(frame.placed, where)
        if conditions is None:
            return None
        text = repr(conditions)
        node = frame.sink.iri(f"{base}-where-{hashlib.sha256(text.encode()).hexdigest()[:8]}")
        if node is not None:
            self._add(frame, node, ref, where)
            members = self.members(frame, tree.Link(where.span, ref, where))
            for element in members or ():
                frame.sink.add(node, "bdd:elements", element)
            if members is not None and node not in self._written:
                frame.sink.add_types(node, ["bdd:ConstantSet"])
                frame.sink.add(node, "rbw:element-list", frame.sink.make_list(members))
            if node not in self._written:
                listed = list(self._condition_nodes(frame, node, where, conditions))
                frame.sink.add(node, "rbw:where", frame.sink.make_list(listed))
            self._written.add(node)
        return node

    def _add(self, frame: Frame, node: URIRef, ref: tree.Ref, where: tree.Where) -> None:
        frame.sink.add_types(node, ["bdd:Set", SET_BY_PROPERTY], frame.at(where))
        frame.sink.add(node, "rbw:subset-of", frame.target(ref), frame.at(ref))

    def _condition_nodes(
        self, frame: Frame, node: URIRef, where: tree.Where, conditions: Sequence[PropertyCondition]
    ) -> Iterator[Node]:
        sink = frame.sink
        for number, (written, condition) in enumerate(zip(where.conditions, conditions, strict=True), start=1):
            inner = sink.iri(f"{node}-{number}")
            if inner is None:
                continue
            sink.add_types(inner, ["rbw:PropertyCondition"], frame.at(written))
            sink.add(inner, "rbw:property-name", sink.literal(condition.name), frame.at(written.name))
            sink.add(inner, "rbw:comparison", sink.literal(condition.comparison))
            value = written.value
            node_of_value = frame.target(value) if isinstance(value, tree.Ref) else value and sink.value(value)
            sink.add(inner, "rbw:compared-with", sink.literal(True) if node_of_value is None else node_of_value)
            yield inner

    def _known_sets(self) -> Mapping[URIRef, tuple[URIRef, ...]]:
        if self._sets is None:
            found: dict[URIRef, tuple[URIRef, ...]] = {}
            facts: list[Fact] = []
            for root, frame in self._placed:
                if isinstance(root, tree.ElementSet | tree.SimilarSet | tree.ConstantSet):
                    node = frame.node(root.name.text)
                    if node is not None:
                        found[node] = tuple(dict.fromkeys(_elements(frame, root)))
                    facts += declared_facts(frame.file, frame.placed)
            elements = {str(element) for several in found.values() for element in several}
            facts += imported_facts(self._imported, elements)
            self._sets, self._properties = found, grouped(facts)
        return self._sets


def _elements(frame: Frame, root: tree.ElementSet | tree.SimilarSet | tree.ConstantSet) -> Iterator[URIRef]:
    match root:
        case tree.ElementSet():
            nodes = [frame.node(f"{root.name.text}.{member.name.text}") for member in root.members]
        case tree.SimilarSet():
            count = root.count.value if isinstance(root.count.value, int) else 0
            names = (f"{root.base.text}{number}" for number in range(min(count, MAX_COPIES)))
            nodes = [frame.node(f"{root.name.text}.{name}") for name in names]
        case tree.ConstantSet():
            nodes = [frame.target(value) for value in root.values if isinstance(value, tree.Ref)]
    yield from (node for node in nodes if node is not None)
