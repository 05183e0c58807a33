"""``catalog-models``: list the catalog models of a scene that has no executable scene.

The names of elements select these models.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.names.elements import Element, Site, simulated_members
from robbdd_tools.names.index import FileIndex, language_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot


def catalog_models(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report the models of the elements of each scene, once for each scene.

    A scene is skipped if a loaded executable scene defines its models.
    """
    for placed in file.of(tree.Scene):
        scene = placed.declaration.tree
        if not isinstance(scene, tree.Scene) or has_executable_scene(snapshot, scene.name.text):
            continue
        chosen = _chosen(simulated_members(Site(snapshot, file, placed)))
        if chosen:
            named = "; ".join(f"{', '.join(names)} as {model}" for model, names in sorted(chosen.items()))
            message = f"without a .scenex this scene runs on models of the catalog, by name: {named}"
            span = scene.name.span.shifted(placed.offset)
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


def _chosen(members: frozenset[Element]) -> dict[str, list[str]]:
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
