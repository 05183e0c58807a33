"""Map SHACL results to diagnostics on the text that causes them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity, sort_key
from robbdd_tools.base.document import Span
from robbdd_tools.graph.rdf.vocabulary import SHAPES, expand
from robbdd_tools.graph.write.source_map import Location

if TYPE_CHECKING:
    from rdflib import Graph
    from rdflib.term import Node

    from robbdd_tools.graph.shapes.derived import Derived
    from robbdd_tools.graph.shapes.project_shapes import ShapeFile
    from robbdd_tools.graph.write.built import BuiltGraph, Clash
    from robbdd_tools.graph.write.declarations import Key

_SH = "http://www.w3.org/ns/shacl#"
_SEVERITIES = {
    f"{_SH}Violation": Severity.ERROR,
    f"{_SH}Warning": Severity.WARNING,
    f"{_SH}Info": Severity.INFORMATION,
}
_PLACEHOLDER = re.compile(r"\{([\w-]+)\}")


@dataclass(frozen=True, slots=True)
class Result:
    """One entry of a validation report."""

    focus: Node
    path: str
    value: Node | None
    shape: str
    severity: str
    message: str


def results(report: Graph) -> Iterator[Result]:
    """Yield the entries of a validation report."""
    from rdflib.namespace import RDF, SH

    for node in report.subjects(RDF.type, SH.ValidationResult):
        focus, shape = report.value(node, SH.focusNode), report.value(node, SH.sourceShape)
        if focus is not None:
            yield Result(
                focus,
                str(report.value(node, SH.resultPath) or ""),
                report.value(node, SH.value),
                str(shape),
                str(report.value(node, SH.resultSeverity)),
                str(report.value(node, SH.resultMessage) or ""),
            )


@dataclass(frozen=True, slots=True)
class FindingWriter:
    """Converts SHACL results on a graph to diagnostics at its source text."""

    built: BuiltGraph
    derived: Derived

    def diagnostics(self, result: Result, files: Iterable[ShapeFile] = ()) -> Iterator[Diagnostic]:
        """Yield a diagnostic for each place in the source text that causes a result.

        ``files`` are the shape files of the project. They are searched for the shape if it is not a built-in one.
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
            shape = (Related(source[1].uri, source[1].span, "the shape that requires this"),)
        for location in self._locations(result):
            if not self._is_doubtful(location):
                related = (*self._related(result, location), *shape)
                severity = _SEVERITIES.get(result.severity, Severity.ERROR)
                yield Diagnostic(location.uri, location.span, severity, code, message, related)

    def authors(self, focus: Node) -> Iterable[Key]:
        """Return the declarations that describe a focus node, or the nodes from which it was derived."""
        anchors = self.derived.anchors.get((str(focus), ""), [])
        nodes = (str(focus), *(key[0] for key in anchors))
        return next((self.built.authors[node] for node in nodes if node in self.built.authors), ())

    def _locations(self, result: Result) -> tuple[Location, ...]:
        """Return the most precise known places: places of the value, or else of the property, or else of the node."""
        places = self.built.sources.places
        for key in self._keys(result):
            if key in places:
                return places[key] if len(key) == 3 else places[key][:1]
        return (Location(self.built.uri, Span(0, 0)),)

    def _keys(self, result: Result) -> Iterator[tuple[str, ...]]:
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
            for extent in self.built.unreliable_declarations
        )

    def _related(self, result: Result, location: Location) -> Iterator[Related]:
        """Yield links to related declarations.

        A wrong value is linked to its declaration, and an assignment to the declaration of its variable.
        """
        variable = next(iter(self._derived(result.focus, "variable")), None)
        for node in (result.value, variable):
            declared = None if node is None else self.built.sources.node(str(node))
            if declared is not None and declared != location and str(node) in self.built.names:
                yield Related(declared.uri, declared.span, f"'{self._name(node)}' is declared here")

    def _message(self, result: Result) -> str:
        def fill(match: re.Match[str]) -> str:
            name = match[1]
            if name == "value":
                return "nothing" if result.value is None else self._name(result.value)
            if name == "focus":
                return self._name(result.focus)
            values = self._derived(result.focus, name)
            return self._name(values[0]) if values else match[0]

        message = _PLACEHOLDER.sub(fill, result.message)
        return f"'{self._subject(result.focus)}': {message}{self._found(result)}" if self.built.is_read else message

    def _found(self, result: Result) -> str:
        """Describe a value in a foreign graph that should be the IRI of a node but is something else."""
        from rdflib import Literal, URIRef

        if not result.message.startswith(("'{value}' cannot stand for", "'{value}' is no ")):
            return ""
        if isinstance(result.value, Literal):
            return " (it is text; the IRI of a node is expected)"
        if isinstance(result.value, URIRef) and (result.value, None, None) not in self.built.graph:
            return " (nothing in the graph describes it)"
        return ""

    def _subject(self, focus: Node) -> str:
        """Return the name of the subject of a finding.

        A derived node has the name of the node from which it was derived.
        """
        names = self.built.names
        anchors = self.derived.anchors.get((str(focus), ""), [])
        roots = (str(focus), *(key[0] for key in anchors))
        return next((names[node] for node in roots if node in names), str(focus))

    def _derived(self, node: Node, name: str) -> list[Node]:
        from rdflib import URIRef

        return sorted(self.derived.graph.objects(node, URIRef(expand(f"rbw:{name}"))), key=str)

    def _name(self, node: Node | None) -> str:
        from rdflib import BNode

        if isinstance(node, BNode):
            return "{ … }"
        return self.built.names.get(str(node), str(node))


def clash_finding(built: BuiltGraph, clash: Clash) -> Diagnostic:
    """Return the diagnostic for two declarations with the same IRI."""
    name = built.names.get(clash.iri, clash.iri).rpartition(".")[2]
    message = (
        f"'{name}' is already the name of something else in this namespace (both are <{clash.iri}>): "
        "give one of the two another name or namespace"
    )
    related = (Related(clash.first.uri, clash.first.span, "the first declaration"),)
    return Diagnostic(clash.location.uri, clash.location.span, Severity.ERROR, "duplicate-iri", message, related)


def merged(found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return findings in text order. Findings with the same message and place are merged."""
    kept: dict[tuple[str, Span, str], Diagnostic] = {}
    for diagnostic in sorted(found, key=sort_key):
        kept.setdefault((diagnostic.uri, diagnostic.span, diagnostic.message), diagnostic)
    return list(kept.values())
