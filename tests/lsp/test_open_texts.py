"""The server has the same text as the client after any edits, whatever letters are in it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types

from lsp_kit import Editor
from robbdd_tools.lsp.convert import Converter
from robbdd_tools.lsp.open_texts import OpenTexts

URI = "file:///work/main.bdd"
LETTERS = "ab é🤖\n\r\x0b\x0c\x1c\x85\u2028\u2029"
TEXTS = st.text(st.sampled_from(LETTERS), max_size=20)
UNITS = {types.PositionEncodingKind.Utf8: "utf-8", types.PositionEncodingKind.Utf16: "utf-16-le"}


def place(text: str, offset: int, encoding: types.PositionEncodingKind) -> types.Position:
    """The position of an offset, with the lines of the protocol."""
    starts = [0, *(found.end() for found in re.finditer(r"\r\n|\n|\r", text) if found.end() <= offset)]
    before = text[starts[-1] : offset]
    units = len(before) if encoding not in UNITS else len(before.encode(UNITS[encoding]))
    return types.Position(len(starts) - 1, units // (2 if encoding == types.PositionEncodingKind.Utf16 else 1))


@given(
    TEXTS, st.lists(st.tuples(TEXTS, st.floats(0, 1), st.integers(0, 5))), st.sampled_from(types.PositionEncodingKind)
)
def test_any_edits_give_the_clients_text(
    text: str, edits: Sequence[tuple[str, float, int]], encoding: types.PositionEncodingKind
) -> None:
    texts, convert = OpenTexts(), Converter(encoding)
    texts.open(URI, text)
    for inserted, where, length in edits:
        start = int(where * len(text))
        end = min(start + length, len(text))
        if any(text[at - 1 : at + 1] == "\r\n" for at in (start, end)):
            continue  # no editor puts a cursor there
        span = types.Range(place(text, start, encoding), place(text, end, encoding))
        texts.change(convert, URI, [types.TextDocumentContentChangePartial(text=inserted, range=span)])
        text = text[:start] + inserted + text[end:]
        assert texts.text(URI) == text
    texts.change(
        convert,
        URI,
        [
            types.TextDocumentContentChangeWholeDocument(text="a"),
            types.TextDocumentContentChangeWholeDocument(text="b"),
        ],
    )
    assert texts.text(URI) == "b"
    texts.close(URI)
    assert texts.text(URI) == ""


async def test_separators_of_other_standards_do_not_move_later_edits(editor: Editor) -> None:
    editor.open("ns t = 'urn:t:' // \u2028 \x0c \x85\nEvent (ns=t) first\nEvent (ns=t) second\n")
    editor.change("first", "third")
    document = types.TextDocumentIdentifier(uri=editor.uri)
    found = await editor.client.text_document_document_symbol_async(types.DocumentSymbolParams(text_document=document))
    assert [symbol.name for symbol in found or ()] == ["t", "third", "second"]
