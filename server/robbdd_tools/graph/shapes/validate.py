"""Run SHACL on a graph and map violations to source ranges."""

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
    """Return the SHACL diagnostics of a graph in text order. Each one is placed at the tokens that cause it.

    Unreliable declarations (see ``BuiltGraph``) are skipped, because their errors are already reported. ``shapes``
    replaces the built-in shapes, and the shapes of a ``project`` are added.
    """
    derived = derive(built.graph, built.records)
    report = shacl_report(derived.graph, load_shapes() if shapes is None else shapes)
    writer = FindingWriter(built, derived)
    found = [diagnostic for result in results(report) for diagnostic in writer.diagnostics(result)]
    found += project_findings(writer, project)
    found += [clash_finding(built, clash) for clash in built.clashes]
    found += _faults(built, found)
    return merged(found)


def project_findings(writer: FindingWriter, project: ProjectShapes) -> Iterator[Diagnostic]:
    """Validate all usable shape files of a project together, and yield the findings.

    For each unusable file, its faults are yielded instead.
    """
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
    """Return the faults of files that cannot be used even alone."""
    found: list[Diagnostic] = []
    for file in files:
        try:
            shacl_report(writer.derived.graph, file.graph)
        except UnusableShapes as error:
            found.append(broken(file, error))
    return found


def _faults(built: BuiltGraph, found: list[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the faults of a graph file.

    If ``found`` contains an error, an omitted variant is not reported, because the error is the cause of the omission.
    """
    has_error = any(diagnostic.severity is Severity.ERROR for diagnostic in found)
    return (fault for fault in built.faults if not (has_error and fault.code == "incomplete-variant"))
