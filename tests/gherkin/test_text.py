"""User text is unchanged after every parser, and IRIs after tags."""

from __future__ import annotations

import ast
import re

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gherkin_kit import edited, feature, pieces, read_by_behave, read_officially
from kit import MODEL
from robbdd_tools.gherkin import text

NASTY = st.text(st.sampled_from("ab \"'\\|<>()[]{}#@:*\n\r\t\x0b\x85\u2028é"), max_size=12)


def quoted(value: str) -> str:
    """A string literal of the language: backslashes escape; a carriage return as such would be the end of a line."""
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "\\r") + '"'


def unescaped(told: str) -> str:
    """Undo the documented escapes, as the author of steps would."""
    named = {"n": "\n", "r": "\r", "t": "\t"}
    return re.sub(
        r"\\(?:u([0-9a-f]{4})|(.))",
        lambda match: chr(int(match[1], 16)) if match[1] else named.get(match[2], match[2]),
        re.sub(r"^\\(?=\[|any of \[)", "", told),
    )


@pytest.mark.parametrize("template", ["default", "compact", "de"])
@pytest.mark.parametrize(
    "word", ['a "quoted" word', "a | pipe", "two\nlines", "a \\ b", "<goal>", "[1, 2]", "any of [x]", "", " x ", "#@*"]
)
def test_all_templates_make_features_that_both_parsers_read_alike(word: str, template: str) -> None:
    source = edited("{ <arms.panda> }", f"{{ {quoted(word)}, <arms.ur10> }}")
    told = feature(source, template)
    expected = [piece.scenario for piece in pieces(source) if piece.scenario]
    for found in (read_by_behave(told), read_officially(told)):
        assert len(found) == len(expected) == 8
        for scenario, read in zip(expected, found, strict=True):
            own = [(step.role, step.text) for step in scenario.steps]
            assert list(read.steps[-len(own) :]) == own
            assert read.tables[-1] == ("env:panda", "env:ur10") if len(read.tables) == 3 else True
    behave, official = read_by_behave(told), read_officially(told)
    assert [(read.tags, read.steps, read.tables) for read in behave] == [
        (read.tags, read.steps, read.tables) for read in official
    ]


@settings(max_examples=40)
@given(NASTY)
def test_a_value_comes_back_from_its_quotes(word: str) -> None:
    told = feature(edited("{ <arms.panda> }", f"{{ {quoted(word)} }}"))
    for found in (read_by_behave(told), read_officially(told)):
        step = next(sentence for _, sentence in found[0].steps if "picks" in sentence)
        match = re.fullmatch(r'"((?:[^"\\]|\\.)*)" picks "env:bolt" and places it at "env:bench_ws"', step)
        assert match is not None, step
        assert unescaped(match[1]) == word


@settings(max_examples=40)
@given(NASTY)
def test_free_text_comes_back_from_its_step(word: str) -> None:
    clause = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
    told = feature(edited(clause, f"{quoted(word)} after <end>"))
    for found in (read_by_behave(told), read_officially(told)):
        step = found[0].steps[-1][1].removesuffix('after event "t:end"').removesuffix(" ")
        assert unescaped(step) == word.strip()


@settings(max_examples=40)
@given(NASTY, NASTY, NASTY)
def test_names_and_narrative_never_break_a_feature(role: str, goal: str, benefit: str) -> None:
    source = MODEL
    for old, new in (("operator", role), ("parts fetched", goal), ("work goes on", benefit)):
        source = edited(f'"{old}"', quoted(new), source)
    told = feature(source)
    assert len(read_by_behave(told)) == len(read_officially(told)) == 4


@settings(max_examples=40)
@given(st.lists(NASTY, min_size=1, max_size=3))
def test_a_set_of_strings_comes_back_as_a_list(words: list[str]) -> None:
    assert ast.literal_eval(unescaped(text.set_inside_quotes(words))) == words


@settings(max_examples=40)
@given(NASTY)
def test_guarded_text_neither_opens_nor_closes_nor_splits(word: str) -> None:
    outside = re.sub(r'\\.|"(?:[^"\\]|\\.)*"', "", text.in_group(text.free(f"{word} and not (x) or")))
    assert not re.search(r'[()"]|(?<!\S)(and|or|not)(?!\S)', outside)


@settings(max_examples=40)
@given(st.text(st.characters(exclude_categories=["Cs"]), min_size=1))
def test_an_iri_comes_back_from_its_tag(iri: str) -> None:
    tag = text.tag("clause", iri)
    assert text.read_tag(tag) == text.read_tag(f"@{tag}") == ("clause", iri)
    assume(len(iri) < 40)
    told = f"@{tag} @other\nFeature: f\n\n  Scenario: s\n    Given x\n"
    for found in (read_by_behave(told), read_officially(told)):
        assert tag in found[0].tags


def test_tags_say_story_variant_template_and_clauses() -> None:
    (first, *_) = read_by_behave(feature(MODEL))
    base = "https://example.org/t/"
    scenario = next(piece.scenario for piece in pieces(MODEL) if piece.scenario)
    assert [text.read_tag(tag) for tag in first.tags] == [
        *sorted(("clause", step.clause) for step in scenario.steps),
        ("story", f"{base}fetching"),
        ("template", f"{base}fetch"),
        ("variant", f"{base}bench-to-tray"),
    ]


def test_a_foreign_tag_carries_nothing() -> None:
    assert text.read_tag("@wip") is None
