"""Go to type definition: from a variant to its template, from an element to its set, from a variable to its values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.features.describe import variants_of
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.names.elements import Site, site_of
from robbdd_tools.names.types import variable_key, written_elements
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_ELEMENTS = (SymbolKind.OBJECT, SymbolKind.WORKSPACE, SymbolKind.AGENT)
_VARIABLES = (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE)


def type_definition(snapshot: Snapshot, uri: str, offset: int) -> list[tuple[str, Span]]:
    """Return the places that define the type of the name at an offset, sorted by file and place."""
    found = symbol_at(snapshot, uri, offset)
    site = None if found is None else site_of(snapshot, found[1])
    if found is None or site is None:
        return []
    types = _types(site, found[1])
    return sorted({(definition.uri, definition.span) for definition in types})


def _types(site: Site, definition: Definition) -> list[Definition]:
    if definition.kind in _VARIABLES:
        return _value_sets(site, definition)
    if definition.kind in _ELEMENTS:
        owner = site.file.definitions.get(definition.symbol.path.rpartition(".")[0])
        return [] if owner is None else [owner]
    refs = _type_refs(site, definition)
    return [target for target in (site.target(ref) for ref in refs) if target is not None]


def _type_refs(site: Site, definition: Definition) -> list[tree.Ref]:
    match site.tree:
        case tree.Story() as story:
            return [variant.template for variant in story.variants if site.span(variant.name) == definition.span]
        case tree.TreeInstance() as instance:
            return [instance.template]
        case tree.SceneInstance() as instance if definition.kind is SymbolKind.SCENE_INSTANCE:
            return [instance.scene]
        case tree.Execution() as execution:
            return [execution.variant]
        case tree.Policy() as policy:
            return [policy.fluent]
        case tree.Observation() as observation:
            return [observation.provider]
        case _:
            return []


def _value_sets(site: Site, variable: Definition) -> list[Definition]:
    """Return the sets that variants assign to a variable, and the sets that contain the assigned elements."""
    template = site.file.definitions.get(variable.symbol.path.partition(".")[0])
    found: list[Definition] = []
    for scenario in variants_of(site.snapshot, template) if template is not None else ():
        for column in scenario.columns:
            if column.variable is None or variable_key(column.variable) != variable_key(variable):
                continue
            for written in column.written:
                for node, _ in written_elements(scenario.site, written):
                    target = scenario.site.target(node) if isinstance(node, tree.Ref) else None
                    if target is not None:
                        found.append(_set_of(site.snapshot, target))
    return found


def _set_of(snapshot: Snapshot, target: Definition) -> Definition:
    file = snapshot.file(target.uri)
    owner = None if file is None else file.definitions.get(target.symbol.path.rpartition(".")[0])
    return target if owner is None or target.kind not in _ELEMENTS else owner
