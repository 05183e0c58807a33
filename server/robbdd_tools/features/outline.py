"""Document outline of a file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.studies import is_study
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.study_text import STUDY, read_study

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_KINDS = {
    "Object": SymbolKind.OBJECT.value,
    "ObjectSet": SymbolKind.OBJECT_SET.value,
    "Workspace": SymbolKind.WORKSPACE.value,
    "Agent": SymbolKind.AGENT.value,
    "AgentSet": SymbolKind.AGENT_SET.value,
}
"""Kinds of the elements that a scene instance models, by the roles of their names."""


@dataclass(frozen=True, slots=True)
class Item:
    """A declared name, or an element of a scene instance, with the names that are declared inside it.

    It has the absolute span of the name and the absolute span of the whole declaration.
    """

    name: str
    kind: str
    span: Span
    extent: Span
    children: tuple[Item, ...]


def outline(snapshot: Snapshot, uri: str) -> list[Item]:
    """Return the declared names of a file, nested like the declarations, in text order."""
    analysis = snapshot.file(uri)
    if analysis is None:
        return []
    if is_study(uri):
        return _of_study(analysis.document)
    inner: dict[str, list[Definition]] = {}
    for path, definition in analysis.definitions.items():
        inner.setdefault(path.rpartition(".")[0], []).append(definition)
    items = [_item(definition, inner) for definition in inner.get("", [])]
    instances = {
        placed.offset + root.name.span.start: (root, placed.offset)
        for placed in analysis.declarations
        if isinstance(root := placed.declaration.tree, tree.SceneInstance)
    }
    return [_with_elements(item, *instances.get(item.span.start, (None, 0))) for item in items]


def _with_elements(item: Item, instance: tree.SceneInstance | None, offset: int) -> Item:
    """Return the item of a scene instance with the elements that it models; any other item as it is."""
    modelled = [entry for entry in instance.entries if isinstance(entry, tree.Modelled)] if instance is not None else []
    return replace(item, children=_grouped(item.children, modelled, offset)) if modelled else item


def _grouped(items: tuple[Item, ...], modelled: Sequence[tree.Modelled], offset: int) -> tuple[Item, ...]:
    """Return items, with those inside of a modelled element as its children, in text order."""
    outer = list(items)
    for one in modelled:
        extent = one.span.shifted(offset)
        own = [item for item in outer if extent.start <= item.span.start < extent.end]
        outer = [item for item in outer if item not in own]
        inner = [entry for entry in one.entries if isinstance(entry, tree.Modelled)]
        name, kind = one.reference.path.rpartition(".")[2], _KINDS.get(one.reference.role, "object")
        span = one.reference.span.shifted(offset)
        outer.append(Item(name, kind, span, extent, _grouped(tuple(own), inner, offset)))
    return tuple(sorted(outer, key=lambda item: item.extent.start))


def _of_study(document: Document) -> list[Item]:
    """Return the study with its settings and factors."""
    content, _ = read_study(document)
    if not content.name:
        return []
    settings = [(name, name, span) for name, span in content.places.items()]
    for factor in content.factors:
        name, word = ("scene", factor.levels[0]) if factor.implementation is None else ("", factor.implementation)
        settings.append((name or word.text, "factor", word.span))
    parts = tuple(Item(name, kind, span, span, ()) for name, kind, span in sorted(settings, key=lambda one: one[2]))
    extent = Span(content.head.start, max([content.head.end, len(document.text.rstrip())]))
    return [Item(content.name, STUDY, content.head, extent, parts)]


def _item(definition: Definition, inner: dict[str, list[Definition]]) -> Item:
    parts = tuple(_item(part, inner) for part in inner.get(definition.symbol.path, []))
    # Editors require that an item's extent contains its name and its parts.
    spans = [definition.extent, definition.span, *(part.extent for part in parts)]
    extent = Span(min(span.start for span in spans), max(span.end for span in spans))
    return Item(definition.symbol.name, str(definition.kind), definition.span, extent, parts)
