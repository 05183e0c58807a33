"""The texts of the open documents, as the client has them.

They replace the texts of pygls, for two reasons. Unlike the protocol, pygls ends lines at form feeds and at Unicode's
line separators, so that later edits would change the wrong place. And pygls takes several milliseconds for a change of
a long text.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from robbdd_tools.base.document import Document

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robbdd_tools.lsp.convert import Converter


class OpenTexts:
    """The text of each open document."""

    def __init__(self) -> None:
        self._documents: dict[str, Document] = {}

    def open(self, uri: str, text: str) -> None:
        """Take the text of a document that the client opens."""
        self._documents[uri] = Document(uri, 0, text)

    def change(self, convert: Converter, uri: str, changes: Iterable[types.TextDocumentContentChangeEvent]) -> None:
        """Apply changes to a document in the given order. A change without a range is a whole text."""
        for change in changes:
            text = change.text
            if isinstance(change, types.TextDocumentContentChangePartial):
                before = self._documents.get(uri) or Document(uri, 0, "")
                span = convert.span(before, change.range)
                text = before.text[: span.start] + text + before.text[span.end :]
            self.open(uri, text)

    def text(self, uri: str) -> str:
        """Return the text of a document; empty if it is not open."""
        found = self._documents.get(uri)
        return "" if found is None else found.text

    def close(self, uri: str) -> None:
        """Drop the text of a document that the client closes."""
        self._documents.pop(uri, None)
