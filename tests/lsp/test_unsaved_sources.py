"""Unsaved Python, MJCF and URDF files count for the models that name them; no other file of the user is asked for."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient, client_capabilities, make_test_lsp_client

from fork_kit import ROBBDD_LSP
from kit import EXAMPLES
from lsp_kit import PATIENCE, Editor, plain
from robbdd_tools.base.files import path_to_uri

SYNCHRONIZED = (types.TEXT_DOCUMENT_DID_OPEN, types.TEXT_DOCUMENT_DID_CHANGE, types.TEXT_DOCUMENT_DID_CLOSE)
FOLLOWED = ("no-evaluator", "unusable-model", "scene-unchecked")


class Cell:
    """A window on the example with its own behaviour and arm. ``follows`` are the files that it was asked for."""

    def __init__(self, client: LanguageClient, folder: Path) -> None:
        self.client = client
        self.folder = shutil.copytree(EXAMPLES / "ownrobot", folder / "own [robot]")
        self.follows: dict[str, set[str]] = {}

    def open(self, name: str) -> Editor:
        editor = Editor(self.client, self.folder, name)
        editor.open()
        return editor

    def register(self, params: types.RegistrationParams) -> None:
        for entry in params.registrations:
            if entry.method in SYNCHRONIZED:
                [selected] = plain(entry.register_options)["documentSelector"]
                assert selected["scheme"] == "file"
                self.follows.setdefault(selected["pattern"].rpartition("/")[2], set()).add(entry.id)

    def unregister(self, params: types.UnregistrationParams) -> None:
        ended = {entry.id for entry in params.unregisterations}
        self.follows = {name: left for name, ids in self.follows.items() if (left := ids - ended)}

    async def until_followed(self, *names: str) -> None:
        async with asyncio.timeout(PATIENCE):
            while {name for name, ids in self.follows.items() if len(ids) == len(SYNCHRONIZED)} != set(names):
                await asyncio.sleep(0.02)

    async def until_published(self, name: str, *messages: str) -> None:
        """Wait until exactly these findings about names of other files are published for a file."""
        uri = path_to_uri(self.folder / name)
        async with asyncio.timeout(PATIENCE):
            while True:
                found = self.client.diagnostics.get(uri, [])
                named = [one for one in found if str(one.code) in ("python-source", "model-name", "model-file")]
                reported = [one.message for one in named]
                if len(reported) == len(messages) and all(map(str.startswith, sorted(reported), sorted(messages))):
                    return
                await asyncio.sleep(0.02)

    async def until_reported(self, name: str, *codes: str) -> None:
        """Wait until exactly these findings about scenes and texts are published for a file."""
        uri = path_to_uri(self.folder / name)
        async with asyncio.timeout(PATIENCE):
            while True:
                found = [str(one.code) for one in self.client.diagnostics.get(uri, [])]
                if uri in self.client.diagnostics and [one for one in found if one in FOLLOWED] == list(codes):
                    return
                await asyncio.sleep(0.02)


@pytest.fixture
async def cell(tmp_path: Path, request: pytest.FixtureRequest) -> AsyncIterator[Cell]:
    client: Any = make_test_lsp_client()
    await client.start_io(*ROBBDD_LSP, "--stdio")
    opened = Cell(client, tmp_path)
    client.protocol.fm.features[types.CLIENT_REGISTER_CAPABILITY] = opened.register
    client.protocol.fm.features[types.CLIENT_UNREGISTER_CAPABILITY] = opened.unregister
    capabilities = client_capabilities("neovim")
    assert capabilities.text_document is not None
    able = getattr(request, "param", True)
    capabilities.text_document.synchronization = types.TextDocumentSyncClientCapabilities(dynamic_registration=able)
    folders = [types.WorkspaceFolder(uri=path_to_uri(tmp_path), name="test")]
    await client.initialize_session(types.InitializeParams(capabilities=capabilities, workspace_folders=folders))
    yield opened
    await client.shutdown_session()


async def test_the_unsaved_text_of_python_code_counts_for_the_model_that_names_it(cell: Cell) -> None:
    cell.open("tidy.bddx")
    code = cell.open("carrying.py")
    code.change("class Carry:", "class Carrying:")
    await cell.until_published("tidy.bddx", "the module 'carrying' has no 'Carry'; did you mean 'Carrying'?")
    code.change("class Carrying:", "class Carry:")
    await cell.until_published("tidy.bddx")


async def test_a_syntax_error_of_unsaved_code_is_named_with_its_line(cell: Cell) -> None:
    cell.open("tidy.bddx")
    code = cell.open("carrying.py")
    code.change("class Carry:", "class Carry")
    await cell.until_published("tidy.bddx", "the module 'carrying' cannot be imported: ")


async def test_the_file_counts_again_when_its_text_is_closed(cell: Cell) -> None:
    cell.open("tidy.bddx")
    code = cell.open("carrying.py")
    code.change("class Carry:", "class Carrying:")
    await cell.until_published("tidy.bddx", "the module 'carrying' has no 'Carry'")
    document = types.TextDocumentIdentifier(uri=code.uri)
    cell.client.text_document_did_close(types.DidCloseTextDocumentParams(text_document=document))
    await cell.until_published("tidy.bddx")


async def test_the_unsaved_text_of_an_arm_counts_and_leads_to_its_place(cell: Cell) -> None:
    scene = cell.open("cell.scenex")
    arm = cell.open("five.xml")
    arm.change('<site name="tcp"', '\n\n<site name="tip"')
    await cell.until_published("cell.scenex", "the model's file has no site or body 'tcp'; did you mean 'tip'?")
    scene.change('tool: "tcp"', 'tool: "tip"')
    await cell.until_published("cell.scenex")
    found = await cell.client.text_document_definition_async(types.DefinitionParams(**scene.at('"tip', after=True)))
    assert isinstance(found, list)
    [place] = found
    assert isinstance(place, types.Location)
    assert (place.uri, place.range.start) == (arm.uri, arm.position("tip"))


async def test_the_scene_is_drawn_and_checked_with_the_unsaved_texts_of_its_models(cell: Cell) -> None:
    (cell.folder / "hand.xml").write_text("<mujoco><worldbody/></mujoco>\n", encoding="utf-8")
    main = cell.folder / "five.xml"
    text = main.read_text(encoding="utf-8").replace("<worldbody>", '<include file="hand.xml"/><worldbody>', 1)
    main.write_text(text, encoding="utf-8")
    scene, hand = cell.open("cell.scenex"), cell.open("hand.xml")

    async def drawn() -> Any:
        (found,) = plain(await cell.client.protocol.send_request_async("robbdd/scene", {"uri": scene.uri}))["scenes"]
        return [one["reason"] for one in found["faults"]], len(found["shapes"])

    faults, shapes = await drawn()
    assert faults == []
    hand.change("<worldbody/>", '<worldbody><body name="more"><geom size="0.1"/></body></worldbody>')
    assert await drawn() == ([], shapes + 1)
    hand.change('size="0.1"', 'size="-1"')
    ((reason,), _) = await drawn()
    assert "size" in reason
    await cell.until_reported("cell.scenex", "unusable-model")
    hand.change('size="-1"', 'size="0.1"')
    await cell.until_reported("cell.scenex")


async def test_unsaved_steps_judge_the_texts_of_a_model_and_of_its_templates(cell: Cell) -> None:
    steps = cell.folder / "steps"
    steps.mkdir()
    code = "from behave import then\n\n\n@then('the bench is {state} {time}')\ndef clean(context, state, time): ...\n"
    (steps / "more_steps.py").write_text(code, encoding="utf-8")
    template = (cell.folder / "tidy.bdd").read_text(encoding="utf-8")
    (cell.folder / "more.bdd").write_text('import "tidy.bdd"\n', encoding="utf-8")
    model = cell.open("tidy.bdd")
    cell.open("more.bdd")
    mark = "    Then:\n"
    assert mark in template
    model.change(mark, f'{mark}        "the bench is clean" after <evt-end>\n')
    await cell.until_reported("tidy.bdd")
    own = cell.open("steps/more_steps.py")
    own.change("the bench", "the lathe")
    await cell.until_reported("tidy.bdd", "no-evaluator")
    own.change("the lathe", "the bench")
    await cell.until_reported("tidy.bdd")


async def test_unopened_models_are_checked_with_unsaved_code(cell: Cell) -> None:
    await cell.until_published("tidy.bddx")
    code = cell.open("carrying.py")
    code.change("class Carry:", "class Carrying:")
    await cell.until_published("tidy.bddx", "the module 'carrying' has no 'Carry'")


async def test_requests_about_such_a_file_have_empty_answers(cell: Cell) -> None:
    code = cell.open("carrying.py")
    document = types.TextDocumentIdentifier(uri=code.uri)
    assert await cell.client.text_document_hover_async(types.HoverParams(**code.at("class Carry", after=True))) is None
    tokens = await cell.client.text_document_semantic_tokens_full_async(types.SemanticTokensParams(document))
    assert tokens is None or list(tokens.data) == []
    assert not await cell.client.text_document_code_lens_async(types.CodeLensParams(document))
    assert not await cell.client.text_document_document_symbol_async(types.DocumentSymbolParams(document))


async def test_exactly_the_named_files_are_asked_for(cell: Cell) -> None:
    (cell.folder / "other.py").write_text("class Carry: ...\n", encoding="utf-8")
    (cell.folder / "other.xml").write_text("<note/>\n", encoding="utf-8")
    await cell.until_followed("carrying.py", "five.xml")
    model = cell.open("tidy.bddx")
    model.change("module: carrying", "module: other")
    await cell.until_followed("other.py", "five.xml")


async def test_an_included_file_is_asked_for_as_soon_as_it_is_named(cell: Cell) -> None:
    (cell.folder / "hand.xml").write_text(
        '<mujoco><worldbody><site name="tip"/></worldbody></mujoco>\n', encoding="utf-8"
    )
    scene = cell.open("cell.scenex")
    arm = cell.open("five.xml")
    await cell.until_followed("carrying.py", "five.xml")
    arm.change("<worldbody>", '<include file="hand.xml"/><worldbody>')
    await cell.until_followed("carrying.py", "five.xml", "hand.xml")
    scene.change('tool: "tcp"', 'tool: "tip"')
    await cell.until_published("cell.scenex")


async def test_the_characters_of_a_path_are_no_pattern(cell: Cell) -> None:
    patterns: list[str] = []
    register = cell.register

    def keep(params: types.RegistrationParams) -> None:
        register(params)
        patterns.extend(
            plain(entry.register_options)["documentSelector"][0]["pattern"]
            for entry in params.registrations
            if entry.method in SYNCHRONIZED
        )

    cell.client.protocol.fm.features[types.CLIENT_REGISTER_CAPABILITY] = keep  # pyright: ignore[reportUnknownMemberType] -- as above
    await cell.until_followed("carrying.py", "five.xml")
    assert all("/own [[]robot[]]/" in pattern for pattern in patterns)


@pytest.mark.parametrize("cell", [False], indirect=True)
async def test_other_clients_are_not_asked_and_learn_of_saved_files(cell: Cell) -> None:
    cell.open("tidy.bddx")
    await cell.until_published("tidy.bddx")
    path = cell.folder / "carrying.py"
    path.write_text(path.read_text(encoding="utf-8").replace("class Carry:", "class Carrying:"), encoding="utf-8")
    event = types.FileEvent(uri=path_to_uri(path), type=types.FileChangeType.Changed)
    cell.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=[event]))
    await cell.until_published("tidy.bddx", "the module 'carrying' has no 'Carry'")
    assert cell.follows == {}
