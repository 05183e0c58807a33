"""Protocol methods that go from one place to others: definition, implementation, call hierarchy and so on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from lsprotocol import types

from robbdd_tools.base.document import Document, Span
from robbdd_tools.features.call_hierarchy import Call, callable_at, calls_from, calls_to
from robbdd_tools.features.document_links import document_links
from robbdd_tools.features.goto_definition import definition
from robbdd_tools.features.implementation import implementation
from robbdd_tools.features.outside_names import outside_name_at
from robbdd_tools.features.selection_ranges import selections
from robbdd_tools.features.type_definition import type_definition
from robbdd_tools.lsp.convert import document_of, symbol_kind
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.names.definition import Definition
from robbdd_tools.names.project import Snapshot

Targets = Callable[[Snapshot, str, int], list[tuple[str, Span]]]


def register_definitions(server: RobbddServer) -> None:
    """Add the methods to a server."""
    _register_targets(server)
    _register_calls(server)
    _register_ranges(server)


def _register_targets(server: RobbddServer) -> None:
    for method in (types.TEXT_DOCUMENT_DEFINITION, types.TEXT_DOCUMENT_DECLARATION):
        _register_definition(server, method)
    _register_target(server, types.TEXT_DOCUMENT_TYPE_DEFINITION, type_definition)
    # Implementations may be in unopened files.
    _register_target(server, types.TEXT_DOCUMENT_IMPLEMENTATION, implementation, everywhere=True)


def _register_target(server: RobbddServer, method: str, targets: Targets, everywhere: bool = False) -> None:
    @server.feature(method)
    async def lead(ls: RobbddServer, params: types.TextDocumentPositionParams) -> list[types.Location]:
        def find(snapshot: Snapshot) -> list[types.Location]:
            document = document_of(snapshot, params.text_document.uri)
            found = targets(snapshot, document.uri, ls.convert.offset(document, params.position))
            return [ls.convert.location(snapshot, uri, span) for uri, span in found]

        if everywhere:
            return await ls.importers.analyse(params.text_document.uri, params.position, find)
        return await ls.analyse(find)


def _register_definition(server: RobbddServer, method: str) -> None:
    @server.feature(method)
    async def define(ls: RobbddServer, params: types.TextDocumentPositionParams) -> list[types.Location]:
        def find(snapshot: Snapshot) -> list[types.Location]:
            document = document_of(snapshot, params.text_document.uri)
            offset = ls.convert.offset(document, params.position)
            found = definition(snapshot, document.uri, offset)
            if found is not None:
                return [ls.convert.location(snapshot, *found)]
            named = outside_name_at(snapshot, document.uri, offset)
            place = None if named is None else named.definition()
            if place is None:
                return []
            return [types.Location(uri=place.uri, range=ls.convert.range(place.document, place.span))]

        return await ls.analyse(find)


def _register_calls(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY)
    async def prepare(ls: RobbddServer, params: types.CallHierarchyPrepareParams) -> list[types.CallHierarchyItem]:
        def find(snapshot: Snapshot) -> list[types.CallHierarchyItem]:
            document = document_of(snapshot, params.text_document.uri)
            found = callable_at(snapshot, document.uri, ls.convert.offset(document, params.position))
            return [] if found is None else [_item(ls, snapshot, found)]

        return await ls.analyse(find)

    @server.feature(types.CALL_HIERARCHY_OUTGOING_CALLS)
    async def outgoing(
        ls: RobbddServer, params: types.CallHierarchyOutgoingCallsParams
    ) -> list[types.CallHierarchyOutgoingCall]:
        def find(snapshot: Snapshot) -> list[types.CallHierarchyOutgoingCall]:
            user = _definition(snapshot, params.item)
            return [
                types.CallHierarchyOutgoingCall(
                    to=_item(ls, snapshot, call.other), from_ranges=_places(ls, snapshot, params.item.uri, call)
                )
                for call in (calls_from(snapshot, user) if user is not None else ())
            ]

        return await ls.analyse(find)

    @server.feature(types.CALL_HIERARCHY_INCOMING_CALLS)
    async def incoming(
        ls: RobbddServer, params: types.CallHierarchyIncomingCallsParams
    ) -> list[types.CallHierarchyIncomingCall]:
        def find(snapshot: Snapshot) -> list[types.CallHierarchyIncomingCall]:
            used = _definition(snapshot, params.item)
            return [
                types.CallHierarchyIncomingCall(
                    from_=_item(ls, snapshot, call.other), from_ranges=_places(ls, snapshot, call.other.uri, call)
                )
                for call in (calls_to(snapshot, used) if used is not None else ())
            ]

        await ls.importers.load([params.item.uri])
        return await ls.analyse(find)


def _register_ranges(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_SELECTION_RANGE)
    async def select(ls: RobbddServer, params: types.SelectionRangeParams) -> list[types.SelectionRange]:
        def find(snapshot: Snapshot) -> list[types.SelectionRange]:
            document = document_of(snapshot, params.text_document.uri)
            offsets = [ls.convert.offset(document, position) for position in params.positions]
            return [_nested(ls, document, selections(snapshot, document.uri, offset)) for offset in offsets]

        return await ls.analyse(find)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK)
    async def link(ls: RobbddServer, params: types.DocumentLinkParams) -> list[types.DocumentLink]:
        def find(snapshot: Snapshot) -> list[types.DocumentLink]:
            document = document_of(snapshot, params.text_document.uri)
            return [
                types.DocumentLink(range=ls.convert.range(document, found.span), target=found.target)
                for found in document_links(snapshot, document.uri)
            ]

        return await ls.analyse(find)


def _nested(ls: RobbddServer, document: Document, spans: list[Span]) -> types.SelectionRange:
    whole = types.SelectionRange(range=ls.convert.range(document, Span(0, len(document.text))))
    for span in reversed(spans[:-1]):
        whole = types.SelectionRange(range=ls.convert.range(document, span), parent=whole)
    return whole


def _item(ls: RobbddServer, snapshot: Snapshot, found: Definition) -> types.CallHierarchyItem:
    document = document_of(snapshot, found.uri)
    return types.CallHierarchyItem(
        name=found.symbol.name,
        detail=found.kind,
        kind=symbol_kind(found.kind),
        uri=found.uri,
        range=ls.convert.range(document, found.extent),
        selection_range=ls.convert.range(document, found.span),
        data={"path": found.symbol.path},
    )


def _definition(snapshot: Snapshot, item: types.CallHierarchyItem) -> Definition | None:
    file = snapshot.file(item.uri)
    data = cast("dict[str, Any]", item.data or {})
    return None if file is None else file.definitions.get(str(data.get("path")))


def _places(ls: RobbddServer, snapshot: Snapshot, uri: str, call: Call) -> list[types.Range]:
    document = document_of(snapshot, uri)
    return [ls.convert.range(document, span) for span in call.spans]
