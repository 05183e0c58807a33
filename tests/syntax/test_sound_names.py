"""The quick reading of names accepts texts without syntax errors only, and misses no name that parsing finds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from edits import PIECES, Edit
from kit import MODELS, corpus
from robbdd_tools.syntax.declaration import Declaration
from robbdd_tools.syntax.parse import LANGUAGES, parse_declaration
from robbdd_tools.syntax.sound_names import sound_names
from robbdd_tools.syntax.split import split, split_once

EXPRESSIONS = """Scenario Template (ns=t) fetch {
    task: <task> set var things var goal
    When: Behaviour (ns=t) carry { <robot> picks <part> and places at <goal> emits pick-end as <picked> }
    Then:
        ( ( not near: holds(<part> is located at <goal>, before <end>) )
          or ( first: holds(pred("{x} // shines", x=<goal>), within 0.5 seconds after the last <end>)
               or "free text" after <end> ) )
        ( var thing exists in <things> where heavy and mass > 0.5 kg ) such that
            { ( in-it: holds(<thing> is located at <goal>, at some time from <start> until <end>) ) } // last
}
"""
SOUND = [
    ("bdd", EXPRESSIONS),
    ("bdd", "Task name"),
    *(
        (path.suffix[1:], chunk.text)
        for path in MODELS
        for chunk in split(path.suffix[1:], path.read_text(encoding="utf-8"))
    ),
]
EDITS = st.builds(
    Edit,
    st.just(0),
    st.sampled_from(["replace", "delete", "duplicate"]),
    st.floats(0, 1),
    st.sampled_from([0, 0, 0, 1, 5, 20]),
    st.sampled_from([*PIECES, "and", " or ", "not", "-", ".", "//", "var", "with: ", "where", "m/s", "Behaviour {"]),
)


def segments(declaration: Declaration) -> Iterator[list[str]]:
    return (symbol.path.split(".") for symbol in declaration.symbols)


def agrees(language: str, text: str) -> bool:
    """Compare the names with those of parsing; return whether they were found quickly."""
    names, declaration = sound_names(language, text), parse_declaration(language, text)
    if names is None:
        return False
    assert declaration.faults == ()
    for first, *others in segments(declaration):
        assert first == names[0]
        assert set(others) <= set(names)
    return True


def has_only_written_names(language: str, text: str) -> bool:
    """Return whether all names are words of the text, and it has no error."""
    declaration = parse_declaration(language, text)
    return not declaration.faults and all(symbol.span.start < symbol.span.end for symbol in declaration.symbols)


@pytest.mark.parametrize(("language", "text"), SOUND, ids=lambda value: str(value)[:30])
def test_names_of_sound_declarations_are_found_quickly(language: str, text: str) -> None:
    # The elements of a similar set are not written, and a named predicate may have a parameter before its name.
    is_parsed = text.startswith(("similar", "Predicate"))
    assert agrees(language, text) == (has_only_written_names(language, text) and not is_parsed)


@given(st.sampled_from(SOUND), st.lists(EDITS, min_size=1, max_size=2))
def test_edited_declarations_are_parsed_unless_they_are_sound(sound: tuple[str, str], edits: Sequence[Edit]) -> None:
    language, text = sound
    history = [text]
    for edit in edits:
        for chunk in split_once(language, edit.apply(history)):
            agrees(language, chunk.text)


def test_foreign_declarations_are_read_like_own_ones() -> None:
    for path in corpus(*(f".{language}" for language in LANGUAGES)):
        for chunk in split(path.suffix[1:], path.read_text(encoding="utf-8")):
            agrees(path.suffix[1:], chunk.text)


def test_nested_brackets_take_time_in_proportion_to_their_number() -> None:
    inner = "a: holds(<part> is held by <robot>, before <end>)"
    for depth in (30, 3000):
        clauses = f"{'( ' * depth}{inner}{' )' * depth}"
        text = f"Scenario Template t {{ When: Behaviour b {{ <robot> picks <part> }} Then: {clauses} }}"
        assert (sound_names("bdd", text) is None) == (depth == 3000)
