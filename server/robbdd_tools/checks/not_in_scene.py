"""``not-in-scene``: the scene of a variant lacks a value, although it has other elements of the same kind.

This is allowed: the element then belongs only to the scene of that variant. A scene without any agent is not reported,
because it leaves the choice of agents to its variants on purpose.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Related, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.checks.chosen_elements import chosen_elements, written_elements
from robbdd_tools.checks.finding import finding
from robbdd_tools.checks.lines import import_edit
from robbdd_tools.checks.replacements import SET_WORDS
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.elements import Element, scene_members
from robbdd_tools.names.imports import import_path
from robbdd_tools.names.uses import ELEMENTS
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

_BROUGHT = ("ObjectSet", "WorkspaceSet", "AgentSet")


def not_in_scene(site: Site) -> Iterator[Diagnostic]:
    """Report each element that the scene lacks once for each variant, at its first occurrence."""
    known: dict[tuple[str, str], frozenset[Element] | None] = {}
    for scenario in scenarios(site):
        scene = site.target(scenario.variant.scene)
        if scene is None:
            continue
        # Most scenarios of a long story share a few scenes.
        key = (scene.uri, scene.symbol.path)
        if key not in known:
            known[key] = scene_members(site.follow(scenario.variant.scene))
        members = known[key]
        if members is not None:
            yield from _elements_outside(scenario, members)


def _elements_outside(scenario: Scenario, members: frozenset[Element]) -> Iterator[Diagnostic]:
    site, scene = scenario.site, scenario.variant.scene
    kinds = {element.kind for element in members}
    listed = {element.key for element in members} | {element.key for element in _named_set_members(scenario)}
    definition = site.target(scene)
    for column in scenario.columns:
        for written in column.written:
            for node, element in written_elements(site, written):
                if element.kind not in kinds & ELEMENTS or element.key in listed or definition is None:
                    continue
                listed.add(element.key)
                message = (
                    f"'{element.name}' is not in '{scene.path}', so it belongs to this scenario only: "
                    "add it to the scene if it is always there"
                )
                related = (Related(definition.uri, definition.span, "the scene"),)
                fixes = tuple(_extended(site.follow(scene), element))
                yield finding(site, node, Severity.INFORMATION, "not-in-scene", message, related, fixes)


def _extended(site: Site | None, element: Element) -> Iterator[Fix]:
    """Yield the fix that adds the set of an element to a scene, and if necessary the import of the set."""
    scene = None if site is None else site.tree
    if site is None or not isinstance(scene, tree.Scene):
        return
    source, words = element.key[0], f"{SET_WORDS[element.kind]} <{element.name.rpartition('.')[0]}>"
    edits: list[Edit] = []
    if not site.snapshot.reachability.reaches(site.uri, source):
        path = import_path(site.uri, source)
        if path is None or site.snapshot.reachability.reaches(source, site.uri):
            return
        edits.append(import_edit(site.file, path))
    document = site.file.document
    if scene.entries:
        end = site.span(scene.entries[-1]).end
        start = document.text[document.line_starts[document.position(site.span(scene.entries[-1]).start).line] : end]
        indent = start[: len(start) - len(start.lstrip())]
        is_below = start.lstrip() == document.text[site.span(scene.entries[-1]).start : end]
        text = f"\n{indent}{words}" if is_below else f" {words}"
    else:
        end = document.text.index("{", site.span(scene.name).end) + 1
        text = f" {words}"
    edits.append(Edit(site.uri, Span(end, end), text))
    yield Fix(f"Add '{words}' to the scene '{scene.name.text}'", tuple(edits))


def _named_set_members(scenario: Scenario) -> Iterator[Element]:
    """Yield the members of the element sets in a variation. Naming a whole set adds its members to the scene."""
    for column in scenario.columns:
        for written in column.written:
            if isinstance(written, tree.Link) and written.reference.role in _BROUGHT:
                yield from chosen_elements(scenario.site, written.reference, written.where) or ()
