"""Determine the elements of a scene that its scenarios use."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.elements import Site, elements_of, site_of, story_sites
from robbdd_tools.names.index import language_of
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

Key = tuple[str, str]
_ELEMENTS = (SymbolKind.OBJECT, SymbolKind.WORKSPACE, SymbolKind.AGENT)


def used_elements(scene: Site) -> frozenset[Key] | None:
    """Return the elements of a scene that its loaded scenarios use.

    Objects that carry a used workspace are included. If the scene has no scenario, the use is unknown, and the result
    is ``None``.
    """
    found: set[Key] = set()
    is_used = False
    for scenario in _scenarios(scene):
        is_used = True
        found.update(_named(scenario))
    return frozenset(found | _carriers(scene, found)) if is_used else None


def _scenarios(scene: Site) -> Iterator[Scenario]:
    root, snapshot = scene.tree, scene.snapshot
    path = root.name.text if isinstance(root, tree.Scene) else ""
    for uri, offset in _stories_by_scene(snapshot).get((scene.uri, path), ()):
        file = snapshot.file(uri)
        at = Span(offset, offset)
        for site in story_sites(snapshot, file, at) if file is not None else ():
            for scenario in scenarios(site) if site.placed.offset == offset else ():
                target = site.target(scenario.variant.scene)
                if target is not None and (target.uri, target.symbol.path) == (scene.uri, path):
                    yield scenario


@kept_with_key
def _stories_by_scene(snapshot: Snapshot) -> Mapping[Key, list[tuple[str, int]]]:
    """Return the places of the stories, or parts of stories, that take place in each scene."""
    found: dict[Key, dict[tuple[str, int], None]] = {}
    for uri in sorted(snapshot.sources):
        file = snapshot.file(uri) if language_of(uri) == "bdd" else None
        for site in story_sites(snapshot, file) if file is not None else ():
            for clauses in clauses_of(site.placed.declaration):
                target = site.target(clauses.node.scene) if isinstance(clauses.node, tree.Variant) else None
                if target is not None:
                    found.setdefault((target.uri, target.symbol.path), {})[uri, site.placed.offset] = None
    return {scene: list(places) for scene, places in found.items()}


def _named(scenario: Scenario) -> Iterator[Key]:
    """Yield the elements that values and clauses name, either individually or by their sets."""
    yield from _targets(scenario.site, scenario.variant)
    if scenario.template is not None and isinstance(scenario.template.tree, tree.Template):
        yield from _targets(scenario.template, scenario.template.tree)


def _targets(site: Site, node: tree.Node) -> Iterator[Key]:
    for reference in site.placed.declaration.references:
        definition = site.target(reference.ref) if node.span.contains(reference.ref.span.start) else None
        if definition is not None:
            yield from _elements(site, definition)


def _elements(site: Site, definition: Definition) -> Iterator[Key]:
    if definition.kind in _ELEMENTS:
        yield definition.uri, definition.symbol.path
    elif definition.kind is not SymbolKind.SCENE:
        for element in elements_of(site_of(site.snapshot, definition)) or ():
            yield element.key


def _carriers(scene: Site, used: set[Key]) -> set[Key]:
    """Return the objects in the compositions of used workspaces, at any depth."""
    found: set[Key] = set()
    seen: set[tuple[str, int, bool]] = set()
    root = scene.tree
    entries = root.entries if isinstance(root, tree.Scene) else ()
    waiting = [(scene.follow(entry.reference), False) for entry in entries if entry.reference.role == "Composition"]
    for composition, is_inside in waiting:
        inner = None if composition is None else composition.tree
        if composition is None or not isinstance(inner, tree.Composition):
            continue
        visit = (composition.uri, composition.placed.offset, is_inside)
        if visit in seen:
            continue
        seen.add(visit)
        workspace = composition.target(inner.workspace)
        is_used = is_inside or (workspace is not None and (workspace.uri, workspace.symbol.path) in used)
        for entry in inner.entries:
            if entry.reference.role == "Composition":
                waiting.append((composition.follow(entry.reference), is_used))
                continue
            target = composition.target(entry.reference) if is_used else None
            if target is not None:
                found.add((target.uri, target.symbol.path))
    return found
