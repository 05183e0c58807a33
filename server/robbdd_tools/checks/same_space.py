"""``same-space``: one object carries several workspaces, but its model has one space for all of them.

A thing at one of them is then at each of them: a clause could hold where it should not.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.catalog.name_words import spaces_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.catalog_models import has_executable_scene
from robbdd_tools.checks.no_model import not_modelled
from robbdd_tools.checks.several_places import Key, contains, contents
from robbdd_tools.names.elements import Site, simulated_members
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.elements import Element
    from robbdd_tools.names.project import Snapshot

CODE = "same-space"


def same_space(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report such workspaces of each scene without a loaded executable scene, and of each executable scene.

    Of an executable scene, only those count for which it has neither a box nor a model of the object.
    """
    for placed in file.of(tree.Scene):
        scene, site = placed.declaration.tree, Site(snapshot, file, placed)
        if isinstance(scene, tree.Scene) and not has_executable_scene(snapshot, scene.name.text):
            yield from _findings(site, scene.name, _groups(site, simulated_members(site), frozenset()))
    for placed in file.of(tree.SceneInstance):
        instance, site = placed.declaration.tree, Site(snapshot, file, placed)
        realised = site.follow(instance.scene) if isinstance(instance, tree.SceneInstance) else None
        if isinstance(instance, tree.SceneInstance) and realised is not None:
            things = not_modelled(simulated_members(realised), [site])
            yield from _findings(site, instance.name, _groups(realised, things, _boxed(site, instance)))


def _findings(site: Site, name: tree.Name, groups: Iterable[tuple[str, list[str]]]) -> Iterator[Diagnostic]:
    for thing, names in groups:
        yield Diagnostic(site.uri, site.span(name), Severity.WARNING, CODE, one_space(thing, names))


def _boxed(site: Site, instance: tree.SceneInstance) -> frozenset[Key]:
    """Return the workspaces for which an executable scene states boxes."""
    stated = (
        site.target(node.reference)
        for node in walk(instance)
        if isinstance(node, tree.Modelled) and any(isinstance(entry, tree.WorkspaceBox) for entry in node.entries)
    )
    return frozenset((target.uri, target.symbol.path) for target in stated if target is not None)


def one_space(thing: str, names: list[str]) -> str:
    """Return the message on workspaces of an object that are the same space."""
    return (
        f"{' and '.join(repr(name) for name in names)} are the same space, because '{thing}' carries them and has only "
        "one: state a box for each in a .scenex, or let other objects carry them"
    )


def _groups(site: Site, members: Iterable[Element], boxed: frozenset[Key]) -> Iterator[tuple[str, list[str]]]:
    """Yield each object with the names of those of its workspaces that are one space of its catalog model."""
    carriers: dict[Key, set[Key]] = {}
    inner: dict[Key, set[Key]] = {}
    contents(site, carriers, inner)
    for thing in sorted(members, key=lambda element: element.name):
        own = sorted(one for one, things in carriers.items() if thing.key in things and one not in boxed)
        *sets, name = thing.name.split(".")
        model = load_catalog().object_for(name, sets) if thing.kind == "object" and len(own) > 1 else None
        if model is None:
            continue
        spaces: dict[tuple[str, ...], list[Key]] = {}
        for one in own:
            spaces.setdefault(tuple(region.name for region in spaces_of(model, _local(one))), []).append(one)
        for same in spaces.values():
            apart = [one for one in same if not any(contains(other, one, inner) for other in same)]
            if len(apart) > 1:
                yield name, [_local(one) for one in apart]


def _local(workspace: Key) -> str:
    return workspace[1].rpartition(".")[2]
