"""The outline and the folds that are written as text equal the converted objects."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types
from lsprotocol.converters import get_converter
from tests.bench.models import long_story

from edits import PIECES, Edit
from kit import MODEL, SCENE
from robbdd_tools.base.document import Span
from robbdd_tools.features.folding import folds
from robbdd_tools.features.outline import outline_pieces
from robbdd_tools.features.references import highlights
from robbdd_tools.lsp.convert import Converter, symbol_kind
from robbdd_tools.lsp.document_structure import OutlineWriter, folds_text, highlights_text
from robbdd_tools.lsp.json_text import Passage, with_children
from robbdd_tools.names.definition import Definition
from robbdd_tools.names.project import Project, Snapshot

URI, SCENE_URI = "file:///work/main.bdd", "file:///work/lab.scene"
_PROTOCOL = get_converter()
TEXTS = (
    MODEL,
    long_story(100),
    f"// 😀 one\r\n// two\r\n{SCENE}",
    "ns t = 'urn:t:' Event (ns=t) a Event (ns=t) é Event (ns=t) a\n",
)
EDITS = st.builds(
    Edit,
    st.just(0),
    st.sampled_from(["replace", "delete", "duplicate", "half", "undo"]),
    st.floats(0, 1),
    st.sampled_from([0, 0, 1, 5, 20, 100, 400]),
    st.sampled_from([*PIECES, "\n\n", "// 50 %\n// more\n", " 😀 ", "Scenario bench-to-tray1-1 {"]),
)


def serialise(value: object) -> str:
    return json.dumps(_PROTOCOL.unstructure(value))


def expected(snapshot: Snapshot, convert: Converter, uri: str) -> list[Any]:
    """The outline, made of the definitions of the whole file."""
    analysis = snapshot.file(uri)
    assert analysis is not None
    document = analysis.document
    inner: dict[str, list[Definition]] = {}
    for path, definition in analysis.definitions.items():
        inner.setdefault(path.rpartition(".")[0], []).append(definition)

    def symbol(one: Definition) -> tuple[types.DocumentSymbol, Span]:
        parts = [symbol(part) for part in inner.get(one.symbol.path, [])]
        spans = [one.extent, one.span, *(extent for _, extent in parts)]
        extent = Span(min(span.start for span in spans), max(span.end for span in spans))
        found = types.DocumentSymbol(
            name=one.symbol.name,
            detail=str(one.kind),
            kind=symbol_kind(one.kind),
            range=convert.range(document, extent),
            selection_range=convert.range(document, one.span),
            children=[part for part, _ in parts],
        )
        return found, extent

    return json.loads(serialise([symbol(one)[0] for one in inner.get("", [])]))


@given(
    st.sampled_from(TEXTS),
    st.sampled_from(list(types.PositionEncodingKind)),
    st.lists(EDITS, max_size=8),
)
def test_the_outline_over_any_edits_is_that_of_the_definitions(
    text: str, encoding: types.PositionEncodingKind, edits: Sequence[Edit]
) -> None:
    uri = SCENE_URI if "obj set" in text else URI
    project, convert, writer = Project(), Converter(encoding), OutlineWriter(serialise)
    history = [text]
    for version, edit in enumerate([Edit(0, "replace", 0, 0, ""), *edits]):
        project.open(uri, version, edit.apply(history))
        snapshot = project.snapshot()
        found = writer.text(convert, snapshot.document(uri), outline_pieces(snapshot, uri))
        assert json.loads(found.text) == expected(snapshot, convert, uri)
        plain = [
            types.FoldingRange(start_line=fold.first, end_line=fold.last, kind=fold.kind)
            for fold in folds(snapshot, uri)
        ]
        assert json.loads(folds_text(folds(snapshot, uri)).text) == json.loads(serialise(plain))


@pytest.mark.parametrize("encoding", list(types.PositionEncodingKind))
@pytest.mark.parametrize("before", ["", "// 😀 é\r\n", "/*😀*/ "], ids=["ascii", "lines", "beside"])
def test_highlights_as_text_are_the_converted_objects(encoding: types.PositionEncodingKind, before: str) -> None:
    """The text is the one that the protocol's own serialisation gives, byte for byte."""
    text = (before if before.endswith("\n") else "") + MODEL.replace(
        "Event (ns=t) start\n", f"Event (ns=t) start // {before.strip()}\n"
    )
    project, convert = Project(), Converter(encoding)
    project.open(SCENE_URI, 1, SCENE)
    project.open(URI, 1, text)
    snapshot = project.snapshot()
    document = snapshot.document(URI)
    found = highlights(snapshot, URI, text.index("var goal") + 5)
    assert len(found) > 3
    objects = [
        types.DocumentHighlight(
            range=convert.range(document, Span(one.start, one.end)),
            kind=types.DocumentHighlightKind.Write if one.writes else types.DocumentHighlightKind.Read,
        )
        for one in found
    ]
    assert highlights_text(convert, document, found).text == serialise(objects)


def test_a_declaration_that_only_moves_is_not_converted_again() -> None:
    converted: list[str] = []

    def count(value: object) -> str:
        converted.append(cast("types.DocumentSymbol", value).name)
        return serialise(value)

    project, convert, writer = Project(), Converter(), OutlineWriter(count)
    text = long_story(100)
    found: list[list[str]] = []
    for version, now in enumerate([text, f"\n{text}", text.replace("variation:", "variation: ", 1)]):
        converted.clear()
        project.open(URI, version, now)
        snapshot = project.snapshot()
        writer.text(convert, snapshot.document(URI), outline_pieces(snapshot, URI))
        found.append(list(converted))
    first, *later = found
    assert len(first) > 10
    # A story's own range changes with its length.
    assert later == [[], ["fetching1", "bench-to-tray1-0"]]


def test_only_the_line_numbers_of_a_passage_move() -> None:
    own = {"name": 'a %d "line": 3', "range": {"start": {"line": 1, "character": 2}}, "line 4": "100 %"}
    passage = Passage(json.dumps([own, {"startLine": 0, "endLine": 7}]))
    for line in (0, 5, 0):
        first, second = json.loads(passage.at(line))
        assert first == {**own, "range": {"start": {"line": 1 + line, "character": 2}}}
        assert second == {"startLine": line, "endLine": 7 + line}


def test_children_are_put_into_a_symbol_whose_name_looks_like_json() -> None:
    parent = json.dumps({"name": '"children": []', "children": []})
    assert json.loads(with_children(parent, '{"name": "a"}'))["children"] == [{"name": "a"}]


@pytest.mark.parametrize("text", ["// a\r// b\r\n// c\n\n\v// d\nimport 'x'\nimport 'y'", "", "import 'x'"])
def test_runs_of_comments_and_imports_are_found_whatever_ends_a_line(text: str) -> None:
    project = Project()
    project.open(URI, 1, text)
    found = [tuple(fold) for fold in folds(project.snapshot(), URI)]
    assert found == ([(0, 2, "comment"), (5, 6, "imports")] if len(text) > 20 else [])
