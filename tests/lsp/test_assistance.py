"""Completion with its documentation, and hover, over the wire."""

from __future__ import annotations

from lsprotocol import types

from lsp_kit import CLIENTS, Editor


async def completions(editor: Editor, behind: str) -> dict[str, types.CompletionItem]:
    params = types.CompletionParams(**editor.at(behind, after=True))
    items = await editor.client.text_document_completion_async(params)
    assert isinstance(items, list)
    return {item.label: item for item in items}


@CLIENTS
async def test_a_completion_is_documented_when_it_is_resolved(editor: Editor) -> None:
    editor.open()
    editor.change("before <evt-pick-start>", "before <evt-p")
    found = await completions(editor, "before <evt-p")
    assert {"evt-pick-start", "evt-place-end"} <= set(found)
    assert found["evt-pick-start"].documentation is None
    item = await editor.client.completion_item_resolve_async(found["evt-pick-start"])
    assert isinstance(item.documentation, types.MarkupContent)
    assert item.documentation.value.replace("*", "").replace("`", "").startswith("event evt-pick-start")


async def test_a_snippet_and_an_import_come_with_their_edits(editor: Editor) -> None:
    (editor.path.parent / "more.scene").write_text("ns m = 'http://m/'\nscene (ns=m) spare_scene { }\n")
    editor.open(editor.text.replace("scene: <bench_scene>", "scene: <spare") + "\nScen")
    item = (await completions(editor, "scene: <spare"))["spare_scene"]
    assert [edit.new_text for edit in item.additional_text_edits or ()] == ['\nimport "more.scene"']
    snippet = (await completions(editor, "\nScen"))["Scenario Template …"]
    assert snippet.insert_text_format is types.InsertTextFormat.Snippet


@CLIENTS
async def test_hover_explains_the_name_under_the_cursor(editor: Editor) -> None:
    editor.open()
    found = await editor.client.text_document_hover_async(types.HoverParams(**editor.at("Scenario part-to", True)))
    assert found is not None
    assert isinstance(found.contents, types.MarkupContent)
    assert "4 scenarios (2 × 1 × 1 × 2)" in found.contents.value
