"""``no-region``: a variant uses a workspace that no object of its scene carries.

Nothing can be placed or located there, so a run leaves the scenarios that use the workspace unknown.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Related, Severity
from robbdd_tools.checks.chosen_elements import written_elements
from robbdd_tools.checks.finding import finding
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.names.elements import element_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

CODE = "no-region"
Key = tuple[str, str]


def no_region(site: Site) -> Iterator[Diagnostic]:
    """Report each workspace that no object carries once for each variant, at its first occurrence."""
    for scenario in scenarios(site):
        scene = site.follow(scenario.variant.scene)
        carried = _carried(scene)
        if carried is None or scene is None:
            continue
        reported: set[Key] = set()
        written = (one for column in scenario.columns for one in column.written)
        for node, element in (found for one in written for found in written_elements(site, one)):
            if element.kind != "workspace" or element.key in carried or element.key in reported:
                continue
            reported.add(element.key)
            message = not_carried(scenario.variant.scene.path, element.name)
            target = site.target(scenario.variant.scene)
            related = () if target is None else (Related(target.uri, target.span, "the scene"),)
            yield finding(site, node, Severity.WARNING, CODE, message, related)


def not_carried(scene: str, workspace: str) -> str:
    """Return the message on a workspace that no object of a scene carries."""
    return (
        f"no object of '{scene}' carries '{workspace}', so that scenarios with it stay unknown: "
        "add a composition of it, with its object, to the scene"
    )


def _carried(scene: Site | None) -> frozenset[Key] | None:
    """Return the workspaces that objects of a scene carry; ``None`` if they are not completely known.

    A workspace is also carried if a workspace inside it is carried.
    """
    root = None if scene is None else scene.tree
    if scene is None or not isinstance(root, tree.Scene) or not scene.whole(root):
        return None
    carried: set[Key] = set()
    around: dict[Key, set[Key]] = {}
    for entry in root.entries:
        if entry.reference.role == "Composition":
            workspace = _compose(scene.follow(entry.reference), frozenset(), carried, around)
            if workspace is None:
                return None
    waiting = list(carried)
    while waiting:
        outer = around.get(waiting.pop(), set()) - carried
        carried |= outer
        waiting += outer
    return frozenset(carried)


def _compose(site: Site | None, above: frozenset[Key], carried: set[Key], around: dict[Key, set[Key]]) -> Key | None:
    """Add the workspaces of a composition, even nested ones: to ``carried``, and to ``around`` their outer workspaces.

    Returns:
        The workspace of the composition; ``None`` if the composition or a nested one is not completely known.
    """
    root = None if site is None else site.tree
    if site is None or not isinstance(root, tree.Composition) or not site.whole(root):
        return None
    own = element_of(site, root.workspace)
    if own is None or own.key in above:
        return None
    for entry in root.entries:
        if entry.reference.role == "Object":
            carried.add(own.key)
            continue
        if entry.reference.role == "Composition":
            inner = _compose(site.follow(entry.reference), above | {own.key}, carried, around)
        else:
            inside = element_of(site, entry.reference)
            inner = None if inside is None else inside.key
        if inner is None:
            return None
        around.setdefault(inner, set()).add(own.key)
    return own.key
