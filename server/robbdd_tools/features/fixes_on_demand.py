"""Quick fixes that are computed only on request, because they read the disk or search all names and uses."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Severity
from robbdd_tools.base.removals import removal
from robbdd_tools.checks.finding import MAX_OFFERED, change
from robbdd_tools.checks.table_edits import column_removed
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.features.fixes import imports_of, reference_at
from robbdd_tools.features.fixes_of_files import cycle_fixes, import_fixes, model_file_fixes
from robbdd_tools.features.model_choices import model_choices
from robbdd_tools.features.policy_skeleton import policy_fixes
from robbdd_tools.features.rename import RenameRefused, rename
from robbdd_tools.features.unimported import Elsewhere, beside
from robbdd_tools.names.elements import Site, elements_of, site_of
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.problems import free_name
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.names.types import narrowed, variable_key, variable_type
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.uses import Kinds

Finder = Callable[["Snapshot", "FileAnalysis", Diagnostic], Iterator[Fix]]


def fixes_on_demand(
    snapshot: Snapshot, uri: str, diagnostic: Diagnostic, elsewhere: Elsewhere | None = None
) -> tuple[Fix, ...]:
    """Return the quick fixes that a diagnostic does not contain yet.

    All files that import the file of the diagnostic must be loaded.
    """
    file, find = snapshot.file(uri), _FINDERS.get(diagnostic.code)
    if file is not None and diagnostic.code == "unknown-name":
        return tuple(_imports(snapshot, file, diagnostic, elsewhere))
    return () if file is None or find is None else tuple(find(snapshot, file, diagnostic))


def _imports(
    snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic, elsewhere: Elsewhere | None
) -> Iterator[Fix]:
    """Yield fixes for an unknown name. Each adds the import of a file that declares the name but is not loaded."""
    used, uri = reference_at(file, diagnostic.span), file.document.uri
    if used is not None:
        yield from imports_of(file, used[1], beside(snapshot, uri))
        yield from imports_of(file, used[1], elsewhere.importable(snapshot, uri) if elsewhere is not None else ())


def _another_name(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield a fix for a declaration with a duplicate IRI. The fix renames the declaration and all its uses."""
    span = diagnostic.span
    tables = (source.names.entries for source in snapshot.sources.values() if isinstance(source, FileIndex))
    name = free_name(file.document.text[span.start : span.end], (path for table in tables for path in table))
    try:
        yield Fix(f"Rename to '{name}'", tuple(rename(snapshot, file.document.uri, span.start, name)))
    except RenameRefused:
        return


def _another_end(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield fixes that replace the end event of a duration. Events declared after the start event come first."""
    site = _site(snapshot, file, diagnostic)
    for clauses in clauses_of(site.placed.declaration) if site is not None else ():
        for during in clauses.durations:
            if site is None or site.span(during) != diagnostic.span:
                continue
            ordered = {(other.start.path, other.end.path) for other in clauses.durations}
            start = during.start.path
            names = _visible(snapshot, file, "Event")
            behind = (names[names.index(start) + 1 :] + names[: names.index(start)]) if start in names else names
            fitting = [name for name in behind if name != start and (name, start) not in ordered]
            for name in fitting[:MAX_OFFERED]:
                yield change(site, f"End with '{name}'", during.end, name)


def _visible(snapshot: Snapshot, file: FileAnalysis, role: str) -> list[str]:
    """Return the names of a role in the order of files and text."""
    scope = snapshot.scope(file.document.uri)
    found = scope.visible(ROLE_KINDS[role], ())
    order = {index.document.uri: number for number, index in enumerate(scope.files)}
    return sorted(found, key=lambda name: (order[found[name][0].document.uri], found[name][1].offset))


def _another_set(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield other sets for a quantified variable."""
    site = _site(snapshot, file, diagnostic)
    for clauses in clauses_of(site.placed.declaration) if site is not None else ():
        for use in clauses.uses:
            if site is None or use.bound is None or site.span(use.ref) != diagnostic.span:
                continue
            kinds = narrowed(other for other in clauses.uses if other.bound == use.bound)
            written = reference_at(file, site.span(use.bound.in_set))
            scope = snapshot.scope(site.uri)
            visible = scope.visible(ROLE_KINDS["AnySet"], written[1].scopes if written is not None else ())
            fitting = [name for name, found in visible.items() if _has_only(snapshot, scope.define(*found), kinds)]
            for name in [name for name in fitting if name != use.bound.in_set.path][:MAX_OFFERED]:
                yield change(site, f"Change the set to '{name}'", use.bound.in_set, name)


def _has_only(snapshot: Snapshot, definition: Definition, kinds: Kinds) -> bool:
    """Return whether a set has elements and all of them are of the given kinds.

    For a set variable, it is enough that the kinds of its elements may match, because its type may be unknown.
    """
    if definition.kind is SymbolKind.SET_VARIABLE:
        return bool(variable_type(snapshot, definition).kinds & kinds)
    elements = elements_of(site_of(snapshot, definition))
    return bool(elements) and all(element.kind in kinds for element in elements or ())


def _without_values(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield a fix that removes a variable together with its values in the scenarios of its file."""
    found = next((one for one in file.definitions.values() if one.span == diagnostic.span), None)
    # The severity is lower for variables without values and for variables of quantifiers.
    if found is None or diagnostic.severity is not Severity.WARNING:
        return
    edits = [*removal(file.document, "", found.extent).edits]
    for placed in file.declarations:
        if not isinstance(placed.declaration.tree, tree.Story):
            continue
        for scenario in scenarios(Site(snapshot, file, placed)):
            for number, column in enumerate(scenario.columns):
                if column.variable is not None and variable_key(column.variable) == variable_key(found):
                    removed = _column_removed(scenario, number)
                    if not removed:
                        return
                    edits += removed
    yield Fix(f"Remove the variable '{found.symbol.name}' and its values", tuple(edits))


def _column_removed(scenario: Scenario, number: int) -> tuple[Edit, ...]:
    """Return the edits that remove one variable of a variation: its line in a product or its column in a table.

    Returns no edits if it is the only variable.
    """
    variation = scenario.variant.variation
    if isinstance(variation, tree.Table):
        return column_removed(scenario.site, variation, number)
    if len(variation.assignments) == 1:
        return ()
    return removal(scenario.site.file.document, "", scenario.site.span(variation.assignments[number])).edits


def _site(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Site | None:
    placed = next((one for one in reversed(file.declarations) if one.offset <= diagnostic.span.start), None)
    return None if placed is None else Site(snapshot, file, placed)


_FINDERS: Mapping[str, Finder] = {
    "import": import_fixes,
    "model-file": model_file_fixes,
    "no-evaluator": policy_fixes,
    "no-model": model_choices,
    "cyclic-import": cycle_fixes,
    "duplicate-iri": _another_name,
    "empty-duration": _another_end,
    "type-conflict": _another_set,
    "unused-variable": _without_values,
}
