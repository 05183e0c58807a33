"""Read the graphs that models import. They state facts about declared elements, in Turtle or JSON-LD.

Such a graph adds types and properties of the user's own vocabularies. The criteria themselves are written in the models
only: a statement in the vocabulary of acceptance criteria is left out and reported.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.catalog.term_prefixes import PREFIXES
from robbdd_tools.graph.rdf.serialize import UnreadableGraph, parse
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.write.foreign import blank_owners, graph_places, node_names
from robbdd_tools.graph.write.foreign_imports import IMPORTS, import_fault, imported_file, read_import
from robbdd_tools.graph.write.node_positions import turtle_statements
from robbdd_tools.graph.write.source_map import Location

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

    from robbdd_tools.names.project import Snapshot

    Triple = tuple[Node, Node, Node]
Places = dict[tuple[str, ...], Location]
CORRECT_FOR = "rbw:correct-for"
"""The only property of our vocabulary that an imported graph may add."""
_OWN = tuple(PREFIXES[name] for name in ("bdd", "time", "task", "bhv", "bt", "env", "agn", "obs", "exec", "py", "rbw"))
_TYPE = expand("rdf:type")


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement about a node, as CURIEs: the property (``""`` for a type), its value and its place, if known."""

    property: str
    value: str
    is_name: bool
    place: Location | None


@dataclass(frozen=True, eq=False)
class ImportedGraph:
    """All graphs that a file imports, directly or not.

    - ``triples``: the statements that they add to the model.
    - ``refused``: the statements in the vocabulary of acceptance criteria, with their places.
    - ``names``: CURIEs of their nodes.
    - ``prefixes``: namespace → prefix.
    - ``faults``: the reasons why a graph cannot be read, in the graph and on the line that imports it.
    """

    documents: tuple[Document, ...] = ()
    triples: tuple[Triple, ...] = ()
    refused: tuple[tuple[Triple, Location], ...] = ()
    places: Mapping[tuple[str, ...], Location] = field(default_factory=Places)
    names: Mapping[str, str] = field(default_factory=dict[str, str])
    prefixes: Mapping[str, str] = field(default_factory=dict[str, str])
    faults: tuple[Diagnostic, ...] = ()

    @property
    def subjects(self) -> frozenset[str]:
        """The nodes about which there are statements."""
        return frozenset(str(subject) for subject, _, _ in self.triples)

    @cached_property
    def links(self) -> frozenset[tuple[str, str]]:
        """The pairs of nodes that statements link: the subject, and a value that is a name."""
        from rdflib import URIRef

        named = ((subject, value) for subject, _, value in self.triples if isinstance(value, URIRef))
        return frozenset((str(subject), str(value)) for subject, value in named)

    @cached_property
    def nodes(self) -> frozenset[str]:
        """All nodes in statements: subjects, and values that are names."""
        return self.subjects | {value for _, value in self.links}

    def values(self, term: str) -> frozenset[str]:
        """Return the nodes that are values of a property (CURIE)."""
        return frozenset(str(value) for _, predicate, value in self.triples if str(predicate) == expand(term))

    def statements(self, node: str) -> Iterator[Statement]:
        """Yield the statements about a node, sorted by property and value."""
        from rdflib import BNode, Literal

        about = [triple for triple in self.triples if str(triple[0]) == node]
        for _, predicate, value in sorted(about, key=lambda triple: (str(triple[1]), str(triple[2]))):
            is_name = not isinstance(value, Literal | BNode)
            text = self.names.get(str(value), str(value)) if is_name else str(value)
            term = "" if str(predicate) == _TYPE else self.names.get(str(predicate), str(predicate))
            place = self.places.get((node, str(predicate)))
            yield Statement(term, "{ … }" if isinstance(value, BNode) else text, is_name, place)


NOTHING = ImportedGraph()


def imported_graph(snapshot: Snapshot, uri: str) -> ImportedGraph:
    """Return the graphs that a model file imports, directly or through other models, as one."""
    lines = [
        (link.uri, Location(file.document.uri, link.span))
        for file in snapshot.closure(uri)
        for link in file.imports
        if link.problem is None and graph_format(link.uri) and snapshot.unreadable(link.uri) is None
    ]
    if not lines:
        return NOTHING
    documents, faults = _documents([snapshot.document(name) for name in dict.fromkeys(name for name, _ in lines)])
    reported = [fault for several in faults.values() for fault in several]
    for name, line in lines:
        for fault in faults.get(name, ()):
            reported.append(_on_import(line, fault))
    return _merged(documents, reported)


def graph_of(snapshot: Snapshot, uris: Iterable[str]) -> ImportedGraph:
    """Return some graph files as one graph."""
    documents, _ = _documents([snapshot.document(uri) for uri in uris])
    return _merged(documents, [])


