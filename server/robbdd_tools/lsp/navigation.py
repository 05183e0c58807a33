"""Protocol methods for navigation: references, rename, outline, folding."""

from __future__ import annotations

from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams

from robbdd_tools.features.folding import folds
from robbdd_tools.features.outline import outline_pieces
from robbdd_tools.features.outside_names import outside_references
from robbdd_tools.features.references import highlights, references
from robbdd_tools.features.rename import RenameRefused, prepare_rename, rename
from robbdd_tools.features.workspace_symbols import workspace_symbols
from robbdd_tools.lsp.analysis_thread import Urgency
from robbdd_tools.lsp.convert import document_of, symbol_kind
from robbdd_tools.lsp.document_structure import OutlineWriter, folds_text, highlights_text
from robbdd_tools.lsp.json_text import JsonText
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.names.project import Snapshot


def register_navigation(server: RobbddServer) -> None:
    """Add the methods to a server."""
    _register_uses(server)
    _register_structure(server)


def _register_uses(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def find_references(ls: RobbddServer, params: types.ReferenceParams) -> list[types.Location]:
        def find(snapshot: Snapshot) -> list[types.Location]:
            document = document_of(snapshot, params.text_document.uri)
            offset = ls.convert.offset(document, params.position)
            found = references(snapshot, document.uri, offset, params.context.include_declaration)
            places = [ls.convert.location(snapshot, uri, span) for uri, span in found]
            return places or _outside(ls, snapshot, document.uri, offset, params.context.include_declaration)

        return await ls.importers.analyse(params.text_document.uri, params.position, find)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    async def highlight(ls: RobbddServer, params: types.DocumentHighlightParams) -> JsonText:
        def find(snapshot: Snapshot) -> JsonText:
            document = document_of(snapshot, params.text_document.uri)
            found = highlights(snapshot, document.uri, ls.convert.offset(document, params.position))
            return highlights_text(ls.convert, document, found)

        return await ls.analyse(find)

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def prepare(ls: RobbddServer, params: types.PrepareRenameParams) -> types.Range | None:
        def find(snapshot: Snapshot) -> types.Range | None:
            document = document_of(snapshot, params.text_document.uri)
            span = prepare_rename(snapshot, document.uri, ls.convert.offset(document, params.position))
            return None if span is None else ls.convert.range(document, span)

        return await ls.analyse(find)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def give_name(ls: RobbddServer, params: types.RenameParams) -> types.WorkspaceEdit:
        def find(snapshot: Snapshot) -> types.WorkspaceEdit:
            document = document_of(snapshot, params.text_document.uri)
            offset = ls.convert.offset(document, params.position)
            return ls.convert.workspace_edit(snapshot, rename(snapshot, document.uri, offset, params.new_name))

        try:
            return await ls.importers.analyse(params.text_document.uri, params.position, find)
        except RenameRefused as refused:
            raise JsonRpcInvalidParams(str(refused)) from refused


def _outside(
    ls: RobbddServer, snapshot: Snapshot, uri: str, offset: int, with_declaration: bool
) -> list[types.Location]:
    """Return the uses of Python code, or of a part of a model file."""
    found, place = outside_references(snapshot, uri, offset)
    places = [ls.convert.location(snapshot, other, span) for other, span in found]
    if place is not None and with_declaration:
        places.append(types.Location(uri=place.uri, range=ls.convert.range(place.document, place.span)))
    return places


def _register_structure(server: RobbddServer) -> None:
    # pygls declares the base class of the protocol only.
    protocol: Any = server.protocol
    writer = OutlineWriter(protocol.serialised)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def symbols(ls: RobbddServer, params: types.DocumentSymbolParams) -> JsonText:
        uri = params.text_document.uri
        return await ls.analyse(
            lambda snapshot: writer.text(ls.convert, document_of(snapshot, uri), outline_pieces(snapshot, uri))
        )

    @server.feature(types.WORKSPACE_SYMBOL)
    async def names(ls: RobbddServer, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        roots = list(ls.workspace.folders)

        def find(snapshot: Snapshot) -> list[types.WorkspaceSymbol]:
            return [
                types.WorkspaceSymbol(
                    name=found.path,
                    kind=symbol_kind(found.kind),
                    location=types.Location(uri=found.document.uri, range=ls.convert.range(found.document, found.span)),
                )
                for found in workspace_symbols(snapshot, roots, params.query)
            ]

        # Reads unopened files: other requests go first.
        return await ls.analyse(find, Urgency.LATER)

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    async def folding(ls: RobbddServer, params: types.FoldingRangeParams) -> JsonText:
        return folds_text(await ls.analyse(lambda snapshot: folds(snapshot, params.text_document.uri)))
