"""The compiled parser reads what textX reads, and stops where textX stops."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kit import EXAMPLES, MODEL, SCENE, corpus
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.grammar import GrammarError, read_grammar
from robbdd_tools.syntax.parsed import Parsed, Rejected
from robbdd_tools.syntax.split import split
from robbdd_tools.syntax.textx import parse_with_textx
from robbdd_tools.syntax.to_trees import convert

LANGUAGES = ("bdd", "scene", "scenex", "ktree", "bddx")


def chunks(language: str, text: str) -> list[tuple[str, str]]:
    return [(language, chunk.text) for chunk in split(language, text)]


SOUND = [
    *chunks("bdd", MODEL),
    *chunks("scene", SCENE),
    *(
        entry
        for path in sorted(EXAMPLES.rglob("*"))
        if path.suffix[1:] in LANGUAGES
        for entry in chunks(path.suffix[1:], path.read_text(encoding="utf-8"))
    ),
]
PIECES = [
    "",
    " ",
    ")",
    "(",
    "}",
    "{",
    "<",
    ">",
    ":",
    ",",
    "and",
    "or",
    "not",
    "var",
    "holds",
    "// x\n",
    '"',
    "1.5",
    "|",
    "é",
]


def same(language: str, text: str) -> None:
    ours, theirs = parse_chunk(language, text), parse_with_textx(language, text)
    if isinstance(theirs, Rejected):
        assert isinstance(ours, Rejected)
        assert ours.offset == theirs.offset
    else:
        assert isinstance(ours, Parsed)
        assert ours.trailing == theirs.trailing
        assert convert(ours.declaration, text) == convert(theirs.declaration, text)


@pytest.mark.parametrize(("language", "text"), SOUND, ids=lambda value: str(value)[:30])
def test_sound_declarations_give_the_same_trees(language: str, text: str) -> None:
    same(language, text)


def test_foreign_declarations_give_the_same_trees() -> None:
    for path in corpus(*(f".{language}" for language in LANGUAGES)):
        for language, text in chunks(path.suffix[1:], path.read_text(encoding="utf-8")):
            same(language, text)


@settings(max_examples=400)
@given(
    st.sampled_from(SOUND),
    st.lists(st.tuples(st.floats(0, 1), st.sampled_from([0, 0, 1, 2, 6, 30]), st.sampled_from(PIECES)), max_size=3),
)
def test_edited_declarations_are_accepted_or_rejected_alike(
    sound: tuple[str, str], edits: list[tuple[float, int, str]]
) -> None:
    language, text = sound
    for place, length, piece in edits:
        start = int(place * len(text))
        text = text[:start] + piece + text[start + length :]
    same(language, text)


def test_brackets_without_end_are_an_error_and_no_crash() -> None:
    assert isinstance(parse_chunk("bdd", "Scenario Template (ns=t) x { Given: " + "(" * 100_000), Rejected)


def test_notation_beyond_ours_is_named() -> None:
    with pytest.raises(GrammarError, match="unknown notation"):
        read_grammar("Rule: 'a' & 'b';")
