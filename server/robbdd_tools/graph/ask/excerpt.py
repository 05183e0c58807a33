"""Reduce the structure of a graph to an excerpt that is small enough to read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from robbdd_tools.graph.ask.structure import Node, Structure


@dataclass(frozen=True, slots=True)
class Part:
    """An excerpt of a structure.

    ``root`` is the node from which all other nodes are reached, or ``None`` if the excerpt is the whole structure.
    """

    structure: Structure
    root: Node | None


def limited(structure: Structure, most: int, wanted: Iterable[str]) -> Part:
    """Return an excerpt of at most ``most`` nodes.

    ``wanted`` are IRIs, the most important one first. A larger structure is reduced to one story: the story that leads
    to the first existing wanted node or, without such a node, the first story. If the story is too large, it is reduced
    in the same way to one of its variants, and this to its template. If the template is too large, too, only its first
    ``most`` nodes remain.
    """
    nodes = {node.iri: node for node in structure.nodes()}
    if len(nodes) <= most:
        return Part(structure, None)
    targets: dict[str, list[str]] = {}
    for start, end, _ in structure.links:
        targets.setdefault(start, []).append(end)
    around = next((iri for iri in wanted if iri in nodes), "")
    kept, root = list(nodes), next(iter(nodes.values()))
    for layer in (structure.stories, structure.variants, structure.templates):
        within = {node.iri: _reached(node.iri, targets) for node in layer if node.iri in kept}
        leading = [iri for iri, found in within.items() if around in found] or list(within)
        if leading:
            root, kept = nodes[leading[0]], within[leading[0]]
        if len(kept) <= most:
            break
    return Part(_only(structure, set(kept[:most])), root)


def _reached(root: str, targets: Mapping[str, list[str]]) -> list[str]:
    """Return the nodes that are reachable from a node: first the node itself, then the others in text order."""
    found: dict[str, None] = {}
    waiting = [root]
    while waiting:
        iri = waiting.pop()
        if iri not in found:
            found[iri] = None
            waiting += reversed(targets.get(iri, []))
    return list(found)


def _only(structure: Structure, kept: set[str]) -> Structure:
    def those(nodes: list[Node]) -> list[Node]:
        return [node for node in nodes if node.iri in kept]

    return Structure(
        those(structure.stories),
        those(structure.variants),
        those(structure.templates),
        those(structure.clauses),
        those(structure.events),
        those(structure.tree_nodes),
        [link for link in structure.links if {link[0], link[1]} <= kept],
    )
