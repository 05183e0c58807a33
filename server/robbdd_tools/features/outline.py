"""Document outline of a file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span

if TYPE_CHECKING:
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
    inner: dict[str, list[Definition]] = {}
    for path, definition in analysis.definitions.items():
        inner.setdefault(path.rpartition(".")[0], []).append(definition)
    return [_item(definition, inner) for definition in inner.get("", [])]


def _item(definition: Definition, inner: dict[str, list[Definition]]) -> Item:
    parts = tuple(_item(part, inner) for part in inner.get(definition.symbol.path, []))
    # Editors require that an item's extent contains its name and its parts.
    spans = [definition.extent, definition.span, *(part.extent for part in parts)]
    extent = Span(min(span.start for span in spans), max(span.end for span in spans))
    return Item(definition.symbol.name, str(definition.kind), definition.span, extent, parts)
