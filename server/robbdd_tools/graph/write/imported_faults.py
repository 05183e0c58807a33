"""Findings on imported graphs: syntax, statements that only models make, and subjects that no model declares."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.names.suggest import similar
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from rdflib import Graph

    from robbdd_tools.graph.write.imported_graphs import ImportedGraph
    from robbdd_tools.names.project import Snapshot

CODE = "imported-statement"


def imported_faults(snapshot: Snapshot, uri: str, imported: ImportedGraph, graph: Graph) -> Iterator[Diagnostic]:
    """Yield the findings on the graphs that a file imports. ``graph`` is the file's graph with these statements."""
    if not imported.documents:
        return
    yield from imported.faults
    for triple, place in imported.refused:
        # A graph may repeat statements of the models, for example because it was made from them.
        if triple not in graph:
            subject, predicate, value = (imported.names.get(str(node), str(node)) for node in triple)
            is_type = predicate in ("rdf:type", "http://www.w3.org/1999/02/22-rdf-syntax-ns#type")
            said = f"the type '{value}'" if is_type else f"'{predicate}'"
            message = f"{said} of '{subject}' cannot be added by an import: write it in the model"
            yield Diagnostic(place.uri, place.span, Severity.ERROR, CODE, message)
    yield from _undeclared(snapshot, uri, imported)


def _undeclared(snapshot: Snapshot, uri: str, imported: ImportedGraph) -> Iterator[Diagnostic]:
    """Yield a warning for each undeclared subject whose name is similar to a declared name in the same namespace."""
    declared: dict[str, set[str]] = {}
    known: set[str] = set()
    for file in snapshot.closure(uri):
        for placed in file.declarations:
            if isinstance(placed.declaration.tree, tree.Namespace):
                declared.setdefault(placed.declaration.tree.iri.value, set())
    for file in snapshot.closure(uri):
        for definition in file.definitions.values():
            known.add(definition.iri or "")
            name = definition.symbol.name
            namespace = (definition.iri or "").removesuffix(name)
            if namespace in declared:
                declared[namespace].add(name)
    for (node, *rest), place in imported.places.items():
        namespace = max((start for start in declared if node.startswith(start)), key=len, default=None)
        if rest or namespace is None or node in known:
            continue
        name = node.removeprefix(namespace)
        near = similar(name, sorted(declared[namespace]))
        text = snapshot.document(place.uri).text[place.span.start : place.span.end]
        if near:
            message = f"no model declares '{name}', so its statements are not used; did you mean '{near[0]}'?"
            ends = text.removesuffix(">").endswith(name)
            start = place.span.start + text.rfind(name)
            span = type(place.span)(start, start + len(name)) if ends else place.span
            fixes = tuple(Fix(f"Change to '{one}'", (Edit(place.uri, span, one),)) for one in near) if ends else ()
            yield Diagnostic(place.uri, span, Severity.WARNING, CODE, message, fixes=fixes)
