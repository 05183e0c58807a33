"""Validate by SHACL only the part of a graph that an edit may have affected.

The findings in a declaration depend only on its *neighbourhood*. This consists of the declaration, everything that it
uses directly or indirectly, other declarations of the same nodes and, for a composition, the compositions of the
workspaces in it. The shapes follow properties only forwards (see ``locality``), and every node that is reachable from a
declaration is described by a declaration that it uses. So findings are cached while the neighbourhood is unchanged. For
all other declarations, the graph of their neighbourhoods is built and validated. Differential tests compare the result
with the validation of the whole graph.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.graph.rdf.libraries import UnusableShapes, shacl_report
from robbdd_tools.graph.shapes.derive import derive
from robbdd_tools.graph.shapes.findings import FindingWriter, clash_finding, merged, results
from robbdd_tools.graph.shapes.installed import load_shapes
from robbdd_tools.graph.shapes.locality import is_local
from robbdd_tools.graph.shapes.neighbourhood import Fingerprint, Identity, Neighbourhoods
from robbdd_tools.graph.shapes.project_shapes import ProjectShapes, ShapeFile
from robbdd_tools.graph.shapes.validate import NO_SHAPES, project_findings, together
from robbdd_tools.graph.write.build import build_declarations, build_graph
from robbdd_tools.graph.write.imported_graphs import NOTHING, ImportedGraph, imported_graph
from robbdd_tools.names.anchors import Anchored, Anchors

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.graph.shapes.findings import Result
    from robbdd_tools.graph.write.declarations import Key, Reached
    from robbdd_tools.names.project import Snapshot

AT_ONCE = 60
"""Number of declarations that are validated together. Newer work may interrupt between two groups."""


class Superseded(Exception):
    """The validation ends early, because a newer revision is waiting. The findings so far are cached for it."""


@dataclass(frozen=True, slots=True)
class _Kept:
    fingerprint: Fingerprint
    findings: tuple[Anchored, ...]


class Validation:
    """The validation of one file over its revisions.

    ``looked_at`` counts the declarations validated in the last run.
    """

    def __init__(self) -> None:
        self.looked_at = 0
        self._kept: dict[Identity, _Kept] = {}
        self._files: tuple[ShapeFile, ...] = ()
        self._imported = NOTHING
        self._unusable: set[str] = set()

    def run(
        self,
        snapshot: Snapshot,
        uri: str,
        project: ProjectShapes = NO_SHAPES,
        is_superseded: Callable[[], bool] = lambda: False,
    ) -> list[Diagnostic]:
        """Return the diagnostics of the graph of a file, as ``validate`` does.

        Raises ``Superseded`` if a newer revision is waiting.
        """
        self.looked_at = 0
        self._import(imported_graph(snapshot, uri))
        local = self._local_files(project)
        around = Neighbourhoods(snapshot, uri, self._imported)
        self._forget(around)
        waiting = [entry for entry in around.reached if around.identity(entry) not in self._kept]
        for start in range(0, len(waiting), AT_ONCE):
            if is_superseded():
                raise Superseded
            self._look_at(snapshot, uri, around, waiting[start : start + AT_ONCE], local)
        found = list(self._findings(snapshot, around))
        rest = tuple(file for file in project.files if file not in local or file.uri in self._unusable)
        if rest or project.faults or self._imported.documents:
            built = build_graph(snapshot, uri)
            found += built.faults
            writer = FindingWriter(built, derive(built.graph))
            found += project_findings(writer, ProjectShapes(rest, project.faults))
        return merged([*found, *project.remarks])

    def _import(self, imported: ImportedGraph) -> None:
        """Use the statements of imported graphs. If they have changed, all cached findings are dropped."""
        if imported.documents != self._imported.documents:
            self._kept.clear()
        self._imported = imported

    def _local_files(self, project: ProjectShapes) -> tuple[ShapeFile, ...]:
        """Return the shape files of the project that do not need the whole graph.

        If graphs are imported, there are none: no declaration is responsible for a node that only an imported graph
        describes, so such nodes need the whole graph. If the files have changed, all cached findings are dropped.
        """
        usable = () if self._imported.documents else project.files
        files = tuple(file for file in usable if not file.faults and is_local(file.graph))
        if files != self._files:
            self._files = files
            self._kept.clear()
            self._unusable.clear()
        return tuple(file for file in files if file.uri not in self._unusable)

    def _forget(self, around: Neighbourhoods) -> None:
        """Drop the cached findings of declarations whose neighbourhood has changed."""
        now = {around.identity(entry): entry for entry in around.reached}
        changed = [entry for identity, entry in now.items() if not self._holds(around, identity, entry)]
        outdated = {around.identity(entry) for entry in around.dependents_of(changed)}
        self._kept = {
            identity: kept for identity, kept in self._kept.items() if identity in now and identity not in outdated
        }

    def _holds(self, around: Neighbourhoods, identity: Identity, entry: Reached) -> bool:
        kept = self._kept.get(identity)
        if kept is None or kept.fingerprint != around.fingerprint(entry):
            return False
        return all(around.holds(anchor) for finding in kept.findings for anchor in finding.anchors)

    def _look_at(
        self,
        snapshot: Snapshot,
        uri: str,
        around: Neighbourhoods,
        entries: Collection[Reached],
        local: tuple[ShapeFile, ...],
    ) -> None:
        part = around.complete(entries)
        built = build_declarations(uri, around.uses, part, around.known, self._imported)
        writer = FindingWriter(built, derive(built.graph))
        found: dict[Key, list[Diagnostic]] = {entry.key: [] for entry in entries}

        def take(authors: Iterable[Key], diagnostics: Iterable[Diagnostic]) -> None:
            diagnosed = list(diagnostics)
            for author in authors:
                if author in found:
                    found[author] += diagnosed

        for result in results(shacl_report(writer.derived.graph, load_shapes())):
            take(writer.authors(result.focus), writer.diagnostics(result))
        for result in self._project_results(writer, local):
            take(writer.authors(result.focus), writer.diagnostics(result, local))
        for clash in built.clashes:
            take((entry.key for entry in part if entry.covers(clash.location)), [clash_finding(built, clash)])
        anchors = Anchors(snapshot)
        for entry in entries:
            findings = tuple(anchors.loosened(one, entry.uri, entry.placed) for one in found[entry.key])
            self._kept[around.identity(entry)] = _Kept(around.fingerprint(entry), findings)
        self.looked_at += len(entries)

    def _project_results(self, writer: FindingWriter, local: tuple[ShapeFile, ...]) -> list[Result]:
        if not local or self._unusable:
            return []
        try:
            return list(results(shacl_report(writer.derived.graph, together(local))))
        except UnusableShapes:
            # The validation of the whole graph determines which file is at fault, and the findings of all other files.
            self._unusable = {file.uri for file in local}
            return []

    def _findings(self, snapshot: Snapshot, around: Neighbourhoods) -> Iterator[Diagnostic]:
        anchors = Anchors(snapshot)
        for entry in around.reached:
            for finding in self._kept[around.identity(entry)].findings:
                yield anchors.fixed(finding, entry.uri, entry.placed)
