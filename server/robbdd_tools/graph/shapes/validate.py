"""SHACL over a built graph; what it finds comes back onto the text that causes it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.graph.rdf.libraries import UnusableShapes, shacl_report
from robbdd_tools.graph.shapes.derive import derive
from robbdd_tools.graph.shapes.findings import FindingWriter, clash_finding, merged, results
from robbdd_tools.graph.shapes.installed import load_shapes
from robbdd_tools.graph.shapes.project_shapes import ProjectShapes, ShapeFile, broken, unchecked
from robbdd_tools.graph.write.built import BuiltGraph

if TYPE_CHECKING:
    from rdflib import Graph

NO_SHAPES = ProjectShapes()


def validate(built: BuiltGraph, shapes: Graph | None = None, project: ProjectShapes = NO_SHAPES) -> list[Diagnostic]:
    """Return what SHACL finds in a graph, at the tokens that cause it, in the order of the text.

    Declarations in doubt (see ``BuiltGraph``) are passed over: their error is known already. ``shapes`` replaces
    the bundled ones; those of a ``project`` come on top.
    """
    derived = derive(built.graph)
    report = shacl_report(derived.graph, load_shapes() if shapes is None else shapes)
    writer = FindingWriter(built, derived)
    found = [diagnostic for result in results(report) for diagnostic in writer.diagnostics(result)]
    found += project_findings(writer, project)
    found += [clash_finding(built, clash) for clash in built.clashes]
    found += _faults(built, found)
    return merged(found)


def project_findings(writer: FindingWriter, project: ProjectShapes) -> Iterator[Diagnostic]:
    """Yield what the shapes of a project find, all usable files together, and what is wrong with the others."""
    faults = [*project.faults, *(fault for file in project.files for fault in file.faults)]
    usable = [file for file in project.files if not file.faults]
    while usable:
        try:
            for result in results(shacl_report(writer.derived.graph, together(usable))):
                yield from writer.diagnostics(result, usable)
            break
        except UnusableShapes as error:
            culprits = _culprits(writer, usable) or [broken(usable[0], error)]
            faults += culprits
            usable = [file for file in usable if file.uri not in {fault.uri for fault in culprits}]
    yield from unchecked(writer.built.uri, tuple(faults))
    yield from project.remarks


def together(files: Iterable[ShapeFile]) -> Graph:
    """Return the shapes of several files as one graph."""
    from rdflib import Graph

    shapes = Graph(bind_namespaces="none")
    for file in files:
        for triple in file.graph:
            shapes.add(triple)
    return shapes


def _culprits(writer: FindingWriter, files: list[ShapeFile]) -> list[Diagnostic]:
    """Return the files that cannot even be used alone."""
    found: list[Diagnostic] = []
    for file in files:
        try:
            shacl_report(writer.derived.graph, file.graph)
        except UnusableShapes as error:
            found.append(broken(file, error))
    return found


def _faults(built: BuiltGraph, found: list[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield what is wrong with a graph file; a variant that is left out is not reported beside its cause."""
    has_error = any(diagnostic.severity is Severity.ERROR for diagnostic in found)
    return (fault for fault in built.faults if not (has_error and fault.code == "incomplete-variant"))
