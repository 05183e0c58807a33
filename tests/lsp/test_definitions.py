"""Navigation from one place to another, over the wire."""

from __future__ import annotations

from pathlib import Path

from lsprotocol import types
from pytest_lsp import LanguageClient

from lsp_kit import CLIENTS, Editor


@CLIENTS
async def test_the_call_hierarchy_goes_from_the_story_to_the_behaviour(editor: Editor) -> None:
    editor.open()
    where = types.CallHierarchyPrepareParams(**editor.at("(ns=crit) tidy", after=True))
    items = await editor.client.text_document_prepare_call_hierarchy_async(where)
    names: list[str] = []
    while items:
        names.append(items[0].name)
        calls = await editor.client.call_hierarchy_outgoing_calls_async(
            types.CallHierarchyOutgoingCallsParams(item=items[0])
        )
        items = [call.to for call in calls or ()]
    assert names == ["tidy-bench", "part-to-bin", "pick-place", "carry"]


@CLIENTS
async def test_types_implementations_links_and_selections_are_answered(editor: Editor) -> None:
    editor.open()
    client = editor.client
    at_clause = editor.at("in-hand", after=True)
    found = await client.text_document_implementation_async(types.ImplementationParams(**at_clause))
    assert isinstance(found, list | tuple)
    assert [location.uri.rsplit("/", 1)[-1] for location in found if isinstance(location, types.Location)] == [
        "held_by.py"
    ]
    at_variant = editor.at("Scenario part-to", after=True)
    kinds = await client.text_document_type_definition_async(types.TypeDefinitionParams(**at_variant))
    assert isinstance(kinds, list | tuple)
    assert [place.range.start for place in kinds if isinstance(place, types.Location)] == [
        editor.position("pick-place {")
    ]
    document = types.TextDocumentIdentifier(uri=editor.uri)
    links = await client.text_document_document_link_async(types.DocumentLinkParams(text_document=document))
    assert [str(link.target).rsplit("/", 1)[-1] for link in links or ()] == ["bench.scene"]
    grown = await client.text_document_selection_range_async(
        types.SelectionRangeParams(text_document=document, positions=[editor.position("evt-place-end>")])
    )
    assert grown is not None
    assert grown[0].parent is not None
    declared = await client.text_document_declaration_async(
        types.DeclarationParams(**editor.at("template: <pick", after=True))
    )
    assert isinstance(declared, list | tuple)
    (place,) = declared
    assert isinstance(place, types.Location)


@CLIENTS
async def test_highlights_tell_where_a_variable_is_written(editor: Editor) -> None:
    editor.open()
    where = types.DocumentHighlightParams(**editor.at("var thing", after=True))
    found = await editor.client.text_document_document_highlight_async(where)
    kinds = {place.range.start.line: place.kind for place in found or ()}
    read, write = types.DocumentHighlightKind.Read, types.DocumentHighlightKind.Write
    assert kinds[editor.position("var thing").line] == write
    assert kinds[editor.position("<thing> is").line] == read
    assert kinds[editor.position("<pick-place.thing>").line] == write


async def test_python_code_of_a_model_is_completed_described_and_opened(client: LanguageClient, tmp_path: Path) -> None:
    editor = Editor(client, tmp_path, "pickplace/pickplace.bddx")
    editor.open()
    where = editor.at("attr: apar", after=True)
    items = await client.text_document_completion_async(types.CompletionParams(**where))
    assert isinstance(items, list)
    assert "apart" in [item.label for item in items]
    hover = await client.text_document_hover_async(types.HoverParams(**where))
    assert hover is not None
    assert isinstance(hover.contents, types.MarkupContent)
    assert "def apart(" in hover.contents.value
    found = await client.text_document_definition_async(types.DefinitionParams(**where))
    assert isinstance(found, list | tuple)
    (place,) = found
    assert isinstance(place, types.Location)
    lines = (editor.path.parent / "policies.py").read_text(encoding="utf-8").split("\n")
    line = lines[place.range.start.line]
    assert line[place.range.start.character : place.range.end.character] == "apart"
    assert line.startswith("def apart(")
    context = types.ReferenceContext(include_declaration=True)
    uses = await client.text_document_references_async(types.ReferenceParams(context=context, **where))
    assert [use.uri.rsplit("/", 1)[-1] for use in uses or ()] == ["pickplace.bddx", "policies.py"]
