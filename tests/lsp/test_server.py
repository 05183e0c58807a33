"""The server as a client sees it: a real process over standard input and output."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from lsprotocol import types

from lsp_kit import CLIENTS, PATIENCE, Editor
from robbdd_tools.lsp.handlers import create_server


@CLIENTS
async def test_a_sound_example_has_no_diagnostic_and_an_error_comes_and_goes(editor: Editor) -> None:
    editor.open()
    await editor.diagnostics()
    editor.change("template: <pick-place>", "template: <pick-plaice>")
    (found,) = await editor.diagnostics("unknown-name")
    assert "did you mean 'pick-place'" in found.message
    assert found.range.start == editor.position("pick-plaice")
    editor.change("<pick-plaice>", "<pick-place>")
    await editor.diagnostics()


async def test_shapes_are_reported_where_the_text_causes_them(editor: Editor) -> None:
    editor.open()
    await editor.diagnostics()
    editor.change("    task: <pick-place-task>\n", "")
    (found,) = [entry for entry in await _until_shape(editor) if str(entry.code).startswith("shacl-")]
    assert found.severity is types.DiagnosticSeverity.Warning
    assert found.code == "shacl-scenario-task"


async def _until_shape(editor: Editor) -> list[types.Diagnostic]:
    async with asyncio.timeout(PATIENCE):
        while True:
            found = list(editor.client.diagnostics.get(editor.uri, []))
            if any(str(entry.code).startswith("shacl-") for entry in found):
                return found
            await asyncio.sleep(0.02)


@CLIENTS
async def test_completion_and_definition_across_files(editor: Editor) -> None:
    editor.open()
    editor.change("agn set <arms>", "agn set <ar")
    params = types.CompletionParams(**editor.at("agn set <ar", after=True))
    items = await editor.client.text_document_completion_async(params)
    assert isinstance(items, list)
    assert [item.label for item in items] == ["arms"]
    where = types.DefinitionParams(**editor.at("cubes.cube0", after=True))
    found = await editor.client.text_document_definition_async(where)
    assert isinstance(found, list | tuple)
    (place,) = found
    assert isinstance(place, types.Location)
    assert place.uri.endswith("bench.scene")


async def test_a_rename_reaches_the_imported_scene(editor: Editor) -> None:
    editor.open()
    where = editor.at("<places.left_ws>", after=True)
    where["position"].character -= 2
    prepared = await editor.client.text_document_prepare_rename_async(types.PrepareRenameParams(**where))
    assert prepared is not None
    params = types.RenameParams(**where, new_name="near_ws")
    answer = await editor.client.text_document_rename_async(params)
    assert answer is not None
    assert answer.changes is not None
    edited = {uri.rsplit("/", 1)[-1]: len(edits) for uri, edits in answer.changes.items()}
    assert edited == {"pickplace.bdd": 1, "bench.scene": 2}


async def test_the_outline_and_folds_of_a_document(editor: Editor) -> None:
    editor.open()
    document = types.TextDocumentIdentifier(uri=editor.uri)
    symbols = await editor.client.text_document_document_symbol_async(
        types.DocumentSymbolParams(text_document=document)
    )
    assert symbols is not None
    assert [symbol.name for symbol in symbols][-2:] == ["pick-place", "tidy-bench"]
    found = await editor.client.text_document_folding_range_async(types.FoldingRangeParams(text_document=document))
    assert found


async def test_a_document_is_laid_out(editor: Editor) -> None:
    editor.open(editor.text.replace("    var thing", "  var   thing"))
    document = types.TextDocumentIdentifier(uri=editor.uri)
    options = types.FormattingOptions(tab_size=4, insert_spaces=True)
    params = types.DocumentFormattingParams(text_document=document, options=options)
    edits = await editor.client.text_document_formatting_async(params) or []
    assert [edit.new_text for edit in edits] == ["    var thing"]


async def test_the_quick_fix_mends_a_misspelt_name(editor: Editor) -> None:
    editor.open(editor.text.replace("template: <pick-place>", "template: <pick-plaice>"))
    (found,) = await editor.diagnostics("unknown-name")
    context = types.CodeActionContext(diagnostics=[found], only=[types.CodeActionKind.QuickFix])
    document = types.TextDocumentIdentifier(uri=editor.uri)
    params = types.CodeActionParams(text_document=document, range=found.range, context=context)
    actions = await editor.client.text_document_code_action_async(params) or []
    assert [action.title for action in actions] == ["Change to 'pick-place'"]


async def test_the_types_of_variables_stand_behind_them(editor: Editor) -> None:
    editor.open()
    hints = await editor.client.text_document_inlay_hint_async(
        types.InlayHintParams(text_document=types.TextDocumentIdentifier(uri=editor.uri), range=editor.everything())
    )
    shown = {editor.text.split("\n")[hint.position.line].strip(): str(hint.label) for hint in hints or []}
    assert shown == {
        "var thing": ": object",
        "var robot": ": agent",
        "var source": ": workspace",
        "var goal": ": workspace",
        "Scenario part-to-bin {": "4 scenarios",
    }


async def test_what_is_unused_is_shown_faded(editor: Editor) -> None:
    editor.open(editor.text.replace("Event (ns=crit) evt-end\n", "Event (ns=crit) evt-end\nEvent (ns=crit) spare\n"))
    (found,) = await editor.diagnostics("unused-event")
    assert list(found.tags or ()) == [types.DiagnosticTag.Unnecessary]
    assert found.severity is types.DiagnosticSeverity.Hint


async def test_gherkin_is_written_beside_the_model(editor: Editor) -> None:
    editor.open()
    params = types.ExecuteCommandParams(command="robbdd.gherkin", arguments=[{"uri": editor.uri}])
    answer: Any = await editor.client.workspace_execute_command_async(params)
    assert [file.rsplit("/", 3)[1:] for file in answer["files"]] == [["pickplace", "features", "tidy-bench.feature"]]
    assert (editor.path.parent / "features" / "tidy-bench.feature").is_file()


@pytest.mark.parametrize("text", ["", "\0\1\2", "}" * 50, '"', "Scenario Template", "import 'gone.bdd'\n" * 3])
async def test_any_text_is_answered(editor: Editor, text: str) -> None:
    editor.open(text)
    params = types.CompletionParams(
        text_document=types.TextDocumentIdentifier(uri=editor.uri), position=types.Position(line=0, character=0)
    )
    await editor.client.text_document_completion_async(params)
    async with asyncio.timeout(PATIENCE):
        while editor.uri not in editor.client.diagnostics:
            await asyncio.sleep(0.02)


def test_messages_hold_no_links_and_no_control_characters(monkeypatch: pytest.MonkeyPatch) -> None:
    server = create_server()
    sent: list[types.ShowMessageParams] = []
    monkeypatch.setattr(server, "window_show_message", sent.append)
    try:
        server.warn("no scenario [here](command:y)\x1b[2J")
    finally:
        server.stop()
    assert [one.message for one in sent] == ["no scenario [here]\u200b(command:y)\\x1b[2J"]
