"""Excerpt of a structure that is small enough to read: all of it, or the story around one node."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from robbdd_tools.graph.ask.structure import Node, Structure


@dataclass(frozen=True, slots=True)
class Part:
    """An excerpt, and the node that all others are reached from (``None``: the excerpt is complete)."""

    structure: Structure
    root: Node | None


def limited(structure: Structure, most: int, wanted: Iterable[str]) -> Part:
    """Return a structure of at most ``most`` nodes.

    A larger one is reduced to the story that leads to the first existing node of ``wanted`` (IRIs), or else to the
    first story; a story that is too large, to its variant, then its template, then the first ``most`` nodes of that.
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
    """Return the nodes reachable from a node, itself first, in text order."""
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
