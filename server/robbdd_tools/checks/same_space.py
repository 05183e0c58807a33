"""``same-space``: one object carries several workspaces, but its model has one space for all of them.

A thing at one of them is then at each of them: a clause could hold where it should not.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.catalog.name_words import spaces_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.catalog_models import has_executable_scene
from robbdd_tools.checks.several_places import Key, contains, contents
from robbdd_tools.names.elements import Site, simulated_members
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

CODE = "same-space"


def same_space(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report such workspaces of each scene that no loaded executable scene realises."""
    for placed in file.of(tree.Scene):
        scene, site = placed.declaration.tree, Site(snapshot, file, placed)
        if not isinstance(scene, tree.Scene) or has_executable_scene(snapshot, scene.name.text):
            continue
        span = scene.name.span.shifted(placed.offset)
        for thing, names in _groups(site):
            yield Diagnostic(file.document.uri, span, Severity.WARNING, CODE, one_space(thing, names))


def one_space(thing: str, names: list[str]) -> str:
    """Return the message on workspaces of an object that are the same space."""
    return (
        f"{' and '.join(repr(name) for name in names)} are the same space, because '{thing}' carries them and has only "
        "one: state a box for each in a .scenex, or let other objects carry them"
    )


def _groups(site: Site) -> Iterator[tuple[str, list[str]]]:
    """Yield each object with the names of those of its workspaces that are one space of its catalog model."""
    carriers: dict[Key, set[Key]] = {}
    inner: dict[Key, set[Key]] = {}
    contents(site, carriers, inner)
    for thing in sorted(simulated_members(site), key=lambda element: element.name):
        own = sorted(workspace for workspace, things in carriers.items() if thing.key in things)
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
