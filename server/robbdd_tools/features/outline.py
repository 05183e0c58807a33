"""Document outline of a file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.studies import is_study
from robbdd_tools.syntax.study_text import STUDY, read_study

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Item:
    """A declared name with the names that are declared inside it.

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
    return [_item(definition, inner) for definition in inner.get("", [])]


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
