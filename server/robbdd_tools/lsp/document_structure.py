"""Write the outline, the folds and the highlights of a document as JSON text."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robbdd_tools.base.checkpoint import checkpoint
from robbdd_tools.lsp.convert import symbol_kind
from robbdd_tools.lsp.json_text import JsonText, Passages, joined, with_children

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.features.folding import Fold
    from robbdd_tools.features.outline import Item, OutlinePiece
    from robbdd_tools.features.references import Highlight
    from robbdd_tools.lsp.convert import Converter


class OutlineWriter:
    """Writes outlines. The text of an unchanged declaration is kept."""

    def __init__(self, serialise: Callable[[Any], str]) -> None:
        self._serialise = serialise
        self._passages = Passages(serialise)

    def text(self, convert: Converter, document: Document, pieces: Iterable[OutlinePiece]) -> JsonText:
        """Return the document symbols of the pieces of an outline."""
        return JsonText(f"[{self._joined(convert, document, pieces)}]")

    def _joined(self, convert: Converter, document: Document, pieces: Iterable[OutlinePiece], start: int = 0) -> str:
        return joined([self._piece(convert, document, piece, start + piece.offset) for piece in pieces])

    def _piece(self, convert: Converter, document: Document, piece: OutlinePiece, start: int) -> str:
        checkpoint()

        def symbols(where: Document, offset: int) -> Sequence[types.DocumentSymbol]:
            return [document_symbol(convert, where, item.shifted(offset)) for item in piece.items]

        if piece.declaration is None:
            return joined(map(self._serialise, symbols(document, start)))
        own = self._passages.text(convert, document, (start, piece.declaration), symbols)
        return with_children(own, self._joined(convert, document, piece.inner, start)) if piece.inner else own


def document_symbol(convert: Converter, document: Document, item: Item) -> types.DocumentSymbol:
    """Return an item of an outline, with absolute spans, in the client's form."""
    return types.DocumentSymbol(
        name=item.name,
        detail=item.kind,
        kind=symbol_kind(item.kind),
        range=convert.range(document, item.extent),
        selection_range=convert.range(document, item.span),
        children=[document_symbol(convert, document, part) for part in item.children],
    )


def folds_text(folds: Iterable[Fold]) -> JsonText:
    """Return the folding ranges of a document."""
    return JsonText(f"[{joined(map(_FOLD.__mod__, folds))}]")


_FOLD = '{"startLine": %d, "endLine": %d, "kind": "%s"}'


def highlights_text(convert: Converter, document: Document, found: Iterable[Highlight]) -> JsonText:
    """Return the highlights of a name in a document."""
    is_ascii, starts = document.text.isascii(), document.line_starts

    def place(offset: int) -> tuple[int, int]:
        if is_ascii:
            # A character takes one unit in every encoding.
            line = bisect_right(starts, offset) - 1
            return line, offset - starts[line]
        position = convert.position(document, offset)
        return position.line, position.character

    written = (_HIGHLIGHT % (*place(one.start), *place(one.end), _WRITTEN if one.writes else _READ) for one in found)
    return JsonText(f"[{joined(written)}]")


_HIGHLIGHT = '{"range": {"start": {"line": %d, "character": %d}, "end": {"line": %d, "character": %d}}, "kind": %d}'
_READ, _WRITTEN = types.DocumentHighlightKind.Read.value, types.DocumentHighlightKind.Write.value
