"""Merge a foreign graph with the graphs that it imports (``owl:imports``) from local files."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import Unreadable, path_to_uri, read_text, uri_to_path
from robbdd_tools.base.graph_formats import GRAPH_FORMATS, graph_format
from robbdd_tools.graph.rdf.contexts import file_for
from robbdd_tools.graph.rdf.serialize import UnreadableGraph, parse

if TYPE_CHECKING:
    from pathlib import Path

    from rdflib import Graph
    from rdflib.term import Node

IMPORTS = "http://www.w3.org/2002/07/owl#imports"


@dataclass(slots=True)
class Merged:
    """A graph merged with the graphs that it imports, the documents of these graphs, and the faults of the imports."""

    graph: Graph
    documents: list[Document]
    faults: list[Diagnostic] = field(default_factory=list[Diagnostic])

    def add(self, document: Document, graph: Graph) -> list[tuple[Document, str]]:
        """Add the graph of a document. Return the document together with each of its imports.

        Blank nodes get new labels for each document, because several documents may use the same labels.
        """
        from rdflib import BNode, URIRef

        self.documents.append(document)
        for prefix, namespace in graph.namespaces():
            self.graph.bind(prefix, namespace, override=False)
        number = len(self.documents)

        def own(node: Node) -> Node:
            return BNode(f"{node}-{number}") if isinstance(node, BNode) else node

        for subject, predicate, value in graph:
            self.graph.add((own(subject), predicate, own(value)))
        return [(document, str(name)) for name in sorted(graph.objects(None, URIRef(IMPORTS)), key=str)]


def merge_imports(document: Document, others: Iterable[Document] = ()) -> Merged:
    """Return the graph of a document merged with all its imports, direct or indirect. Raises ``UnreadableGraph``.

    An import is the relative path of a file, or a web address that ends with the path of a file in the folder of the
    importing document. Nothing is fetched. The graphs of ``others`` are added as if ``document`` imported them.
    """
    from rdflib import URIRef

    merged = Merged(parse(document.text, graph_format(document.uri), document.uri), [document])
    imported = sorted(str(name) for name in merged.graph.objects(None, URIRef(IMPORTS)))
    waiting = [(document, name) for name in imported]
    seen = {document.uri}
    for other in others:
        seen.add(other.uri)
        try:
            graph = parse(other.text, graph_format(other.uri), other.uri)
        except UnreadableGraph as error:
            place = Span(error.offset, error.offset)
            merged.faults.append(Diagnostic(other.uri, place, Severity.ERROR, "graph-syntax", str(error)))
        else:
            waiting += merged.add(other, graph)
    for importer, name in waiting:
        path = imported_file(importer.uri, name)
        uri = name if path is None else path_to_uri(path)
        if uri in seen:
            continue
        seen.add(uri)
        found = read_import(path, name)
        if isinstance(found, str):
            merged.faults.append(import_fault(importer, name, found))
            continue
        other, graph = found
        waiting += merged.add(other, graph)
    return merged


def imported_file(importer: str, name: str) -> Path | None:
    """Return the file that an import names; ``None`` for an address without a file in the importer's folder."""
    path, own = uri_to_path(name), uri_to_path(importer)
    if path is not None or own is None:
        return path
    return file_for(name, own.parent)


def read_import(path: Path | None, name: str) -> tuple[Document, Graph] | str:
    """Return the document and the graph of an imported file, or the fault of the import."""
    if path is None:
        return f"'{name}' is not fetched: put the file next to this one, under the name that its address ends with"
    uri = path_to_uri(path)
    if not graph_format(uri):
        return f"'{path.name}' is not a graph: import a file that ends in .{', .'.join(GRAPH_FORMATS)}"
    text = read_text(path)
    if isinstance(text, Unreadable):
        return text.reason
    try:
        return Document(uri, 0, text), parse(text, graph_format(uri), uri)
    except UnreadableGraph as error:
        return f"'{path.name}' cannot be read: {error}"


def import_fault(importer: Document, name: str, message: str) -> Diagnostic:
    """Return the diagnostic of an import, at its place in the importing document."""
    written = name.rpartition("/")[2]
    start = max(importer.text.find(written), 0)
    span = Span(start, start + len(written) if start else 0)
    return Diagnostic(importer.uri, span, Severity.ERROR, "import", message)
