"""Where in the text each node and each statement of a graph was written."""

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
    """Answers for nodes (IRIs, or the labels of blank nodes), properties (CURIEs or IRIs) and values.

    A statement that was written several times, such as a value in several rows, has several places.
    """

    places: Mapping[tuple[str, ...], tuple[Location, ...]]

    def node(self, node: str) -> Location | None:
        """Return where a node is declared: its name, or its first token if it has none."""
        return next(iter(self.places.get((node,), ())), None)

    def property(self, node: str, term: str) -> Location | None:
        """Return where a property of a node was first written."""
        return next(iter(self.places.get((node, expand(term)), ())), None)

    def value(self, node: str, term: str, value: str) -> tuple[Location, ...]:
        """Return every place where a value of a property of a node was written."""
        return self.places.get((node, expand(term), value), ())


@dataclass(slots=True)
class SourceMapBuilder:
    """Collects places while a graph is built."""

    _places: dict[tuple[str, ...], dict[Location, None]] = field(
        default_factory=dict[tuple[str, ...], dict[Location, None]]
    )

    def mark(self, keys: Iterable[tuple[str, ...]], location: Location) -> None:
        """Note one place for several keys."""
        for key in keys:
            self._places.setdefault(key, {})[location] = None

    def build(self) -> SourceMap:
        """Return the finished map."""
        return SourceMap({key: tuple(places) for key, places in self._places.items()})
