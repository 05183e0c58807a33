"""All diagnostics of a file: the fast ones for every keystroke, and the slow ones from SHACL shapes."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity, sort_key
from robbdd_tools.base.document import Span
from robbdd_tools.checks import run_checks
from robbdd_tools.checks.contradicted_values import without_contradicted
from robbdd_tools.checks.graph_files import graph_findings
from robbdd_tools.checks.superseded import without_superseded
from robbdd_tools.features.fixes import with_fixes
from robbdd_tools.features.studies import is_study
from robbdd_tools.syntax.study_text import read_study

if TYPE_CHECKING:
    from robbdd_tools.graph.shapes.incremental import Validation
    from robbdd_tools.graph.shapes.project_shapes import EditorShapes
    from robbdd_tools.names.project import Snapshot


def fast_diagnostics(snapshot: Snapshot, uri: str) -> list[Diagnostic]:
    """Return the diagnostics of one file that concern syntax, names and rules.

    An unreadable file has a single diagnostic at its start.
    """
    unreadable = snapshot.unreadable(uri)
    if unreadable is not None:
        return [Diagnostic(uri, Span(0, 0), Severity.ERROR, unreadable.code, unreadable.reason)]
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    if is_study(uri):
        return read_study(analysis.document)[1]
    # If several repairs fail at the end of a text, they give the same message with different fixes.
    first: dict[object, Diagnostic] = {}
    for found in (*with_fixes(snapshot, analysis, analysis.diagnostics), *run_checks(snapshot, uri)):
        first.setdefault((found.span, found.code, found.message, found.related), found)
    return sorted(first.values(), key=sort_key)


def shape_diagnostics(
    snapshot: Snapshot,
    uri: str,
    shapes: EditorShapes | None = None,
    validation: Validation | None = None,
    is_superseded: Callable[[], bool] = lambda: False,
    together: Collection[str] = (),
) -> list[Diagnostic]:
    """Return the SHACL diagnostics of the graph of a file and its imports. Each diagnostic names its own file.

    Mistakes that a fast rule reports at the same place are left out. ``shapes`` are added to the project's shapes. A
    ``validation`` that knows an earlier revision checks only what has changed since, and raises ``Superseded`` if a
    newer revision is waiting. All declarations of the imported files ``together`` are also validated.
    """
    from robbdd_tools.base.graph_formats import graph_format
    from robbdd_tools.graph.shapes.project_shapes import project_shapes
    from robbdd_tools.graph.shapes.validate import validate
    from robbdd_tools.graph.write.build import build_graph

    if snapshot.file(uri) is None:
        return []
    project = project_shapes(uri, shapes)
    if graph_format(uri):
        built = build_graph(snapshot, uri)
        found = [*validate(built, project=project), *graph_findings(built)]
    elif validation is None:
        found = validate(build_graph(snapshot, uri, together), project=project)
    else:
        found = validation.run(snapshot, uri, project, is_superseded)
    files = dict.fromkeys(diagnostic.uri for diagnostic in found)
    reported = [diagnostic for name in files for diagnostic in fast_diagnostics(snapshot, name)]
    return without_contradicted(snapshot, without_superseded(found, reported))


def text_diagnostics(snapshot: Snapshot, uri: str) -> list[Diagnostic]:
    """Return the diagnostics of a file and its imports that concern syntax, names and rules, without duplicates."""
    found = dict.fromkeys(fast_diagnostics(snapshot, uri))
    if snapshot.file(uri) is not None:
        for analysis in snapshot.closure(uri)[1:]:
            found |= dict.fromkeys(fast_diagnostics(snapshot, analysis.document.uri))
        for part in snapshot.joined.get(uri, ()):
            found |= dict.fromkeys(fast_diagnostics(snapshot, part))
    return list(found)


def all_diagnostics(snapshot: Snapshot, uri: str, together: Collection[str] = ()) -> list[Diagnostic]:
    """Return every diagnostic of a file and its imports, sorted by file and place.

    ``together`` are files that import each other, including this one. They are validated together.
    """
    found = dict.fromkeys((*text_diagnostics(snapshot, uri), *shape_diagnostics(snapshot, uri, together=together)))
    return sorted(found, key=lambda diagnostic: (diagnostic.uri != uri, sort_key(diagnostic)))
