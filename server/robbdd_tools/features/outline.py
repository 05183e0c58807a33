"""Document outline of a file.

It is computed piece by piece. If an edit does not change a piece, the piece is only moved.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.features.studies import is_study
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.study_content import STUDY
from robbdd_tools.syntax.study_text import read_study

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.index import FileIndex
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration, Symbol

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

    ``span`` is the place of the name, and ``extent`` is the place of the whole declaration.
    """

    name: str
    kind: str
    span: Span
    extent: Span
    children: tuple[Item, ...]

    def shifted(self, offset: int) -> Item:
        """Return the item moved by ``offset`` code points."""
        children = tuple([child.shifted(offset) for child in self.children])
        return Item(self.name, self.kind, self.span.shifted(offset), self.extent.shifted(offset), children)


@dataclass(frozen=True, slots=True)
class OutlinePiece:
    """Some items of an outline, in text order. Their spans count from ``offset``.

    If ``declaration`` is given, the piece depends on it alone. ``inner`` are further children of the last item; their
    offsets count from ``offset``, too.
    """

    offset: int
    items: tuple[Item, ...]
    declaration: Declaration | None = None
    inner: tuple[OutlinePiece, ...] = ()

    def placed(self, start: int = 0) -> Iterator[Item]:
        """Yield the items at their places in the document."""
        offset = start + self.offset
        *others, last = (item.shifted(offset) for item in self.items)
        children = (*last.children, *(child for piece in self.inner for child in piece.placed(offset)))
        yield from others
        yield Item(last.name, last.kind, last.span, last.extent, children)


def outline(snapshot: Snapshot, uri: str) -> list[Item]:
    """Return the declared names of a file, nested like the declarations, in text order. All spans are absolute."""
    return [item for piece in outline_pieces(snapshot, uri) for item in piece.placed()]


def outline_pieces(snapshot: Snapshot, uri: str) -> list[OutlinePiece]:
    """Return the outline of a file piece by piece, in text order."""
    if snapshot.file(uri) is None:
        return []
    if is_study(uri):
        return _of_study(snapshot.document(uri))
    index = snapshot.scope(uri).own
    shared = _shared(index)
    together = _together(index, shared) if shared else {}
    found: list[OutlinePiece] = []
    for number, placed in enumerate(index.declarations):
        checkpoint()
        if number in shared:
            items = tuple(together.get(number, ()))
            found += [OutlinePiece(0, items)] if items else []
        else:
            items, inner = _own_pieces(placed.declaration)
            found += [OutlinePiece(placed.offset, items, placed.declaration, inner)] if items else []
    return found


def _of_study(document: Document) -> list[OutlinePiece]:
    """Return the study with its settings and factors."""
    content, _ = read_study(document)
    if not content.name:
        return []
    settings = [(name, name, span) for name, span in content.places.items()]
    for factor in content.factors:
        name, word = ("scene", factor.levels[0]) if factor.implementation is None else ("", factor.implementation)
        settings.append((name or word.text, "factor", word.span))
    settings += [(one.variable.text, "factor", one.variable.span) for one in content.ranges]
    parts = tuple(Item(name, kind, span, span, ()) for name, kind, span in sorted(settings, key=lambda one: one[2]))
    extent = Span(content.head.start, max([content.head.end, len(document.text.rstrip())]))
    return [OutlinePiece(0, (Item(content.name, STUDY, content.head, extent, parts),))]


def _shared(index: FileIndex) -> set[int]:
    """Return the numbers of the declarations whose items depend on other declarations.

    Such a declaration declares the same name as another one, or a name inside a name of another one.
    """
    entries = index.names.entries
    shared = _repeated(index)
    for number, placed in enumerate(index.declarations):
        outer = _outer_names(placed.declaration)
        if outer is None or outer - {""}:
            shared.add(number)
            shared.update(entry.declaration for path in outer or () for entry in entries.get(path, ()))
    return shared


def _repeated(index: FileIndex) -> set[int]:
    """Return the numbers of the declarations with a name that another one, or two of their scenarios, declare."""
    found: set[int] = set()
    for path in index.names.repeated:
        numbers = {entry.declaration for entry in index.names.entries[path]}
        for number in numbers:
            declaration = index.declarations[number].declaration
            parts = [part for part in declaration.parts if path in _paths(part.declaration)]
            if len(numbers) > 1 or len(parts) > 1:
                found.add(number)
    return found


@kept_with_key
def _paths(declaration: Declaration) -> frozenset[str]:
    return frozenset(symbol.path for symbol in declaration.symbols)


