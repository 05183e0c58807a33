"""A graph with its metadata: source positions, and the declarations that are unreliable because of errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rdflib import Graph

    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.graph.rdf.records import Records
    from robbdd_tools.graph.write.declarations import Key
    from robbdd_tools.graph.write.source_map import Location, SourceMap


@dataclass(frozen=True, slots=True)
class Clash:
    """Two declarations with the same IRI: the later one, which is not in the graph, and the first one."""

    iri: str
    location: Location
    first: Location


@dataclass(frozen=True, slots=True)
class BuiltGraph:
    """A graph with its metadata.

    - ``names``: maps an IRI to its qualified name in the text, or to a CURIE if the graph was parsed.
    - ``clashes``: pairs of declarations with the same IRI.
    - ``unreliable_declarations``: the extents of declarations that have an error or use a declaration with an error.
    - ``doubtful_nodes``: the nodes of these declarations.
    - ``faults``: the reasons why a graph file could not be read.
    - ``is_read``: true for a graph file. Its findings have to name their node.
    - ``authors``: the declarations (document and offset) that describe each node.
    - ``records``: read access to a parsed graph.
    """

    uri: str
    graph: Graph
    sources: SourceMap
    names: Mapping[str, str]
    clashes: tuple[Clash, ...]
    unreliable_declarations: tuple[Location, ...]
    doubtful_nodes: frozenset[str]
    faults: tuple[Diagnostic, ...] = ()
    is_read: bool = False
    authors: Mapping[str, Mapping[Key, None]] = field(default_factory=dict[str, Mapping["Key", None]])
    records: Records | None = None
