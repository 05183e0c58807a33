"""Tokens are classified by meaning, in every file kind, also in broken text."""

from __future__ import annotations

import json
from array import array
from itertools import pairwise
from pathlib import Path

import pytest

from kit import MODEL, MODELS, ROOT, SCENE, fixture
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features import semantic_tokens as feature
from robbdd_tools.features.semantic_tokens import semantic_tokens
from robbdd_tools.lsp.convert import Converter
from robbdd_tools.lsp.tokens import APPEARANCES, LEGEND, Encoder, SentTokens, encoded
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.declaration import SymbolKind


def coloured(text: str, line: str) -> list[tuple[str, str]]:
    """The words of one line of the model with their concepts."""
    case = fixture(text)
    source = case.project.texts()[case.uri][1]
    start = source.index(line)
    span = Span(start, start + len(line))
    return [
        (source[token.span.start : token.span.end], token.concept)
        for token in semantic_tokens(case.snapshot, case.uri)
        if span.start <= token.span.start and token.span.end <= span.end
    ]


def test_a_clause_is_told_by_concepts() -> None:
    assert coloured(MODEL, "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)") == [
        ("in-tray", "fluent"),
        ("holds", "keyword"),
        ("part", "variable"),
        ("is", "predicate"),
        ("located", "predicate"),
        ("at", "predicate"),
        ("goal", "variable"),
        ("0.5", "number"),
        ("seconds", "time constraint"),
        ("after", "time constraint"),
        ("place-end", "event"),
    ]


def test_each_part_of_a_qualified_name_has_its_own_concept() -> None:
    found = coloured(MODEL, "var <fetch.goal>: { <places.bench_ws>, <places.tray_ws> }")
    assert found[1:5] == [
        ("fetch", "scenario template"),
        ("goal", "variable"),
        ("places", "workspace set"),
        ("bench_ws", "workspace"),
    ]


def test_a_broken_declaration_keeps_the_colours_of_what_is_understood() -> None:
    broken = MODEL.replace("task: <task>", "task <task> <fetch.part> )(")
    assert ("fetch", "scenario template") in coloured(broken, "<fetch.part> )(")
    assert coloured(broken, "var robot") == [("var", "keyword"), ("robot", "variable")]


def test_comments_strings_and_names_that_look_like_keywords_are_told_apart() -> None:
    text = "// before\nns Event = 'http://a/b'\nEvent (ns=Event) from\n"
    assert coloured(text, text) == [
        ("// before", "comment"),
        ("ns", "keyword"),
        ("Event", "namespace"),
        ("'http://a/b'", "string"),
        ("Event", "keyword"),
        ("ns", "keyword"),
        ("Event", "namespace"),
        ("from", "event"),
    ]


def test_a_string_over_two_lines_is_a_token_in_each() -> None:
    text = MODEL.replace('"operator"', '"the\noperator"')
    assert coloured(text, '"the\noperator"') == [('"the', "string"), ('operator"', "string")]


def test_python_names_and_arguments_of_phrases_are_told() -> None:
    text = MODEL.replace("<part> is located at <goal>, before", "<goal> has config height = <part>, before")
    assert ("height", feature.ARGUMENT) in coloured(text, "<goal> has config height = <part>")
    tree = "Behaviour Tree (ns=t) carrying { py { module: trees.carry, attr: make } node pick }"
    assert [pair for pair in coloured(MODEL + tree, tree) if pair[1] == feature.CODE] == [
        ("trees.carry", "python"),
        ("make", "python"),
    ]