@kept_with_key
def _outer_names(declaration: Declaration) -> frozenset[str] | None:
    """Return the names of other declarations in which this one declares names; ``""`` is the file itself.

    The names in the scenarios of a story should be inside the story. If they are not, the result is ``None``.
    """
    if not declaration.parts:
        paths = _paths(declaration)
        return frozenset(outer for path in paths if (outer := _outer(path)) not in paths)
    head, *parts = (part.declaration for part in declaration.parts)
    story = _paths(head)
    inside = all((_outer_names(part) or frozenset()) <= story for part in parts)
    return _outer_names(head) if inside and len(head.symbols) == 1 else None


def _outer(path: str) -> str:
    return path.rpartition(".")[0]


def _together(index: FileIndex, shared: set[int]) -> dict[int, list[Item]]:
    """Return the items of some declarations together, by the number of the declaration.

    If a name is declared several times, only its first declaration is an item.
    """
    first: dict[str, Symbol] = {}
    numbers: dict[str, int] = {}
    for number in sorted(shared):
        placed = index.declarations[number]
        for symbol in placed.declaration.symbols:
            if symbol.path not in first:
                first[symbol.path] = _moved(symbol, placed.offset)
                numbers[symbol.path] = number
    items: dict[int, list[Item]] = {}
    for symbol, item in _nested(first.values(), frozenset([""])):
        placed = index.declarations[numbers[symbol.path]]
        items.setdefault(numbers[symbol.path], []).append(_with_elements(item, placed.declaration, placed.offset))
    return items


def _moved(symbol: Symbol, offset: int) -> Symbol:
    return replace(symbol, span=symbol.span.shifted(offset), extent=symbol.extent.shifted(offset))


@kept_with_key
def _own_pieces(declaration: Declaration) -> tuple[tuple[Item, ...], tuple[OutlinePiece, ...]]:
    """Return the items of a declaration, and the pieces of its scenarios. Their places count from its start."""
    if not declaration.parts:
        return _own_items(declaration), ()
    inner = tuple(
        OutlinePiece(part.offset, items, part.declaration)
        for part in declaration.parts[1:]
        if (items := _own_items(part.declaration))
    )
    symbol = declaration.symbols[0]
    # Numbers instead of spans: a story has thousands of scenarios.
    ends = [(piece.offset, item.extent) for piece in inner for item in (piece.items[0], piece.items[-1])]
    first = min([offset + extent.start for offset, extent in ends], default=symbol.extent.start)
    last = max([offset + extent.end for offset, extent in ends], default=symbol.extent.end)
    return (_item(symbol, (), [symbol.extent, symbol.span, Span(first, last)]),), inner


@kept_with_key
def _own_items(declaration: Declaration) -> tuple[Item, ...]:
    """Return the items of a declaration, or of a scenario of a story. Their spans count from its start."""
    first: dict[str, Symbol] = {}
    for symbol in declaration.symbols:
        first.setdefault(symbol.path, symbol)
    found = _nested(first.values(), _outer_names(declaration) or frozenset())
    return tuple(_with_elements(item, declaration, 0) for _, item in found)


def _with_elements(item: Item, declaration: Declaration, offset: int) -> Item:
    """Add to the item of a scene instance the elements that it models. Any other item is returned unchanged."""
    root = declaration.tree
    if not isinstance(root, tree.SceneInstance) or item.span != root.name.span.shifted(offset):
        return item
    modelled = [entry for entry in root.entries if isinstance(entry, tree.Modelled)]
    return replace(item, children=_grouped(item.children, modelled, offset)) if modelled else item


def _grouped(items: tuple[Item, ...], modelled: Sequence[tree.Modelled], offset: int) -> tuple[Item, ...]:
    """Return items in text order. Items inside a modelled element become children of the element."""
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


def _nested(symbols: Iterable[Symbol], outer: frozenset[str]) -> Iterator[tuple[Symbol, Item]]:
    """Yield the items of the names directly inside ``outer``, each with its symbol."""
    inner: dict[str, list[Symbol]] = {}
    for symbol in symbols:
        inner.setdefault(_outer(symbol.path), []).append(symbol)

    def item(symbol: Symbol) -> Item:
        parts = tuple(item(part) for part in inner.get(symbol.path, ()))
        return _item(symbol, parts, [symbol.extent, symbol.span, *(part.extent for part in parts)])

    for names in [inner.get(path, []) for path in sorted(outer)]:
        yield from ((symbol, item(symbol)) for symbol in names)


def _item(symbol: Symbol, parts: tuple[Item, ...], spans: Sequence[Span]) -> Item:
    # Editors require that an item's extent contains its name and its parts.
    extent = Span(min(span.start for span in spans), max(span.end for span in spans))
    return Item(symbol.name, str(symbol.kind), symbol.span, extent, parts)
