"""Protocol methods that help to read and write a text: completion, hover and inlay hints."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any, cast

from lsprotocol import types

from robbdd_tools.base.document import Span
from robbdd_tools.features.clause_results import appearance, clause_hints, row_hints
from robbdd_tools.features.completion import complete
from robbdd_tools.features.describe_entry import describe_entry
from robbdd_tools.features.hover import Hover, hover
from robbdd_tools.features.policy_results import policy_hints
from robbdd_tools.features.scenario_hints import ScenarioHint, scenario_hints
from robbdd_tools.features.type_hints import type_hints
from robbdd_tools.lsp.convert import document_of, markup
from robbdd_tools.lsp.parameters import Parameters
from robbdd_tools.lsp.result_hover import history_line, pictures_of, replay_link
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.names.project import Snapshot
from robbdd_tools.run.database import DatabaseProblem

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document

VERDICTS = "robbdd/verdicts"
"""Request for the hints with verdicts of a whole document, for clients that draw them themselves."""
STILL_READING = "*(so far: files that may use it are still being read)*"


def register_assistance(server: RobbddServer) -> None:
    """Add the methods to a server."""
    _register_completion(server)
    _register_hover(server)
    _register_hints(server)


def _register_completion(server: RobbddServer) -> None:
    options = types.CompletionOptions(trigger_characters=["<", ".", '"', "'", "/", " "], resolve_provider=True)

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, options)
    async def completion(ls: RobbddServer, params: types.CompletionParams) -> list[types.CompletionItem]:
        def find(snapshot: Snapshot) -> list[types.CompletionItem]:
            document = document_of(snapshot, params.text_document.uri)
            offset = ls.convert.offset(document, params.position)
            client = ls.client_capabilities.text_document
            abilities = client.completion.completion_item if client and client.completion else None
            return [
                item
                for entry in complete(snapshot, document.uri, offset, ls.importers.elsewhere)
                if (item := ls.convert.completion(document, entry, abilities)) is not None
            ]

        return await ls.analyse(find)

    @server.feature(types.COMPLETION_ITEM_RESOLVE)
    async def resolve(ls: RobbddServer, item: types.CompletionItem) -> types.CompletionItem:
        data = cast("dict[str, Any]", item.data or {})

        kind, uri, path = (str(data.get(name, "")) for name in ("kind", "uri", "path"))
        found = await ls.analyse(lambda snapshot: describe_entry(snapshot, kind, uri, path))
        if found is not None:
            client = ls.client_capabilities.text_document
            abilities = client.completion.completion_item if client and client.completion else None
            item.documentation = markup(found, abilities.documentation_format if abilities else None)
        return item


def _register_hover(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def show_hover(ls: RobbddServer, params: types.HoverParams) -> types.Hover | None:
        def find(snapshot: Snapshot) -> tuple[Hover, types.Range] | None:
            document = document_of(snapshot, params.text_document.uri)
            found = hover(
                snapshot,
                document.uri,
                ls.convert.offset(document, params.position),
                ls.findings_of(snapshot, document.uri),
            )
            return None if found is None else (found, ls.convert.range(document, found.span))

        is_whole = await ls.importers.are_there(params.text_document.uri, params.position)
        answer = await ls.analyse(find)
        if answer is None:
            return None
        found, place = answer
        markdown = found.markdown if is_whole else f"{found.markdown}\n\n{STILL_READING}"
        if found.judged is not None:
            link = replay_link(found.judged) if ls.shows_replays else ""
            pictures = await asyncio.to_thread(pictures_of, ls.stores, found.judged) if ls.shows_pictures else ""
            # Keep hovers short: the most important content comes directly below the title.
            title, _, rest = markdown.partition("\n\n")
            title = " · ".join(filter(None, (title, link)))
            history = await asyncio.to_thread(history_line, ls.stores, found.judged, link=ls.shows_history)
            markdown = "\n\n".join(filter(None, (title, pictures, rest, history)))
        client = ls.client_capabilities.text_document
        formats = client.hover.content_format if client is not None and client.hover is not None else None
        return types.Hover(contents=markup(markdown, formats), range=place)


def _register_hints(server: RobbddServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    async def inlay_hint(ls: RobbddServer, params: types.InlayHintParams) -> list[types.InlayHint]:
        def find(snapshot: Snapshot) -> list[types.InlayHint]:
            document = document_of(snapshot, params.text_document.uri)
            wanted = ls.convert.span(document, params.range)
            return (
                _verdicts(ls, snapshot, document, wanted)
                + [
                    types.InlayHint(
                        position=ls.convert.position(document, hint.span.end),
                        label=hint.label,
                        kind=types.InlayHintKind.Type,
                    )
                    for hint in type_hints(snapshot, document.uri, wanted)
                ]
                + [_scenario_hint(ls, document, hint) for hint in scenario_hints(snapshot, document.uri, wanted)]
            )

        return await ls.analyse(find)

    @server.feature(VERDICTS)
    async def verdicts(ls: RobbddServer, params: Any) -> list[types.InlayHint]:
        uri = Parameters(params).text("uri")

        def find(snapshot: Snapshot) -> list[types.InlayHint]:
            document = document_of(snapshot, uri)
            return _verdicts(ls, snapshot, document, Span(0, len(document.text)))

        return await ls.analyse(find)


def _verdicts(ls: RobbddServer, snapshot: Snapshot, document: Document, wanted: Span) -> list[types.InlayHint]:
    """Return the hints with the verdicts on the clauses, rows and policies that end in a part of a document."""
    findings = ls.findings_of(snapshot, document.uri)
    return [
        types.InlayHint(
            position=ls.convert.position(document, hint.head.end),
            label=hint.label,
            tooltip=hint.tooltip,
            padding_left=True,
            data=appearance(hint),
        )
        for find_hints in (clause_hints, row_hints, policy_hints)
        for hint in find_hints(snapshot, document.uri, findings)
        if wanted.contains(hint.head.end)
    ]


def _scenario_hint(ls: RobbddServer, document: Document, hint: ScenarioHint) -> types.InlayHint:
    """Return the hint with the number of scenarios and, if executing them takes a minute or longer, with the time."""
    label, tooltip = hint.label, None
    with suppress(DatabaseProblem):
        expected = None if hint.variant is None else ls.stores.estimate(document.uri, {hint.variant: hint.count})
        if expected is not None and expected.is_large:
            label, tooltip = f"{label}, about {expected.duration}", expected.basis
    return types.InlayHint(
        position=ls.convert.position(document, hint.span.end),
        label=label,
        tooltip=tooltip,
        kind=types.InlayHintKind.Parameter,
        padding_left=True,
    )
