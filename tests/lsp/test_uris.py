"""Clients write the URI of a file in different ways; for the server it is one file."""

from __future__ import annotations

from pathlib import Path

from lsprotocol import types
from pytest_lsp import LanguageClient

from kit import MODEL, SCENE
from lsp_kit import Editor
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.lsp.protocol import with_canonical_uris

ESCAPED, PLAIN = "file:///a/%28b%29/main.bdd", "file:///a/(b)/main.bdd"


def test_every_uri_of_a_message_is_canonical_but_no_text_is_changed() -> None:
    document = {"uri": PLAIN, "version": 1, "text": PLAIN}
    message = {"id": 1, "params": {"textDocument": document, "arguments": [PLAIN, None, 1.5]}}
    document = {"uri": ESCAPED, "version": 1, "text": PLAIN}
    assert with_canonical_uris(message) == {
        "id": 1,
        "params": {"textDocument": document, "arguments": [ESCAPED, None, 1.5]},
    }


async def test_a_file_that_is_open_by_another_spelling_is_the_one_that_others_import(
    client: LanguageClient, editor: Editor, tmp_path: Path
) -> None:
    folder = tmp_path / "cell (1)"
    folder.mkdir()
    (folder / "lab.scene").write_text("", encoding="utf-8")
    (folder / "main.bdd").write_text(MODEL, encoding="utf-8")
    scene, main = path_to_uri(folder / "lab.scene"), path_to_uri(folder / "main.bdd")
    plainly = scene.replace("%28", "(").replace("%29", ")")
    assert plainly != scene
    item = types.TextDocumentItem(uri=plainly, language_id="robbdd-scene", version=1, text=SCENE)
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
    editor.uri = main
    editor.open(MODEL)
    assert await _definition(client, editor) == [scene]
    assert await editor.diagnostics() == []


async def test_two_names_of_one_file_are_one_file_and_the_one_that_is_open_is_answered(
    client: LanguageClient, editor: Editor, tmp_path: Path
) -> None:
    # Where case matters, two names of one file stand in for a file system that ignores case.
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "Lab.scene").hardlink_to(tmp_path / "lab.scene")
    (tmp_path / "main.bdd").write_text(MODEL, encoding="utf-8")
    opened, other = path_to_uri(tmp_path / "Lab.scene"), path_to_uri(tmp_path / "lab.scene")
    editor.uri = path_to_uri(tmp_path / "main.bdd")
    editor.open(MODEL)
    assert await _definition(client, editor) == [other]
    text = f"\n\n{SCENE}"
    item = types.TextDocumentItem(uri=opened, language_id="robbdd-scene", version=1, text=text)
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
    assert await _definition(client, editor) == [opened]
    asked = types.DocumentSymbolParams(text_document=types.TextDocumentIdentifier(uri=other))
    first = (await client.text_document_document_symbol_async(asked) or [])[0]
    assert isinstance(first, types.DocumentSymbol)
    assert first.range.start.line == 2


async def _definition(client: LanguageClient, editor: Editor) -> list[str]:
    found = await client.text_document_definition_async(types.DefinitionParams(**editor.at("arms.panda")))
    assert isinstance(found, list)
    return [place.uri for place in found if isinstance(place, types.Location)]
