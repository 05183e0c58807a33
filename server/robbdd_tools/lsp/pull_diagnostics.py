"""Pull diagnostics of a document and of the whole workspace.

They are used only if the server can ask the client to pull again (``workspace/diagnostic/refresh``), because findings
of shapes and results of runs arrive later than the text. For all other clients, diagnostics are published.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lsprotocol import types

from robbdd_tools.lsp.refresh import DIAGNOSTICS, is_refreshed
from robbdd_tools.lsp.workspace_diagnostics import NOTHING, Findings, WorkspaceDiagnostics

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer


def can_pull(client: types.ClientCapabilities) -> bool:
    """Return whether a client pulls diagnostics, and pulls them again when the server asks for it."""
    asks = client.text_document is not None and client.text_document.diagnostic is not None
    return asks and is_refreshed(client, DIAGNOSTICS)


def register_pull(server: RobbddServer) -> None:
    """Register pull diagnostics with the client."""
    server.pulls = True
    options = types.DiagnosticOptions(inter_file_dependencies=True, workspace_diagnostics=False, identifier="robbdd")

    @server.feature(types.TEXT_DOCUMENT_DIAGNOSTIC, options)
    async def of_document(ls: RobbddServer, params: types.DocumentDiagnosticParams) -> types.DocumentDiagnosticReport:
        _, found = await ls.diagnostics(params.text_document.uri)
        return _report(found, params.previous_result_id)

    @server.feature(types.WORKSPACE_DIAGNOSTIC)
    async def of_workspace(
        ls: RobbddServer, params: types.WorkspaceDiagnosticParams
    ) -> types.WorkspaceDiagnosticReport:
        """Return the files whose diagnostics have changed. If there are none, wait for a change."""
        known = {entry.uri: entry.value for entry in params.previous_result_ids}
        is_first, published = not known, False
        while True:
            changes = _changes(ls.survey, known)
            if changes and params.partial_result_token is not None:
                part = types.WorkspaceDiagnosticReportPartialResult(items=changes)
                ls.protocol.notify(types.PROGRESS, types.ProgressParams(params.partial_result_token, part))
                known |= {change.uri: change.result_id or "" for change in changes}
                changes, published = [], True
            if ls.survey.is_settled and (changes or published or is_first):
                return types.WorkspaceDiagnosticReport(items=changes)
            await ls.survey.wait_for_news()


def _report(found: list[types.Diagnostic], previous: str | None) -> types.DocumentDiagnosticReport:
    now = Findings.of(found).id
    if now == previous:
        return types.RelatedUnchangedDocumentDiagnosticReport(result_id=now)
    return types.RelatedFullDocumentDiagnosticReport(items=found, result_id=now)


def _changes(
    survey: WorkspaceDiagnostics, known: Mapping[str, str]
) -> list[types.WorkspaceFullDocumentDiagnosticReport]:
    """Return the files whose diagnostics differ from those that the client has."""
    findings = survey.findings()
    gone = {uri: NOTHING for uri in known if uri not in findings}
    return [
        types.WorkspaceFullDocumentDiagnosticReport(uri=uri, items=found.diagnostics, result_id=found.id)
        for uri, found in (findings | gone).items()
        if known.get(uri) != found.id
    ]