def _on_import(line: Location, fault: Diagnostic) -> Diagnostic:
    name = fault.uri.rpartition("/")[2]
    related = (Related(fault.uri, fault.span, fault.message),)
    message = f"the statements of '{name}' are not complete: {fault.message}"
    return Diagnostic(line.uri, line.span, Severity.ERROR, "broken-import", message, related)


@dataclass(frozen=True, slots=True, eq=False)
class _Read:
    """One document: its graph, and the places of its nodes and statements."""

    graph: Graph
    places: Places
    imports: tuple[str, ...]
    fault: Diagnostic | None


def _documents(roots: Iterable[Document]) -> tuple[tuple[Document, ...], dict[str, list[Diagnostic]]]:
    """Return the root documents and all documents that they import by ``owl:imports``, and the faults of each root."""
    found: dict[str, Document] = {}
    faults: dict[str, list[Diagnostic]] = {}
    waiting = [(root.uri, root) for root in roots]
    for root, document in waiting:
        if document.uri in found:
            continue
        found[document.uri] = document
        read = _read(document)
        if read.fault is not None:
            faults.setdefault(root, []).append(read.fault)
        for name in read.imports:
            other = read_import(imported_file(document.uri, name), name)
            if isinstance(other, str):
                faults.setdefault(root, []).append(import_fault(document, name, other))
            else:
                waiting.append((root, other[0]))
    return tuple(found.values()), faults


@lru_cache(maxsize=32)
def _read(document: Document) -> _Read:
    from rdflib import Graph, URIRef

    try:
        graph = parse(document.text, graph_format(document.uri), document.uri)
    except UnreadableGraph as error:
        place = Span(error.offset, error.offset)
        fault = Diagnostic(document.uri, place, Severity.ERROR, "graph-syntax", str(error))
        return _Read(Graph(), {}, (), fault)
    imports = tuple(sorted(str(name) for name in graph.objects(None, URIRef(IMPORTS))))
    return _Read(graph, _places(document, graph), imports, None)


def _places(document: Document, graph: Graph) -> Places:
    """Return the places of a graph's nodes, properties and values. If one is unknown, the place of the node is used."""
    owners = blank_owners(graph)
    nodes = graph_places([document], graph, owners)
    namespaces = {prefix: str(namespace) for prefix, namespace in graph.namespaces()}
    is_turtle = graph_format(document.uri) == "ttl"
    exact = turtle_statements(document.text, namespaces, document.uri) if is_turtle else {}
    found: Places = {key: Location(document.uri, span) for key, span in exact.items()}
    for subject, predicate, _ in graph:
        place = nodes.node(str(subject))
        if place is not None:
            found.setdefault((str(subject), str(predicate)), place)
            found.setdefault((str(subject),), place)
    return found


def _merged(documents: Sequence[Document], faults: list[Diagnostic]) -> ImportedGraph:
    from rdflib import BNode

    triples: list[Triple] = []
    refused: list[tuple[Triple, Location]] = []
    places: Places = {}
    names: dict[str, str] = {}
    prefixes: dict[str, str] = {}
    for number, document in enumerate(documents):
        read = _read(document)

        def own(node: Node, number: int = number) -> Node:
            return BNode(f"i{number}-{node}") if isinstance(node, BNode) else node

        for subject, predicate, value in read.graph:
            triple = (own(subject), own(predicate), own(value))
            if _is_refused(predicate, value):
                key = (str(subject), str(predicate))
                place = read.places.get((*key, str(value))) or read.places.get(key)
                refused.append((triple, place or Location(document.uri, Span(0, 0))))
            elif str(predicate) != IMPORTS:
                triples.append(triple)
        for (subject, *rest), place in read.places.items():
            places.setdefault((subject, *rest), place)
        names = {**node_names(read.graph), **names}
        for prefix, namespace in read.graph.namespaces():
            if prefix:
                prefixes.setdefault(str(namespace), prefix)
    ordered = sorted(refused, key=lambda entry: (entry[1], *map(str, entry[0])))
    return ImportedGraph(tuple(documents), tuple(triples), tuple(ordered), places, names, prefixes, tuple(faults))


def _is_refused(predicate: Node, value: Node) -> bool:
    """Return whether a statement uses a term of the acceptance criteria, so that only models may make it."""
    term = str(value) if str(predicate) == _TYPE else str(predicate)
    return any(_is_in(term, namespace) for namespace in _OWN) and term != expand(CORRECT_FOR)


def _is_in(term: str, namespace: str) -> bool:
    local = term.removeprefix(namespace)
    return local != term and "/" not in local and "#" not in local
