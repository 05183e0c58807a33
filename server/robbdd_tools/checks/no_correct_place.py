"""``no-correct-place``: a clause asks for the correct place of an object, but the scene states none.

A run leaves the clause unknown.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.checks.chosen_elements import chosen_elements, written_elements
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.elements import Site, element_of, elements_of, site_of, story_sites
from robbdd_tools.names.types import uses_by_variable, variable_key
from robbdd_tools.names.uses import phrase_words
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "no-correct-place"
Key = tuple[str, str]
WORDS = ("is-correct-for", "are-sorted-correctly")
"""The predicates that ask for the correct place of an object."""
PART = "correct"
"""Every phrase of these predicates contains this text."""


def no_correct_place(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each object without a correct place once for each variant, at its first occurrence among the values."""
    scope = snapshot.scope(file.document.uri)
    if scope.is_small and not any(PART in one.document.text for one in scope.files):
        return  # Stories are visited only if the scope contains such a phrase, because there can be many.
    placed: frozenset[Key] | None = None
    for site in story_sites(snapshot, file):
        for scenario in scenarios(site):
            asked = _asked(scenario)
            if asked and placed is None:
                placed = _placed(snapshot, file)
            if asked and placed is not None:
                yield from _missing(scenario, asked, placed)


def _missing(
    scenario: Scenario, asked: dict[str, tuple[Site, tree.Ref]], placed: frozenset[Key]
) -> Iterator[Diagnostic]:
    site = scenario.site
    reported: set[Key] = set()
    for column in scenario.columns:
        clause = None if column.variable is None else asked.get(variable_key(column.variable))
        if clause is None:
            continue
        for node, element in (found for one in column.written for found in written_elements(site, one)):
            if element.kind != "object" or element.key in placed or element.key in reported:
                continue
            reported.add(element.key)
            yield finding(
                site, node, Severity.WARNING, CODE, no_place(element.name), (related_to(*clause, "the clause"),)
            )


def no_place(name: str) -> str:
    """Return the message on an object without a stated workspace."""
    return (
        f"no workspace is correct for '{name}', so that clauses that ask for it stay unknown: "
        "write 'workspace NAME { correct for: obj <…> }' in the scene"
    )


def _asked(scenario: Scenario) -> dict[str, tuple[Site, tree.Ref]]:
    """Return the variables for whose objects clauses ask for the correct place, each with its first occurrence."""
    found: dict[str, tuple[Site, tree.Ref]] = {}
    for site, clauses in ((scenario.template, scenario.outer), (scenario.site, scenario.clauses)):
        phrases = {phrase_words(word) for word in WORDS}
        if site is None or clauses is None or not any(use.phrase in phrases for use in clauses.uses):
            continue
        for key, uses in uses_by_variable(site, clauses).items():
            for use in uses:
                if use.phrase in phrases and "object" in use.kinds:
                    found.setdefault(key, (site, use.ref))
    return found


def _placed(snapshot: Snapshot, file: FileAnalysis) -> frozenset[Key] | None:
    """Return the objects that have a correct workspace; ``None`` if they are not completely known."""
    found: set[Key] = set()
    for one in snapshot.closure(file.document.uri):
        for declared in one.declarations:
            for link in _stated(declared.declaration):
                site = Site(snapshot, one, declared)
                element = element_of(site, link.reference) if link.reference.role == "Object" else None
                members = (element,) if element is not None else chosen_elements(site, link.reference, link.where)
                if members is None:
                    return None
                found.update(member.key for member in members)
    return frozenset(found.union(_placed_by_graphs(snapshot, file)))


def _placed_by_graphs(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Key]:
    """Yield the objects for which imported graphs state a correct workspace."""
    closure = snapshot.closure(file.document.uri)
    if not any(graph_format(link.uri) for one in closure for link in one.imports):
        return
    from robbdd_tools.graph.write.imported_graphs import CORRECT_FOR, imported_graph

    stated = imported_graph(snapshot, file.document.uri).values(CORRECT_FOR)
    for definition in (definition for one in closure for definition in one.definitions.values()):
        if definition.iri in stated:
            is_set = definition.kind is SymbolKind.OBJECT_SET
            members = elements_of(site_of(snapshot, definition)) or () if is_set else ()
            yield from ((definition.uri, definition.symbol.path), *(member.key for member in members))


@kept_with_key
def _stated(declaration: Declaration) -> tuple[tree.Link, ...]:
    """Return the objects, or sets of objects, for which the workspaces in a declaration are correct."""
    root = declaration.tree
    members = root.members if isinstance(root, tree.ElementSet) else ()
    return tuple(link for member in members for link in member.correct_for)
