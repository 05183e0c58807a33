"""The same graph in one order and with one set of blank-node labels, whatever it was made from."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

    Triple = tuple[Node, Node, Node]


def sort_text(node: Node) -> tuple[str, str, str]:
    """Return what nodes are sorted by: their kind, their text, and a literal's datatype or language."""
    detail = getattr(node, "datatype", None) or getattr(node, "language", None) or ""
    return (type(node).__name__, str(node), str(detail))


def canonical(graph: Graph) -> Graph:
    """Return a copy whose triples were added in order and whose blank nodes are numbered along the way to them.

    Graphs whose blank nodes hang on one property each, as in lists, are numbered in linear time; others go
    through the general algorithm of rdflib.
    """
    from rdflib import BNode, Graph
    from rdflib.compare import to_canonical_graph

    labels = _labels(graph)
    if labels is None:
        triples = list(to_canonical_graph(graph))
    else:
        mapping = {old: BNode(new) for old, new in labels.items()}
        triples = [(mapping.get(s, s), p, mapping.get(o, o)) for s, p, o in graph]
    ordered = Graph("SimpleMemory", bind_namespaces="none")
    for triple in sorted(triples, key=_triple_order):
        ordered.add(triple)
    return ordered


def _triple_order(triple: Triple) -> tuple[tuple[str, str, str], ...]:
    return tuple(sort_text(node) for node in triple)


def _labels(graph: Graph) -> dict[Node, str] | None:
    """Number the blank nodes by the order of the ways that lead to them; ``None`` when a way is not unique."""
    from rdflib import BNode

    edges: dict[Node, list[tuple[Node, Node]]] = {}
    blank: set[Node] = set()
    for subject, predicate, value in graph:
        blank.update(node for node in (subject, value) if isinstance(node, BNode))
        if isinstance(value, BNode):
            edges.setdefault(subject, []).append((predicate, value))
    labels: dict[Node, str] = {}
    for root in sorted((subject for subject in edges if subject not in blank), key=sort_text):
        waiting = [root]
        while waiting:
            following = sorted(edges.get(waiting.pop(), ()), key=lambda edge: sort_text(edge[0]))
            if len({predicate for predicate, _ in following}) < len(following):
                return None
            for _, value in following:
                if value in labels:
                    return None
                labels[value] = f"b{len(labels)}"
            waiting += [value for _, value in reversed(following)]
    return labels if len(labels) == len(blank) else None
