"""Workspace folders added and removed, external file changes, and refresh requests to the client."""

from __future__ import annotations

import asyncio
import shutil
from pathlib import Path

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from kit import EXAMPLES
from lsp_kit import CLIENTS, PATIENCE, Editor
from robbdd_tools.base.files import path_to_uri, uri_to_path

SAFETY = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
<urn:named> a sh:NodeShape ; sh:targetClass bdd:ScenarioTemplate ; sh:property [
    sh:path bdd:owned-by ; sh:minCount 1 ; sh:message "the template has no owner" ] .
"""
REFRESHES = {types.WORKSPACE_SEMANTIC_TOKENS_REFRESH, types.WORKSPACE_CODE_LENS_REFRESH}


async def until_asked(asked: list[str], method: str, count: int = 1) -> None:
    async with asyncio.timeout(PATIENCE):
        while asked.count(method) < count:
            await asyncio.sleep(0.02)


def change_folders(client: LanguageClient, added: list[Path], removed: list[Path]) -> None:
    def folders(paths: list[Path]) -> list[types.WorkspaceFolder]:
        return [types.WorkspaceFolder(uri=path_to_uri(path), name=path.name) for path in paths]

    event = types.WorkspaceFoldersChangeEvent(added=folders(added), removed=folders(removed))
    client.workspace_did_change_workspace_folders(types.DidChangeWorkspaceFoldersParams(event=event))


@CLIENTS
async def test_a_folder_that_is_added_has_settings_of_its_own_until_it_is_removed(
    client: LanguageClient, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("second")
    shutil.copytree(EXAMPLES / "pickplace", folder / "pickplace")
    (folder / "owner.ttl").write_text(SAFETY, encoding="utf-8")
    client.set_configuration({"robbdd": {"shapes": ["owner.ttl"]}}, scope_uri=path_to_uri(folder))
    editor = Editor(client, folder)
    editor.open()
    await editor.diagnostics()
    change_folders(client, [folder], [])
    (found,) = await editor.diagnostics("shape-owner")
    assert found.message == "the template has no owner"
    change_folders(client, [], [folder])
    await editor.diagnostics()


@CLIENTS
async def test_settings_that_a_client_sends_count_in_folders_that_come_later(
    client: LanguageClient, editor: Editor, tmp_path: Path
) -> None:
    (tmp_path / "owner.ttl").write_text(SAFETY, encoding="utf-8")
    settings = {"robbdd": {"shapes": ["owner.ttl"]}}
    client.set_configuration(settings)
    client.set_configuration(settings, scope_uri=path_to_uri(tmp_path))
    client.workspace_did_change_configuration(types.DidChangeConfigurationParams(settings=settings))
    editor.open()
    await editor.diagnostics("shape-owner")


@pytest.mark.usefixtures("client")
async def test_a_client_that_can_be_asked_is_asked_to_tell_of_settings_and_files(asked: list[str]) -> None:
    await until_asked(asked, types.CLIENT_REGISTER_CAPABILITY, 2)


async def test_a_change_in_one_file_makes_the_client_ask_again_about_others(editor: Editor, asked: list[str]) -> None:
    editor.open()
    await editor.diagnostics()
    asked.clear()
    open_scene(editor)
    for method in REFRESHES:
        await until_asked(asked, method)


@pytest.mark.parametrize("stored", ["runs/1/results.json", "studies/pickplace/x.study/study.sqlite"])
async def test_a_run_or_study_that_is_stored_makes_the_client_ask_for_lenses_alone(
    editor: Editor, asked: list[str], stored: str
) -> None:
    editor.open()
    await editor.diagnostics()
    await until_asked(asked, types.WORKSPACE_CODE_LENS_REFRESH)
    asked.clear()
    change = types.FileEvent(
        uri=path_to_uri(editor.path.parent / ".robbdd" / stored), type=types.FileChangeType.Created
    )
    editor.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=[change]))
    await until_asked(asked, types.WORKSPACE_CODE_LENS_REFRESH)
    assert types.WORKSPACE_SEMANTIC_TOKENS_REFRESH not in asked


@pytest.mark.parametrize("client", ["emacs"], indirect=True)
async def test_a_client_that_knows_no_refresh_is_not_asked(editor: Editor, asked: list[str]) -> None:
    editor.open()
    open_scene(editor)
    editor.change("<places.left_ws>", "<places.lost_ws>")
    await editor.diagnostics("unknown-name")
    assert REFRESHES.isdisjoint(asked)


async def test_a_diagnostic_links_to_the_page_about_its_code(editor: Editor) -> None:
    editor.open(editor.text.replace("template: <pick-place>", "template: <pick-plaice>"))
    (found,) = await editor.diagnostics("unknown-name")
    assert found.code_description is not None
    page = uri_to_path(found.code_description.href)
    assert page is not None
    assert page.read_text(encoding="utf-8").startswith("# `unknown-name`")


def open_scene(editor: Editor) -> None:
    path = editor.path.parent / "bench.scene"
    text = path.read_text(encoding="utf-8")
    item = types.TextDocumentItem(uri=path_to_uri(path), language_id="scene", version=1, text=text)
    editor.client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
