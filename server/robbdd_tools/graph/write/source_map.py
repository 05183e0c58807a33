"""Source positions of the nodes and statements of a graph."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from robbdd_tools.base.document import Span
from robbdd_tools.graph.rdf.vocabulary import expand


@dataclass(frozen=True, slots=True, order=True)
class Location:
    """An absolute range of a document."""

    uri: str
    span: Span


@dataclass(frozen=True, slots=True)
class SourceMap:
    """Positions of nodes, properties and values of a graph.

    Nodes are given by their IRI or by the label of a blank node, properties by CURIE or IRI. A statement that was
    written several times has several positions, for example a value in several rows.
    """

    places: Mapping[tuple[str, ...], tuple[Location, ...]]

    def node(self, node: str) -> Location | None:
        """Return the position of a node's declaration, which is its name or, without a name, its first token."""
        return next(iter(self.places.get((node,), ())), None)

    def property(self, node: str, term: str) -> Location | None:
        """Return the first position of a property of a node."""
        return next(iter(self.places.get((node, expand(term)), ())), None)

    def value(self, node: str, term: str, value: str) -> tuple[Location, ...]:
        """Return all positions of one value of a node's property."""
        return self.places.get((node, expand(term), value), ())


@dataclass(slots=True)
class SourceMapBuilder:
    """Collects positions while a graph is built."""

    _places: dict[tuple[str, ...], dict[Location, None]] = field(
        default_factory=dict[tuple[str, ...], dict[Location, None]]
    )

    def mark(self, keys: Iterable[tuple[str, ...]], location: Location) -> None:
        """Record a position for all given keys."""
        for key in keys:
            self._places.setdefault(key, {})[location] = None

    def build(self) -> SourceMap:
        """Return the finished map."""
        return SourceMap({key: tuple(places) for key, places in self._places.items()})
