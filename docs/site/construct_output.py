"""The Gherkin and the graph that the workbench makes of an example of the reference."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from construct_examples import Example
from rdflib import BNode, Graph, URIRef

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.gherkin.preview import Preview, preview
from robbdd_tools.graph.rdf.prefixes import user_prefixes
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.graph.write.built import BuiltGraph
from robbdd_tools.graph.write.source_map import Location
from robbdd_tools.names.project import Project, Snapshot

MOST_STEPS = 6
MOST_LINES = 16
"""Lines of Turtle from which on further nodes are left out."""


@cache
def _snapshot(path: Path) -> Snapshot:
    project = Project()
    project.load(path_to_uri(path))
    return project.snapshot()


@cache
def _preview(path: Path) -> Preview:
    return preview(_snapshot(path), path_to_uri(path))


@cache
def _built(path: Path) -> BuiltGraph:
    return build_graph(_snapshot(path), path_to_uri(path))


def gherkin(example: Example) -> str:
    """Return the lines of Gherkin that an example leads to, each once; of a story, the beginning of its feature."""
    if example.path.suffix != ".bdd":
        return ""
    found = _preview(example.path)
    lines = found.text.splitlines()
    if example.text.startswith("User Story"):
        return "\n".join([*lines[: MOST_STEPS + 4], "  # …"])
    uri = path_to_uri(example.path)
    placed = [(one.line, one.location.span) for one in found.lines if one.location.uri == uri]
    inside = {span: line for line, span in reversed(placed) if _within(span, example.span)}
    around = {span: line for line, span in reversed(placed) if _within(example.span, span)}
    smallest = min((span.end - span.start for span in around), default=0)
    chosen = inside or {span: line for span, line in around.items() if span.end - span.start == smallest}
    shown = sorted(chosen.values())
    return "\n".join([*(lines[line].strip() for line in shown[:MOST_STEPS]), *(["# …"] if shown[MOST_STEPS:] else [])])


def _within(inner: Span, outer: Span) -> bool:
    return outer.start <= inner.start and inner.end <= outer.end


def turtle(example: Example) -> str:
    """Return the statements about the nodes of an example, or those that it adds to other nodes."""
    built, uri = _built(example.path), path_to_uri(example.path)

    def inside(location: Location | None) -> bool:
        return location is not None and location.uri == uri and _within(location.span, example.span)

    nodes = {key[0]: built.sources.node(key[0]) for key in built.sources.places if inside(built.sources.node(key[0]))}
    ordered = sorted(nodes, key=lambda node: (nodes[node], node))
    text, whole = "", Graph(bind_namespaces="none")
    for name, namespace in user_prefixes(built.graph).items():
        whole.bind(name, URIRef(namespace))
    for number, node in enumerate(ordered):
        if number and text.count("\n") >= MOST_LINES:
            return f"{text}\n# …"
        for triple in _about(built.graph, [node]):
            whole.add(triple)
        text = _shown(whole)
    if not text:
        for triple in built.graph:
            places = built.sources.value(str(triple[0]), str(triple[1]), str(triple[2]))
            if any(map(inside, places)):
                whole.add(triple)
                for more in _about(built.graph, [str(triple[2])] if isinstance(triple[2], BNode) else []):
                    whole.add(more)
        text = _shown(whole)
    return text


def _about(graph: Graph, nodes: Iterable[str]) -> Iterator[tuple[URIRef | BNode, URIRef, URIRef | BNode]]:
    """Yield the statements about nodes, and those about the blank nodes in them."""
    waiting = list(nodes)
    seen = set(waiting)
    while waiting:
        name = waiting.pop(0)
        for subject in (URIRef(name), BNode(name)):
            for triple in graph.triples((subject, None, None)):
                yield triple  # type: ignore[misc]
                if isinstance(triple[2], BNode) and str(triple[2]) not in seen:
                    seen.add(str(triple[2]))
                    waiting.append(str(triple[2]))


def _shown(graph: Graph) -> str:
    lines = serialize(graph, "ttl").splitlines() if len(graph) else []
    return "\n".join(line for line in lines if not line.startswith("@prefix")).strip()
