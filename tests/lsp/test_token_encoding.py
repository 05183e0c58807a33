"""Tokens that are encoded piece by piece, and sent as differences, are those of the whole document."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types
from tests.bench.models import long_story

from edits import PIECES, Edit
from kit import MODEL, SCENE
from robbdd_tools.features.semantic_tokens import coloured, semantic_tokens
from robbdd_tools.lsp.convert import Converter
from robbdd_tools.lsp.tokens import Encoder, SentTokens, encoded
from robbdd_tools.names.project import Project

URI = "file:///work/main.bdd"
TEXTS = (MODEL, long_story(60), "// 😀\r\n" + SCENE, "ns t = 'urn:t:' Event (ns=t) é /* 😀 */ Event (ns=t) a // 😀\n")
EDITS = st.builds(
    Edit,
    st.just(0),
    st.sampled_from(["replace", "delete", "duplicate", "half", "undo"]),
    st.floats(0, 1),
    st.sampled_from([0, 0, 1, 5, 100, 400]),
    st.sampled_from([*PIECES, "\n\n", " 😀 ", "'😀' ", "// 😀\n"]),
)


@given(st.sampled_from(TEXTS), st.sampled_from(list(types.PositionEncodingKind)), st.lists(EDITS, max_size=8))
def test_differences_lead_to_the_tokens_of_the_whole_document(
    text: str, encoding: types.PositionEncodingKind, edits: Sequence[Edit]
) -> None:
    project, convert, encoder, sent = Project(), Converter(encoding), Encoder(), SentTokens()
    history, shown, result = [text], list[int](), ""
    data = array("I")
    for version, edit in enumerate([Edit(0, "replace", 0, 0, ""), *edits]):
        project.open(URI, version, edit.apply(history))
        snapshot = project.snapshot()
        document = snapshot.document(URI)
        data = encoder.whole(convert, document, coloured(snapshot, URI))
        assert data.tolist() == encoded(convert, document, semantic_tokens(snapshot, URI))
        answer = sent.difference(URI, result, data)
        if isinstance(answer, types.SemanticTokensDelta):
            for change in answer.edits:
                shown[change.start : change.start + change.delete_count] = change.data or []
            assert len(answer.edits) <= 1
        else:
            shown = list(answer.data)
        assert shown == data.tolist()
        result = answer.result_id or ""
    same = sent.difference(URI, result, data)
    assert isinstance(same, types.SemanticTokensDelta)
    assert same.edits == []
    assert isinstance(sent.difference(URI, result, data), types.SemanticTokens), "that result was replaced"
