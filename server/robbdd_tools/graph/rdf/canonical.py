"""Canonical form of a graph, with ordered triples and deterministic labels of blank nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

    Triple = tuple[Node, Node, Node]


def sort_text(node: Node) -> tuple[str, str, str]:
    """Return the sort key of a node: its kind, its text and, for a literal, its datatype or language."""
    detail = getattr(node, "datatype", None) or getattr(node, "language", None) or ""
    return (type(node).__name__, str(node), str(detail))


def canonical(graph: Graph) -> Graph:
    """Return a copy of a graph with ordered triples and with numbered blank nodes.

    If each blank node has one incoming property, as in lists, blank nodes are numbered by the paths that lead to them,
    in linear time. Other graphs need the general algorithm of rdflib.
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
    """Number the blank nodes in the order of the paths that lead to them. Return ``None`` if a path is not unique."""
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
