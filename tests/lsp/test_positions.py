"""Positions in the units of every client, with letters beyond the basic plane in comments and strings."""

from __future__ import annotations

import pytest
from lsprotocol import types

from kit import MODEL, fixture
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.features.semantic_tokens import semantic_tokens
from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.tokens import encoded

UNITS = {"utf-8": "utf-8", "utf-16": "utf-16-le", "utf-32": "utf-32-le"}
WIDTHS = {"utf-8": 1, "utf-16": 2, "utf-32": 4}
TEXT = "// 🤖 moves é\r\nns t = 'http://x/𝒳' // 🦾\nEvent (ns=t) ä // 🧪🧪"


@pytest.mark.parametrize("encoding", UNITS)
def test_every_offset_has_a_position_that_leads_back(encoding: str) -> None:
    convert, document = Converter(encoding), Document("x", 0, TEXT)
    for offset, letter in enumerate(TEXT):
        position = convert.position(document, offset)
        line = TEXT[document.line_starts[position.line] : offset]
        if letter not in "\r\n":
            assert position.character == len(line.encode(UNITS[encoding])) // WIDTHS[encoding]
            assert convert.offset(document, position) == offset


@pytest.mark.parametrize("encoding", UNITS)
def test_a_position_beyond_its_line_is_the_lines_end(encoding: str) -> None:
    convert, document = Converter(encoding), Document("x", 0, TEXT)
    assert convert.offset(document, types.Position(line=0, character=999)) == TEXT.index("\r")
    assert convert.offset(document, types.Position(line=99, character=0)) == len(TEXT)


@pytest.mark.parametrize("encoding", UNITS)
def test_tokens_and_diagnostics_behind_astral_letters_keep_their_place(encoding: str) -> None:
    case = fixture(MODEL.replace('As A "operator" I Want', 'As A "🤖 operator" I Want'))
    document = document_of(case.snapshot, case.uri)
    convert = Converter(encoding)
    start = document.text.index('"parts fetched"')
    robot = len("🤖".encode(UNITS[encoding])) // WIDTHS[encoding]
    span = Span(start, start + len('"parts fetched"'))
    found = convert.diagnostic(case.snapshot, Diagnostic(case.uri, span, Severity.ERROR, "x", "x"))
    line = document.line_text(found.range.start.line)
    assert found.range.start.character == line.index('"parts') - 1 + robot
    data = encoded(convert, document, semantic_tokens(case.snapshot, case.uri))
    lengths = [data[at + 2] for at in range(0, len(data), 5)]
    assert len('" operator"') + robot in lengths


def test_what_is_superseded_is_struck_through_and_what_is_unused_faded() -> None:
    case = fixture(MODEL)
    tags = {
        code: Converter().diagnostic(case.snapshot, Diagnostic(case.uri, Span(0, 1), Severity.HINT, code, "x")).tags
        for code in ("published-form", "unused-event", "unknown-name")
    }
    assert tags == {
        "published-form": [types.DiagnosticTag.Deprecated],
        "unused-event": [types.DiagnosticTag.Unnecessary],
        "unknown-name": None,
    }