def test_an_unsaved_scene_gives_the_names_in_it_their_concepts() -> None:
    files = {"main.bdd": MODEL, "lab.scene": SCENE.replace("workspace tray_ws", "workspace crate_ws")}
    case = fixture("".join(f"//- {name}\n{text}" for name, text in files.items()))
    text = case.project.texts()[case.uri][1]
    words = [text[token.span.start : token.span.end] for token in semantic_tokens(case.snapshot, case.uri)]
    assert "bench_ws" in words
    assert "tray_ws" not in words


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
@pytest.mark.parametrize("cut", [1, 2, 3])
def test_tokens_stand_in_order_apart_and_within_their_lines(path: Path, cut: int) -> None:
    text = path.read_text(encoding="utf-8")
    uri = path_to_uri(path)
    project = Project()
    project.open(uri, 1, text[: len(text) * cut // 3])
    tokens = semantic_tokens(project.snapshot(), uri)
    assert all(before.span.end <= after.span.start for before, after in pairwise(tokens))
    assert all("\n" not in text[token.span.start : token.span.end] for token in tokens)
    assert len(tokens) > 5
    half = Span(len(text) // 6, len(text) // 3)
    part = semantic_tokens(project.snapshot(), uri, half)
    assert part == [token for token in tokens if token.span.start < half.end and half.start < token.span.end]


def test_every_concept_has_an_appearance_that_every_theme_knows() -> None:
    constants = {
        feature.COMMENT,
        feature.STRING,
        feature.NUMBER,
        feature.KEYWORD,
        feature.TIME,
        feature.CODE,
        feature.PROPERTY,
    }
    assert set(APPEARANCES) == {*SymbolKind, *constants, feature.PREDICATE, feature.ACTION, feature.ARGUMENT}
    assert len(LEGEND.token_modifiers) < 32


def test_the_extension_knows_the_servers_legend() -> None:
    contributes = json.loads((ROOT / "client-vscode" / "package.json").read_text(encoding="utf-8"))["contributes"]
    own = {entry["id"] for entry in contributes["semanticTokenModifiers"]}
    assert own == set(LEGEND.token_modifiers) - {"declaration", "defaultLibrary"}
    looks = {look[0] if len(look) == 1 else f"{look[0]}.{look[1]}" for look in APPEARANCES.values()}
    (entry,) = contributes["semanticTokenScopes"]
    assert set(entry["scopes"]) <= looks


def test_only_what_has_changed_is_sent_again() -> None:
    sent = SentTokens()
    first = sent.whole("a", array("I", [0, 0, 1, 0, 0, 1, 0, 2, 0, 0]))
    assert first.result_id is not None
    change = sent.difference("a", first.result_id, array("I", [0, 0, 1, 0, 0, 2, 0, 2, 0, 0]))
    assert [(edit.start, edit.delete_count, list(edit.data or ())) for edit in getattr(change, "edits", ())] == [
        (5, 1, [2])
    ]
    assert list(getattr(sent.difference("a", first.result_id, array("I", [7])), "data", ())) == [7]


def test_tokens_kept_over_edits_are_sent_as_those_of_a_fresh_project() -> None:
    uri, edited, encoder, convert = "file:///main.bdd", Project(), Encoder(), Converter()
    first = MODEL.replace('import "lab.scene"', SCENE)
    changes = [
        ("Event (ns=t) start", "// 😀 above\nEvent (ns=t) start"),
        ("before <pick-start>", "before  <pick-start>"),
        ("ws set (ns=env) places", "ws set (ns=env) spots"),
        ("scene (ns=env) bench_scene", "scene (ns=env) bench_scene {} scene (ns=env) other"),
    ]
    text = first
    for version, (old, new) in enumerate([("", ""), *changes]):
        assert old in text
        text = text.replace(old, new, 1)
        edited.open(uri, version, text)
        fresh = Project()
        fresh.open(uri, version, text)
        document = Document(uri, version, text)
        whole = encoder.whole(convert, document, feature.coloured(edited.snapshot(), uri))
        assert whole.tolist() == encoded(convert, document, semantic_tokens(fresh.snapshot(), uri))


def test_a_piece_that_an_edit_left_alone_is_not_coloured_again() -> None:
    uri, project = "file:///main.bdd", Project()
    text = MODEL.replace('import "lab.scene"', SCENE)
    project.open(uri, 1, text)
    before = feature.coloured(project.snapshot(), uri)
    project.open(uri, 2, text.replace("before <pick-start>", "before  <pick-start>", 1))
    after = feature.coloured(project.snapshot(), uri)
    changed = [old for (_, old), (_, new) in zip(before, after, strict=True) if old is not new]
    assert len(changed) == 1
