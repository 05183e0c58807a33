"""``catalog-models``: list the elements that have a model of the catalog only because of their names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.no_model import not_modelled
from robbdd_tools.names.elements import Element, Site, simulated_members
from robbdd_tools.names.index import FileIndex, language_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot


def catalog_models(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report the catalog models of each scene without a loaded executable scene, and of each executable scene."""
    for placed in file.of(tree.Scene):
        scene = placed.declaration.tree
        if isinstance(scene, tree.Scene) and not has_executable_scene(snapshot, scene.name.text):
            members = simulated_members(Site(snapshot, file, placed))
            yield from _listed(file, placed, scene.name, "without a .scenex this scene runs on models", members)
    for placed in file.of(tree.SceneInstance):
        instance, site = placed.declaration.tree, Site(snapshot, file, placed)
        scene_site = site.follow(instance.scene) if isinstance(instance, tree.SceneInstance) else None
        if isinstance(instance, tree.SceneInstance) and scene_site is not None:
            left = not_modelled(simulated_members(scene_site), [site])
            yield from _listed(file, placed, instance.name, "what has no model here runs on models", left)


def _listed(
    file: FileAnalysis, placed: PlacedDeclaration, name: tree.Name, what: str, members: Iterable[Element]
) -> Iterator[Diagnostic]:
    chosen = _chosen(members)
    if chosen:
        named = "; ".join(f"{', '.join(names)} as {model}" for model, names in sorted(chosen.items()))
        message = f"{what} of the catalog, by name: {named}"
        span = name.span.shifted(placed.offset)
        yield Diagnostic(file.document.uri, span, Severity.INFORMATION, "catalog-models", message)


def has_executable_scene(snapshot: Snapshot, scene: str) -> bool:
    """Return whether a loaded executable scene realises a scene of this name."""
    return scene in _executable_scenes(snapshot)


@kept_with_key
def _executable_scenes(snapshot: Snapshot) -> frozenset[str]:
    """Return the names by which the executable scenes of all files refer to their scenes."""
    files = (source for uri, source in snapshot.sources.items() if language_of(uri) == "scenex")
    placed = (entry for file in files if isinstance(file, FileIndex) for entry in file.declarations)
    roots = (entry.declaration.tree for entry in placed)
    return frozenset(root.scene.path for root in roots if isinstance(root, tree.SceneInstance))


def _chosen(members: Iterable[Element]) -> dict[str, list[str]]:
    """Return a map from each model to the names of its elements."""
    catalog = load_catalog()
    found: dict[str, list[str]] = {}
    for member in sorted(members, key=lambda element: element.name):
        name = member.name.rpartition(".")[2]
        if member.kind not in ("object", "agent"):
            continue
        sets = member.name.split(".")[:-1]
        if member.kind == "object":
            model = catalog.object_for(name, sets)
        else:
            model = catalog.robot_for(name, sets) or catalog.bystander_for(name, sets)
        if model is not None:
            found.setdefault(model.name, []).append(name)
    return found
