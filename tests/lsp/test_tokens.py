"""Semantic tokens over the wire."""

from __future__ import annotations

from lsprotocol import types

from lsp_kit import CLIENTS, Editor
from robbdd_tools.lsp.tokens import LEGEND


def words(editor: Editor, data: list[int]) -> list[tuple[str, str]]:
    """Decode tokens into their words and types."""
    lines = editor.text.split("\n")
    line = column = 0
    found: list[tuple[str, str]] = []
    for at in range(0, len(data), 5):
        down, right, length, kind, _ = data[at : at + 5]
        line, column = line + down, right if down else column + right
        found.append((lines[line][column : column + length], LEGEND.token_types[kind]))
    return found


@CLIENTS
async def test_tokens_are_sent_whole_in_part_and_as_a_difference(editor: Editor) -> None:
    editor.open()
    document = types.TextDocumentIdentifier(uri=editor.uri)
    whole = await editor.client.text_document_semantic_tokens_full_async(
        types.SemanticTokensParams(text_document=document)
    )
    assert whole is not None
    assert whole.result_id is not None
    assert ("evt-pick-start", "event") in words(editor, list(whole.data))

    line = editor.position("var robot")
    range = types.Range(start=line, end=types.Position(line=line.line, character=99))
    part = await editor.client.text_document_semantic_tokens_range_async(
        types.SemanticTokensRangeParams(text_document=document, range=range)
    )
    assert part is not None
    assert words(editor, list(part.data)) == [("var", "keyword"), ("robot", "variable")]

    editor.change("at-source: holds", "at-its-source: holds")
    change = await editor.client.text_document_semantic_tokens_full_delta_async(
        types.SemanticTokensDeltaParams(text_document=document, previous_result_id=whole.result_id)
    )
    assert isinstance(change, types.SemanticTokensDelta)
    data = list(whole.data)
    for edit in change.edits:
        data[edit.start : edit.start + edit.delete_count] = edit.data or []
        assert len(edit.data or ()) < 10
    assert ("at-its-source", "property") in words(editor, data)
