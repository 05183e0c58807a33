"""SHACL over a built graph; what it finds comes back onto the text that causes it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity, sort_key
from robbdd_tools.base.document import Span
from robbdd_tools.graph.built import BuiltGraph, Clash
from robbdd_tools.graph.derive import derive
from robbdd_tools.graph.derived import Derived
from robbdd_tools.graph.libraries import UnusableShapes, shacl_report
from robbdd_tools.graph.shapes import load_shapes
from robbdd_tools.graph.source_map import Location
from robbdd_tools.graph.user_shapes import ProjectShapes, ShapeFile, broken, unchecked
from robbdd_tools.graph.vocabulary import SHAPES, expand

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

NO_SHAPES = ProjectShapes()
_SH = "http://www.w3.org/ns/shacl#"
_SEVERITIES = {
    f"{_SH}Violation": Severity.ERROR,
    f"{_SH}Warning": Severity.WARNING,
    f"{_SH}Info": Severity.INFORMATION,
}
_PLACEHOLDER = re.compile(r"\{([\w-]+)\}")


def validate(built: BuiltGraph, shapes: Graph | None = None, project: ProjectShapes = NO_SHAPES) -> list[Diagnostic]:
    """Return what SHACL finds in a graph, at the tokens that cause it, in the order of the text.

    Declarations in doubt (see ``BuiltGraph``) are passed over: their error is known already. ``shapes`` replaces
    the bundled ones; those of a ``project`` come on top.
    """
    derived = derive(built.graph)
    report = shacl_report(derived.graph, load_shapes() if shapes is None else shapes)
    writer = _Writer(built, derived)
    found = [diagnostic for result in _results(report) for diagnostic in writer.diagnostics(result)]
    found += _project_findings(writer, project)
    found += [_clash(built, clash) for clash in built.clashes]
    found += _faults(built, found)
    merged: dict[tuple[str, Span, str], Diagnostic] = {}
    for diagnostic in sorted(found, key=sort_key):
        merged.setdefault((diagnostic.uri, diagnostic.span, diagnostic.message), diagnostic)
    return list(merged.values())


def _project_findings(writer: _Writer, project: ProjectShapes) -> Iterator[Diagnostic]:
    """Yield what the shapes of a project find, all usable files together, and what is wrong with the others."""
    faults = [*project.faults, *(fault for file in project.files for fault in file.faults)]
    usable = [file for file in project.files if not file.faults]
    while usable:
        try:
            for result in _results(shacl_report(writer.derived.graph, _together(usable))):
                yield from writer.diagnostics(result, usable)
            break
        except UnusableShapes as error:
            culprits = _culprits(writer, usable) or [broken(usable[0], error)]
            faults += culprits
            usable = [file for file in usable if file.uri not in {fault.uri for fault in culprits}]
    yield from unchecked(writer.built.uri, tuple(faults))


def _together(files: Iterable[ShapeFile]) -> Graph:
    from rdflib import Graph

    shapes = Graph(bind_namespaces="none")
    for file in files:
        for triple in file.graph:
            shapes.add(triple)
    return shapes


def _culprits(writer: _Writer, files: list[ShapeFile]) -> list[Diagnostic]:
    """Return the files that cannot even be used alone."""
    found: list[Diagnostic] = []
    for file in files:
        try:
            shacl_report(writer.derived.graph, file.graph)
        except UnusableShapes as error:
            found.append(broken(file, error))
    return found


@dataclass(frozen=True, slots=True)
class _Result:
    focus: Node
    path: str
    value: Node | None
    shape: str
    severity: str
    message: str


def _results(report: Graph) -> Iterator[_Result]:
    from rdflib.namespace import RDF, SH

    for node in report.subjects(RDF.type, SH.ValidationResult):
        focus, shape = report.value(node, SH.focusNode), report.value(node, SH.sourceShape)
        if focus is not None:
            yield _Result(
                focus,
                str(report.value(node, SH.resultPath) or ""),
                report.value(node, SH.value),
                str(shape),
                str(report.value(node, SH.resultSeverity)),
                str(report.value(node, SH.resultMessage) or ""),
            )


@dataclass(frozen=True, slots=True)
class _Writer:
    built: BuiltGraph
    derived: Derived

    def diagnostics(self, result: _Result, files: Iterable[ShapeFile] = ()) -> Iterator[Diagnostic]:
        """Yield one diagnostic for each place where the cause of a result is written.

        ``files`` are those that the shape may stand in when it is none of ours.
        """
        if str(result.focus) in self.built.doubtful_nodes or str(result.value) in self.built.doubtful_nodes:
            return
        message = self._message(result)
        source = next(((file, place) for file in files if (place := file.place(result.shape))), None)
        if source is None:
            code = f"shacl-{result.shape.removeprefix(SHAPES)}"
            shape = ()
        else:
            code = f"shape-{source[0].name.removesuffix('.ttl')}"
            shape = (Related(source[1].uri, source[1].span, "the shape that asks for this"),)
        for location in self._locations(result):
            if not self._is_doubtful(location):
                related = (*self._related(result, location), *shape)
                severity = _SEVERITIES.get(result.severity, Severity.ERROR)
                yield Diagnostic(location.uri, location.span, severity, code, message, related)

    def _locations(self, result: _Result) -> tuple[Location, ...]:
        """Return the most exact places known: of the value, else of the property, else of the node."""
        places = self.built.sources.places
        for key in self._keys(result):
            if key in places:
                return places[key] if len(key) == 3 else places[key][:1]
        return (Location(self.built.uri, Span(0, 0)),)

    def _keys(self, result: _Result) -> Iterator[tuple[str, ...]]:
        focus, value = str(result.focus), str(result.value)
        anchors = self.derived.anchors
        yield from anchors.get((focus, value), ())
        yield from anchors.get((focus, ""), ())
        yield (focus, result.path, value)
        yield (focus, result.path)
        yield (focus,)
        for subject, predicate in sorted(self.derived.graph.subject_predicates(result.focus)):
            yield (str(subject), str(predicate), focus)
            yield (str(subject), str(predicate))
            yield (str(subject),)

    def _is_doubtful(self, location: Location) -> bool:
        return any(
            location.uri == extent.uri and extent.span.start <= location.span.start < extent.span.end
            for extent in self.built.doubtful
        )

    def _related(self, result: _Result, location: Location) -> Iterator[Related]:
        """Point from a wrong value to its declaration, and from an assignment to its variable's."""
        variable = next(iter(self._derived(result.focus, "variable")), None)
        for node in (result.value, variable):
            declared = None if node is None else self.built.sources.node(str(node))
            if declared is not None and declared != location and str(node) in self.built.names:
                yield Related(declared.uri, declared.span, f"'{self._name(node)}' is declared here")

    def _message(self, result: _Result) -> str:
        def fill(match: re.Match[str]) -> str:
            name = match[1]
            if name == "value":
                return "nothing" if result.value is None else self._name(result.value)
            if name == "focus":
                return self._name(result.focus)
            values = self._derived(result.focus, name)
            return self._name(values[0]) if values else match[0]

        message = _PLACEHOLDER.sub(fill, result.message)
        return f"'{self._subject(result.focus)}': {message}" if self.built.is_read else message

    def _subject(self, focus: Node) -> str:
        """Return the name of what a finding is about; a derived node is called after what it was derived from."""
        names = self.built.names
        anchors = self.derived.anchors.get((str(focus), ""), [])
        roots = (str(focus), *(key[0] for key in anchors))
        return next((names[node] for node in roots if node in names), str(focus))

    def _derived(self, node: Node, name: str) -> list[Node]:
        from rdflib import URIRef

        return sorted(self.derived.graph.objects(node, URIRef(expand(f"rbw:{name}"))), key=str)

    def _name(self, node: Node | None) -> str:
        return self.built.names.get(str(node), str(node))


def _faults(built: BuiltGraph, found: list[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield what is wrong with a graph file; that a variant is left out goes without saying where the cause is told."""
    has_error = any(diagnostic.severity is Severity.ERROR for diagnostic in found)
    return (fault for fault in built.faults if not (has_error and fault.code == "incomplete-variant"))


def _clash(built: BuiltGraph, clash: Clash) -> Diagnostic:
    name = built.names.get(clash.iri, clash.iri).rpartition(".")[2]
    message = (
        f"'{name}' already stands for something else in this namespace (both are <{clash.iri}>): "
        "give one of the two another name or namespace"
    )
    related = (Related(clash.first.uri, clash.first.span, "the first declaration"),)
    return Diagnostic(clash.location.uri, clash.location.span, Severity.ERROR, "duplicate-iri", message, related)
