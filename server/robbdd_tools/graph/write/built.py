"""What is known of a graph besides its triples: where they come from and what is in doubt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rdflib import Graph

    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.graph.write.declarations import Key
    from robbdd_tools.graph.write.source_map import Location, SourceMap


@dataclass(frozen=True, slots=True)
class Clash:
    """Two declarations whose names make one IRI: the later one, which the graph leaves out, and the first."""

    iri: str
    location: Location
    first: Location


@dataclass(frozen=True, slots=True)
class BuiltGraph:
    """A graph with what is known of its origin.

    ``names`` gives the qualified name that stands in the text for an IRI (a CURIE for a graph that was read);
    ``doubtful`` the extents of declarations that already have an error or build on one that has;
    ``doubtful_nodes`` what these declare. ``faults`` are what kept a graph file from being read;
    ``is_read`` tells that it is one, whose findings have to name their node. ``authors`` are the declarations (document
    and offset) that a node is described by.
    """

    uri: str
    graph: Graph
    sources: SourceMap
    names: Mapping[str, str]
    clashes: tuple[Clash, ...]
    doubtful: tuple[Location, ...]
    doubtful_nodes: frozenset[str]
    faults: tuple[Diagnostic, ...] = ()
    is_read: bool = False
    authors: Mapping[str, Mapping[Key, None]] = field(default_factory=dict[str, Mapping["Key", None]])
