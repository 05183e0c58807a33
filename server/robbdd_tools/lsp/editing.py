"""The protocol's methods that change a text: formatting."""

from __future__ import annotations

from lsprotocol import types

from robbdd_tools.base.document import Span
from robbdd_tools.features.layout import lay_out
from robbdd_tools.lsp.convert import document_of
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.names.project import Snapshot


def register_editing(server: RobbddServer) -> None:
    """Add the methods to a server."""
    _register_formatting(server)


def _register_formatting(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def formatting(ls: RobbddServer, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        def find(snapshot: Snapshot) -> list[types.TextEdit]:
            document = document_of(snapshot, params.text_document.uri)
            laid_out = lay_out(document.text)
            if laid_out == document.text:
                return []
            whole = ls.convert.range(document, Span(0, len(document.text)))
            return [types.TextEdit(range=whole, new_text=laid_out)]

        return await ls.analyse(find)
