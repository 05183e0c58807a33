"""A text is split into its declarations, even if they are broken."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit import MODEL, SCENE
from robbdd_tools.syntax.split import resplit, split


def heads(language: str, text: str) -> list[str]:
    return [" ".join(chunk.text.split()[:3]) for chunk in split(language, text)]


def test_each_declaration_is_a_chunk() -> None:
    assert heads("scene", "ns a = 'x' obj set (ns=a) s { object o }\nscene (ns=a) m { obj set <s> }") == [
        "ns a =",
        "obj set (ns=a)",
        "scene (ns=a) m",
    ]


def test_comments_may_stand_between_opening_words() -> None:
    texts = ["Event // one (\n (ns=t) // two\n a\n", "Scenario // three\n// four\nTemplate (ns=t) b { }"]
    assert [chunk.text for chunk in split("bdd", "".join(texts))] == texts


def test_a_missing_brace_costs_one_declaration() -> None:
    text = "Scenario Template (ns=t) a {\n  var x\nEvent (ns=t) e\nTask (ns=t) k\n"
    assert heads("bdd", text) == ["Scenario Template (ns=t)", "Event (ns=t) e", "Task (ns=t) k"]


def test_a_superfluous_brace_costs_nothing() -> None:
    assert heads("bdd", "Event (ns=t) a }} Event (ns=t) b") == ["Event (ns=t) a", "Event (ns=t) b"]


@pytest.mark.parametrize("text", ['"Event (ns=t) a"', "// Event (ns=t) a", "'\\' Event (ns=t) a'"])
def test_strings_and_comments_begin_nothing(text: str) -> None:
    assert len(split("bdd", f"const set (ns=t) s {{ {text}\n}}")) == 1


def test_an_unclosed_string_ends_with_its_line() -> None:
    assert heads("bdd", 'const set (ns=t) s { "oops }\nEvent (ns=t) e') == ["const set (ns=t)", "Event (ns=t) e"]


def test_references_and_names_that_look_like_keywords_begin_nothing() -> None:
    assert len(split("scene", "comp (ns=e) c of ws <scene.x> { obj <comp.y> }")) == 1


def test_text_before_the_first_declaration_is_kept_as_a_chunk() -> None:
    chunks = split("bdd", "  // note\n Evnt (ns=t) a\nEvent (ns=t) b")
    assert [(chunk.offset, chunk.text.split()[0]) for chunk in chunks] == [(11, "Evnt"), (25, "Event")]


@pytest.mark.parametrize("text", ["", "  \n", "// only a comment", "\ufeff"])
def test_nothing_to_read_is_no_chunk(text: str) -> None:
    assert split("bdd", text) == ()


@given(st.text(alphabet=" \nEvent(ns=t){}\"'/<>abTask:|", max_size=80))
def test_chunks_are_the_text_in_order_without_gaps(text: str) -> None:
    chunks = split("bdd", text)
    for chunk in chunks:
        assert text[chunk.offset : chunk.offset + len(chunk.text)] == chunk.text
    assert all(a.offset + len(a.text) == b.offset for a, b in pairwise(chunks))
    if chunks:
        assert text.endswith(chunks[-1].text)


def test_models_split_into_their_declarations() -> None:
    assert len(split("bdd", MODEL)) == 9
    assert len(split("scene", SCENE)) == 9


PIECES = [
    "",
    " ",
    "{",
    "}",
    "(",
    ")",
    '"',
    "'",
    "//",
    "\n",
    "Event (ns=t) e\n",
    "User Story s {",
    "User // {\n",
    "Story",
]


@given(
    st.lists(
        st.tuples(st.floats(0, 0.999), st.integers(0, 30), st.sampled_from(PIECES)),
        min_size=1,
        max_size=6,
    )
)
def test_after_edits_a_text_is_split_as_if_it_were_new(edits: list[tuple[float, int, str]]) -> None:
    text = MODEL
    chunks = split("bdd", text)
    for number, (where, length, piece) in enumerate(edits):
        place = int(where * len(text))
        after = f"{text[:place]}{piece}{text[place + length :]}"
        chunks, text = resplit("bdd", text, chunks, after), after
        # A text that was never seen before is split as a whole; the prefix makes it one.
        whole = split("bdd", f"// {number}\n{text}")
        assert [chunk.text for chunk in chunks] == [chunk.text for chunk in whole]
