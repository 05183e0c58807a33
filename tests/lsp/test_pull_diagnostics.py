"""Diagnostics of documents that are open and of files that are not: asked for, or published, never both."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import pytest
import pytest_lsp
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

from fork_kit import ROBBDD_LSP
from lsp_kit import CLIENTS, PATIENCE, Editor, begin_session
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.lsp.handlers import create_server

REQUEST_CANCELLED = -32800
SCENE = """ns env = 'https://example.org/env/'
obj set (ns=env) parts{number} {{ object bolt, object nut }}
scene (ns=env) bench{number} {{ obj set <parts{number}> }}
"""
USER = """import 'bench.scene'
ns acc = 'https://example.org/acc/'
const set (ns=acc) picked { <parts.bolt> }
"""
BROKEN = "obj set (ns=nowhere) parts { object bolt }\n"


def pulling() -> types.ClientCapabilities:
    """Capabilities of VS Code since its client pulls diagnostics."""
    found = client_capabilities("visual-studio-code")
    assert found.text_document is not None
    assert found.workspace is not None
    found.text_document.diagnostic = types.DiagnosticClientCapabilities(
        dynamic_registration=True, related_document_support=True
    )
    found.workspace.diagnostics = types.DiagnosticWorkspaceClientCapabilities(refresh_support=True)
    return found


# pytest-lsp leaves the types of its decorator open.
@pytest_lsp.fixture(  # pyright: ignore[reportUnknownMemberType]
    config=ClientServerConfig(server_command=[*ROBBDD_LSP, "--stdio"]),
)
async def puller(lsp_client: LanguageClient, tmp_path: Path, asked: list[str]) -> AsyncIterator[None]:
    await begin_session(lsp_client, tmp_path, pulling(), asked)
    yield
    await lsp_client.shutdown_session()


@pytest.fixture
def pull_editor(puller: LanguageClient, tmp_path: Path) -> Editor:
    return Editor(puller, tmp_path)


async def pull(editor: Editor, previous: str | None = None) -> Any:
    params = types.DocumentDiagnosticParams(
        text_document=types.TextDocumentIdentifier(uri=editor.uri), previous_result_id=previous
    )
    return await editor.client.text_document_diagnostic_async(params)


async def workspace(client: LanguageClient, known: dict[str, str] | None = None) -> dict[str, Any]:
    """The reports about all files, by URI."""
    previous = [types.PreviousResultId(uri=uri, value=value) for uri, value in (known or {}).items()]
    async with asyncio.timeout(PATIENCE):
        answer = await client.workspace_diagnostic_async(types.WorkspaceDiagnosticParams(previous_result_ids=previous))
    return {report.uri: report for report in answer.items}


def codes(report: Any) -> list[str]:
    return [str(entry.code) for entry in report.items]


async def until(done: Callable[[], bool]) -> None:
    async with asyncio.timeout(PATIENCE):
        while not done():
            await asyncio.sleep(0.02)


async def test_a_document_is_asked_for_and_told_again_only_when_something_has_changed(pull_editor: Editor) -> None:
    editor = pull_editor
    editor.open(editor.text.replace("template: <pick-place>", "template: <pick-plaice>"))
    first = await pull(editor)
    assert (first.kind, codes(first)) == ("full", ["unknown-name"])
    again = await pull(editor, first.result_id)
    assert (again.kind, again.result_id) == ("unchanged", first.result_id)
    editor.change("ns ", "\nns ")
    moved = await pull(editor, first.result_id)
    assert moved.kind == "full"
    assert moved.items[0].range.start.line == first.items[0].range.start.line + 1
    assert editor.client.diagnostics == {}


async def test_findings_that_come_later_make_the_client_ask_again(pull_editor: Editor, asked: list[str]) -> None:
    pull_editor.open(pull_editor.text.replace("    task: <pick-place-task>\n", ""))
    while "shacl-scenario-task" not in codes(await pull(pull_editor)):
        await until(lambda: types.WORKSPACE_DIAGNOSTIC_REFRESH in asked)
        asked.clear()
    assert pull_editor.client.diagnostics == {}


async def test_files_that_are_not_open_are_told_and_again_when_they_change(pull_editor: Editor, tmp_path: Path) -> None:
    path = tmp_path / "other.scene"
    path.write_text(BROKEN, encoding="utf-8")
    client, uri = pull_editor.client, path_to_uri(path)
    first = await workspace(client)
    assert codes(first[uri]) == ["unknown-name"]
    assert codes(first[pull_editor.uri]) == []
    # A remark, that its scene runs on models of the catalog, waits until the file is opened.
    assert codes(first[path_to_uri(pull_editor.path.parent / "bench.scene")]) == []
    known = {name: report.result_id for name, report in first.items()}

    waiting = asyncio.ensure_future(workspace(client, known))
    path.write_text("", encoding="utf-8")
    change = types.FileEvent(uri=uri, type=types.FileChangeType.Changed)
    client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=[change]))
    assert {name: codes(report) for name, report in (await waiting).items()} == {uri: []}


async def test_unsaved_text_counts_for_files_that_build_on_it(pull_editor: Editor, tmp_path: Path) -> None:
    scene = tmp_path / "bench.scene"
    scene.write_text(SCENE.format(number=""), encoding="utf-8")
    user = tmp_path / "user.bdd"
    user.write_text(USER, encoding="utf-8")
    client = pull_editor.client
    first = await workspace(client)
    assert "unknown-name" not in codes(first[path_to_uri(user)])
    known = {name: report.result_id for name, report in first.items() if name != path_to_uri(scene)}
    text = SCENE.format(number="").replace("bolt", "screw")
    item = types.TextDocumentItem(uri=path_to_uri(scene), language_id="scene", version=1, text=text)
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
    told = await workspace(client, known)
    assert list(told) == [path_to_uri(user)]
    assert "unknown-name" in codes(told[path_to_uri(user)])


async def test_what_only_an_importer_may_use_is_not_called_unused_in_a_file_that_is_not_open(
    pull_editor: Editor,
) -> None:
    values = "var <pick-place.robot>: agn set <arms>"
    text = pull_editor.text.replace("    var robot\n", "    var robot\n    var spare\n")
    text = text.replace(values, f"{values}\n                var <pick-place.spare>: {{ 1, 2 }}")
    pull_editor.path.write_text(text, encoding="utf-8")
    client, execution = pull_editor.client, pull_editor.path.with_suffix(".bddx")
    first = await workspace(client)
    assert codes(first[pull_editor.uri]) == []

    async def now(kind: types.FileChangeType) -> list[str]:
        """The reports on the closed file after a change of its importer."""
        change = types.FileEvent(uri=path_to_uri(execution), type=kind)
        client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=[change]))
        told = dict[str, Any]()
        while pull_editor.uri not in told:
            told = await workspace(client, {uri: report.result_id for uri, report in first.items()})
            first.update(told)
        return codes(told[pull_editor.uri])

    importer = execution.read_text(encoding="utf-8")
    execution.unlink()
    assert await now(types.FileChangeType.Deleted) == ["unused-variable"]
    execution.write_text(importer, encoding="utf-8")
    assert await now(types.FileChangeType.Created) == []


async def test_a_cancelled_question_about_the_workspace_is_answered(pull_editor: Editor) -> None:
    known = {name: report.result_id for name, report in (await workspace(pull_editor.client)).items()}
    previous = [types.PreviousResultId(uri=uri, value=value) for uri, value in known.items()]
    protocol = pull_editor.client.protocol
    params = types.WorkspaceDiagnosticParams(previous_result_ids=previous)
    held = asyncio.ensure_future(protocol.send_request_async(types.WORKSPACE_DIAGNOSTIC, params, msg_id="held"))
    await pull(pull_editor)
    assert not held.done()
    protocol.notify(types.CANCEL_REQUEST, types.CancelParams(id="held"))
    with pytest.raises(JsonRpcException) as caught:
        await held
    assert caught.value.code == REQUEST_CANCELLED


@CLIENTS
async def test_clients_that_do_not_ask_are_told_of_files_that_are_not_open(
    client: LanguageClient, tmp_path: Path
) -> None:
    path = tmp_path / "other.scene"
    uri = path_to_uri(path)
    path.write_text(BROKEN, encoding="utf-8")
    await until(lambda: uri in client.diagnostics)
    path.write_text("", encoding="utf-8")
    change = types.FileEvent(uri=uri, type=types.FileChangeType.Changed)
    client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=[change]))
    await until(lambda: not client.diagnostics[uri])


@pytest.mark.parametrize("count", [200, pytest.param(1000, marks=pytest.mark.nightly)])
async def test_a_project_of_many_files_is_reported_while_documents_are_answered(
    pull_editor: Editor, tmp_path: Path, count: int
) -> None:
    folder = tmp_path / "many"
    folder.mkdir()
    for number in range(count):
        name = "bolt" if number % 100 else "no bolt"
        text = SCENE.format(number=number).replace("bolt", name)
        (folder / f"bench{number}.scene").write_text(text, encoding="utf-8")
    reported: dict[str, list[str]] = {}

    def hear(params: Any) -> None:
        for report in params.value["items"]:
            reported[report["uri"]] = [entry["code"] for entry in report["items"]]

    pull_editor.client.protocol.fm.features[types.PROGRESS] = hear  # pyright: ignore[reportUnknownMemberType]
    params = types.WorkspaceDiagnosticParams(previous_result_ids=[], partial_result_token="many")
    whole = asyncio.ensure_future(pull_editor.client.workspace_diagnostic_async(params))
    pull_editor.open()
    while not whole.done():
        assert codes(await pull(pull_editor)) == []
        await asyncio.wait([whole], timeout=0.5)
    assert list((await whole).items) == []
    faulty = [uri for uri, found in reported.items() if "syntax" in found]
    assert (len([uri for uri in reported if "/many/" in uri]), len(faulty)) == (count, count // 100)


async def test_what_is_found_in_a_document_that_is_closed_meanwhile_is_not_published(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    server, sent = create_server(), list[int | None]()
    uri = "file:///folder/one.bdd"

    async def closing(_: str) -> tuple[int, list[types.Diagnostic]]:
        await server.text_closed(uri)
        return 1, []

    def validate(_: object) -> None:
        """Begin no process."""

    def send(_: str, version: int | None, __: object) -> None:
        sent.append(version)

    monkeypatch.setattr(server.validator, "request", validate)
    await server.text_changed(uri, 1, "")
    monkeypatch.setattr(server, "send", send)
    monkeypatch.setattr(server, "diagnostics", closing)
    server.show_results([uri])
    await server.show_changed()
    server.stop()
    assert set(sent) == {None}
