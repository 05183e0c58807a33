"""The part of a structure that can still be looked at: all of it, or what the story around one node leads to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from robbdd_tools.graph.ask.structure import Node, Structure


@dataclass(frozen=True, slots=True)
class Part:
    """What is left of a structure, and the node that everything in it follows from (none: all is there)."""

    structure: Structure
    root: Node | None


def limited(structure: Structure, most: int, wanted: Iterable[str]) -> Part:
    """Return a structure of ``most`` nodes at most.

    Of a larger one that is the story that leads to the first node of ``wanted`` (IRIs) that there is, else the first
    story; of a story that is too large itself its variant, then its template, then the first ``most`` nodes of that.
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
    """Return what the links lead to from a node, itself first, in the order of the text."""
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
