"""The methods of the protocol. Each one converts its parameters, calls a feature and converts the result."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

from lsprotocol import types

from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.features.fixes_on_demand import fixes_on_demand
from robbdd_tools.lsp.assistance import register_assistance
from robbdd_tools.lsp.client_settings import follow_settings, register_settings
from robbdd_tools.lsp.commands import register_commands, step_fixes
from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.definitions import register_definitions
from robbdd_tools.lsp.editing import edit_of, refactorings, register_editing
from robbdd_tools.lsp.followed_studies import FollowedStudies
from robbdd_tools.lsp.graph_picture import register_graph
from robbdd_tools.lsp.lenses import register_lenses, source_actions
from robbdd_tools.lsp.navigation import register_navigation
from robbdd_tools.lsp.preview import register_preview
from robbdd_tools.lsp.projects import register_projects
from robbdd_tools.lsp.pull_diagnostics import can_pull, register_pull
from robbdd_tools.lsp.reported_words import report_words
from robbdd_tools.lsp.run_history import register_run_history
from robbdd_tools.lsp.scene_preview import register_scene
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.lsp.source_documents import is_source
from robbdd_tools.lsp.stored_runs import register_stored_runs
from robbdd_tools.lsp.study_request import register_study_results
from robbdd_tools.lsp.test_results import register_test_results
from robbdd_tools.lsp.test_tree import register_tests
from robbdd_tools.lsp.tokens import register_tokens
from robbdd_tools.lsp.transport import end_after_loop
from robbdd_tools.lsp.trust import forbid_user_code
from robbdd_tools.lsp.user_errors import register_user_errors
from robbdd_tools.lsp.versions import register_versions
from robbdd_tools.lsp.watching import register_watching, watch_files
from robbdd_tools.names.project import Snapshot


def create_server() -> RobbddServer:
    """Return a server with all its methods registered."""
    server = RobbddServer()
    _register_documents(server)
    register_assistance(server)
    register_editing(server)
    _register_actions(server)
    register_commands(server)
    register_lenses(server)
    register_settings(server)
    register_watching(server)
    register_user_errors(server)
    register_navigation(server)
    register_tokens(server)
    register_definitions(server)
    register_preview(server)
    register_graph(server)
    register_scene(server)
    register_stored_runs(server)
    register_run_history(server)
    register_study_results(server)
    register_projects(server)
    register_tests(server)
    register_test_results(server)
    register_versions(server)
    return server


def _register_documents(server: RobbddServer) -> None:
    @server.feature(types.INITIALIZE)
    def initialize(ls: RobbddServer, params: types.InitializeParams) -> None:
        wanted = params.initialization_options
        able = cast("dict[str, object]", wanted) if isinstance(wanted, dict) else {}
        ls.shows_pictures = able.get("pictures") is True
        ls.shows_replays = able.get("replay") is True
        ls.debugs_scenarios = able.get("debugging") is True
        ls.runs_studies = able.get("studies") is True
        ls.shows_history = able.get("history") is True
        ls.trusted = able.get("trusted") is not False
        if not ls.trusted:
            forbid_user_code()
        ls.spawn(end_after_loop(ls.exit_code))
        # All methods registered so far are announced to the client.
        if can_pull(params.capabilities):
            register_pull(ls)

    @server.feature(types.INITIALIZED)
    async def initialized(ls: RobbddServer, _: types.InitializedParams) -> None:
        ls.convert = Converter.of(ls.workspace.position_encoding, ls.client_capabilities)
        general = ls.client_capabilities.general
        stale = general.stale_request_support if general is not None else None
        ls.requests.repeated = frozenset(stale.retry_on_content_modified if stale is not None else ())
        ls.spawn(watch_files(ls))
        ls.spawn(follow_settings(ls))
        ls.spawn(report_words(ls))
        ls.spawn(FollowedStudies(ls).follow())
        ls.survey.schedule()
        await ls.stored_verdicts.load()

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    async def did_open(ls: RobbddServer, params: types.DidOpenTextDocumentParams) -> None:
        document = params.text_document
        if is_source(document.uri):
            await ls.sources.edited(document.uri, document.text)
        else:
            await ls.text_changed(document.uri, document.version, document.text)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    async def did_change(ls: RobbddServer, params: types.DidChangeTextDocumentParams) -> None:
        document = params.text_document
        # pygls declares the base class of the protocol only.
        protocol: Any = ls.protocol
        text = protocol.texts.text(document.uri)
        if is_source(document.uri):
            await ls.sources.edited(document.uri, text)
        else:
            await ls.text_changed(document.uri, document.version, text)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    async def did_close(ls: RobbddServer, params: types.DidCloseTextDocumentParams) -> None:
        uri = params.text_document.uri
        await (ls.sources.closed(uri) if is_source(uri) else ls.text_closed(uri))

    @server.feature(types.SHUTDOWN)
    def shutdown(ls: RobbddServer, _: None) -> None:
        ls.stop()


def _register_actions(server: RobbddServer) -> None:
    kinds = [types.CodeActionKind.QuickFix, types.CodeActionKind.Refactor, types.CodeActionKind.Source]

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(code_action_kinds=kinds))
    async def code_action(ls: RobbddServer, params: types.CodeActionParams) -> list[types.CodeAction]:
        def find(snapshot: Snapshot) -> list[types.CodeAction]:
            uri = params.text_document.uri
            only = params.context.only
            actions: list[types.CodeAction] = []
            if _asked(only, types.CodeActionKind.QuickFix):
                actions += _quick_fixes(ls, snapshot, params)
                actions += step_fixes(ls, snapshot, params)
            selected = ls.convert.span(document_of(snapshot, uri), params.range)
            found = refactorings(ls, snapshot, uri, selected)
            actions += (action for action in found if not only or any(_is(action.kind, kind) for kind in only))
            if _asked(only, types.CodeActionKind.Source):
                actions += source_actions(snapshot, uri, selected, ls.findings_of(snapshot, uri))
            return actions

        await ls.importers.looked_around()
        return await ls.analyse(find)


def _asked(only: Sequence[types.CodeActionKind | str] | None, kind: types.CodeActionKind) -> bool:
    return not only or any(_is(kind, wanted) for wanted in only)


def _is(kind: types.CodeActionKind | str | None, wanted: types.CodeActionKind | str) -> bool:
    """Return whether a kind of code action is the wanted kind or one of its sub-kinds."""
    return f"{_value(kind)}.".startswith(f"{_value(wanted)}.")


def _value(kind: types.CodeActionKind | str | None) -> str:
    return kind.value if isinstance(kind, types.CodeActionKind) else kind or ""


def _quick_fixes(ls: RobbddServer, snapshot: Snapshot, params: types.CodeActionParams) -> list[types.CodeAction]:
    uri = params.text_document.uri
    span = ls.convert.span(document_of(snapshot, uri), params.range)
    found: list[types.CodeAction] = []
    for diagnostic in fast_diagnostics(snapshot, uri):
        if diagnostic.span.start > span.end or diagnostic.span.end < span.start:
            continue
        fixes = (*diagnostic.fixes, *fixes_on_demand(snapshot, uri, diagnostic, ls.importers.elsewhere))
        shown = ls.convert.diagnostic(snapshot, diagnostic)
        edits = ((fix.title, edit) for fix in fixes if (edit := edit_of(ls, snapshot, fix)) is not None)
        for position, (title, edit) in enumerate(edits):
            kind = types.CodeActionKind.QuickFix
            is_first = position == 0
            action = types.CodeAction(title=title, kind=kind, diagnostics=[shown], edit=edit, is_preferred=is_first)
            found.append(action)
    return found
