"""Behaviour trees to execute, as plain data: the work of each node in one execution."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from robbdd_tools.catalog.executable import Implementation

START, END = "start", "end"
"""Events that a node emits at its first tick, and on success."""

EXTERNAL = "external"
"""Emitter of an event of the environment, such as an operator's action. Not simulated; a log may report it."""

DEFINED = "defined"
"""Emitter of an event that a template defines by conditions. It is found in the trace."""


_SEVERAL = " | "
"""Separator of the emitters of one event; an IRI contains no space."""


def emitter(node: str, event: str) -> str:
    """Return the emitter of an event inside a node, which is the node itself or the behaviour that it executes.

    In a template with several behaviours, ``node`` is the IRI of the clause of one of them.
    """
    return f"{node} {event}"


def joined(emitters: Iterable[str]) -> str:
    """Return several emitters of one event as one text; the behaviours of several loops may have the same event."""
    return _SEVERAL.join(dict.fromkeys(emitters))


def each_emitter(emitters: str) -> tuple[str, ...]:
    """Return the emitters in a text of ``joined``."""
    return tuple(emitters.split(_SEVERAL))


@dataclass(frozen=True, slots=True)
class NodeSpec:
    """A node of a behaviour tree, by its IRI, with a readable ``name``.

    - ``kind``: ``sequence``, ``selector`` or ``leaf``.
    - ``behaviour``: the catalog name of the behaviour that a leaf executes.
    - ``arguments``: maps each slot of that behaviour to a CURIE, or to several CURIEs for a place.
    - ``problem``: the reason if the leaf cannot execute the behaviour.
    """

    iri: str
    name: str
    kind: str
    children: tuple[NodeSpec, ...] = ()
    behaviour: str = ""
    arguments: Mapping[str, str | tuple[str, ...]] = field(default_factory=dict[str, str | tuple[str, ...]])
    problem: str = ""

    def leaves(self) -> Iterator[NodeSpec]:
        """Yield the leaves below this node in tick order."""
        if self.kind == "leaf":
            yield self
        for child in self.children:
            yield from child.leaves()


@dataclass(frozen=True, slots=True)
class TreeSpec:
    """One execution of a behaviour tree. All scenarios that are linked to its nodes are judged from it.

    - ``name``: identifies the execution within a run.
    - ``tree``: the IRI of the tree.
    - ``nodes``: only the root or, if Python code (``source``) creates the tree, the expected nodes.
    - ``lead`` and ``tail``: the time (s) to record before the tree starts and after it ends.
    """

    name: str
    tree: str
    nodes: tuple[NodeSpec, ...]
    lead: float
    tail: float
    source: Implementation | None = None

    def leaves(self) -> Iterator[NodeSpec]:
        """Yield the leaves in tick order."""
        for node in self.nodes:
            yield from node.leaves()
