"""Behaviour trees as they are executed, as plain data: what each node does in one execution."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from robbdd_tools.catalog.executable import Implementation

START, END = "start", "end"
"""What a node emits when it is ticked for the first time, and when it has succeeded."""


def emitter(node: str, event: str) -> str:
    """Return what emits an event inside a node: one of the node's own, or of a behaviour at work in it."""
    return f"{node} {event}"


@dataclass(frozen=True, slots=True)
class NodeSpec:
    """A node of a behaviour tree, by its IRI, with the ``name`` that people read.

    ``kind`` is ``sequence``, ``selector`` or ``leaf``. A leaf executes ``behaviour`` (a catalog name) with
    ``arguments`` (slot to CURIE, a place also to several); where it cannot, ``problem`` says why.
    """

    iri: str
    name: str
    kind: str
    children: tuple[NodeSpec, ...] = ()
    behaviour: str = ""
    arguments: Mapping[str, str | tuple[str, ...]] = field(default_factory=dict[str, str | tuple[str, ...]])
    problem: str = ""

    def leaves(self) -> Iterator[NodeSpec]:
        """Yield the leaves from here on, in the order in which they are ticked."""
        if self.kind == "leaf":
            yield self
        for child in self.children:
            yield from child.leaves()


@dataclass(frozen=True, slots=True)
class TreeSpec:
    """One execution of a behaviour tree, which all scenarios that are linked to its nodes are judged from.

    ``name`` tells it from the other executions of a run, ``tree`` is the IRI. ``nodes`` is the root alone or, where
    Python code (``source``) makes the tree, the nodes that it is to have. ``lead`` and ``tail`` (s) are what must be
    recorded before the tree starts and after its end.
    """

    name: str
    tree: str
    nodes: tuple[NodeSpec, ...]
    lead: float
    tail: float
    source: Implementation | None = None

    def leaves(self) -> Iterator[NodeSpec]:
        """Yield the leaves in the order in which they are ticked."""
        for node in self.nodes:
            yield from node.leaves()
