"""A user story is read scenario by scenario, with the result of reading it whole."""

from __future__ import annotations

import os

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.bench.models import long_story

from kit import EXAMPLES, STORY, corpus
from robbdd_tools.syntax import piece, tree
from robbdd_tools.syntax.chunk import parse_chunk
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.parsed import Parsed, Rejected
from robbdd_tools.syntax.split import split
from robbdd_tools.syntax.story_cut import cut_story, forget_scan, quotes_cuts
from robbdd_tools.syntax.symbols import references, symbols
from robbdd_tools.syntax.textx import parse_with_textx
from robbdd_tools.syntax.to_trees import convert

LONG = next(chunk.text for chunk in split("bdd", long_story(120)) if chunk.text.startswith("User"))
STORY_HEAD = "User Story"
PUBLISHED = """User Story s {
    As A "a" I Want "b" So That "c"
    Scenario Variant one { template: <t> scene: <s> Then: <t.x> is held by <t.y> after <e> <x> can be: - obj <o> }
    Scenario Variant { template: <t> scene: <s> <x> can be: - obj <o> } // Scenario three {
    Scenario four { template: <t> scene: <s> variation: var <t.x>: { "Scenario five {", 'it' } }
}
"""


def stories() -> list[str]:
    paths = [*sorted(EXAMPLES.rglob("*.bdd")), *(corpus(".bdd") if os.environ.get("ROBBDD_CORPUS") else [])]
    texts = [chunk.text for path in paths for chunk in split("bdd", path.read_text(encoding="utf-8"))]
    return [LONG, PUBLISHED, *(text for text in texts if cut_story(text))]


STORIES = stories()


def test_foreign_stories_are_among_the_stories() -> None:
    texts = [path.read_text(encoding="utf-8") for path in corpus(".bdd")]
    assert all(any(story in text for story in STORIES) for text in texts)


@pytest.mark.parametrize("text", STORIES, ids=lambda text: text[:30])
def test_a_sound_story_has_the_tree_and_names_of_the_whole(text: str) -> None:
    parsed = parse_chunk("bdd", text)
    assert isinstance(parsed, Parsed)
    whole = convert(parsed.declaration, text)
    read = parse_declaration("bdd", text)
    assert read.faults == ()
    assert read.tree == whole
    assert read.symbols == symbols(whole)
    assert read.references == references(whole)


PIECES = [
    "",
    " ",
    "}",
    "{",
    ")",
    "<",
    ":",
    '"',
    "'",
    "// ",
    "\n",
    "Scenario ",
    "Scenario x {",
    "\n  Scenario x {\n",
    "var",
]


@settings(max_examples=300)
@given(
    st.sampled_from(STORIES),
    st.lists(
        st.tuples(st.floats(0, 1), st.sampled_from([0, 0, 1, 2, 6, 30, 300]), st.sampled_from(PIECES)), max_size=3
    ),
)
def test_an_edited_story_has_faults_where_textx_rejects_it_only(text: str, edits: list[tuple[float, int, str]]) -> None:
    for place, length, put in edits:
        start = int(place * len(text))
        text = text[:start] + put + text[start + length :]
    theirs = parse_with_textx("bdd", text)
    sound = isinstance(theirs, Parsed) and theirs.trailing is None
    read = parse_declaration("bdd", text)
    assert (not read.faults) == sound, text
    assert all(0 <= fault.span.start <= fault.span.end <= len(text) for fault in read.faults)
    if isinstance(theirs, Parsed) and theirs.trailing is None:
        assert read.tree == convert(theirs.declaration, text)


def test_an_edit_in_one_scenario_parses_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    parse_declaration("bdd", LONG)
    read: list[str] = []

    def parse(language: str, text: str) -> Parsed | Rejected:
        read.append(text)
        return parse_chunk(language, text)

    monkeypatch.setattr(piece, "parse_chunk", parse)
    middle = LONG.index("variation:", len(LONG) // 2)
    declaration = parse_declaration("bdd", f"{LONG[:middle]}// now\n{LONG[middle:]}")
    assert declaration.faults == ()
    (text,) = read
    assert text.count("Scenario") == 1


def test_a_broken_scenario_keeps_the_names_of_all_others() -> None:
    whole = parse_declaration("bdd", LONG)
    broken = LONG.replace("scene: <bench_scene>", "scene <bench_scene", 1)
    read = parse_declaration("bdd", broken)
    assert len(read.faults) == 2
    assert [symbol.path for symbol in read.symbols] == [symbol.path for symbol in whole.symbols]
    assert isinstance(read.tree, tree.Story)
    assert isinstance(whole.tree, tree.Story)
    assert len(read.tree.variants) == len(whole.tree.variants)


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("        }\n}", "}", 9, "ends too early"),
        ("        }\n}", "        }\n", 10, "ends too early"),
        ("        }\n}", "        }}\n}", 11, "after the end of the declaration"),
        ("        Scenario bench", "        Scenaro bench", 3, "expected 'Scenario'"),
        ("User Story (ns=t) fetching {", "User Story (ns=t) fetching", 1, "expected '{'"),
        ("    Scenarios:\n", "    Scenarios\n", 3, "unexpected 'Scenario': expected ':'"),
        ('As A "operator"', "As A", 1, "expected a string in quotes"),
    ],
)
def test_an_error_around_the_scenarios_has_its_place(old: str, new: str, line: int, message: str) -> None:
    assert STORY.count(old) == 1
    text = STORY.replace(old, new)
    (fault,) = parse_declaration("bdd", text).faults
    assert message in fault.message
    assert text.count("\n", 0, fault.span.start) == line


def test_a_superfluous_brace_in_a_scenario_is_one_error() -> None:
    scenario = LONG.index("}", LONG.index("places.tray_ws>"))
    (fault,) = parse_declaration("bdd", f"{LONG[: scenario + 1]}\n }} }}{LONG[scenario + 1 :]}").faults
    assert "unexpected '}'" in fault.message


@pytest.mark.parametrize("quoted", ["\n    Scenario x {\n    }", "\n}{", "\nScenario e"])
def test_a_string_of_several_lines_may_quote_a_scenario_or_braces(quoted: str) -> None:
    text = STORY.replace('"parts fetched"', f'"parts fetched:{quoted}"')
    assert quotes_cuts(text)
    read = parse_declaration("bdd", text)
    assert read.faults == ()
    assert [symbol.name for symbol in read.symbols] == ["fetching", "bench-to-tray"]


@given(
    st.sampled_from(STORIES),
    st.lists(
        st.tuples(
            st.floats(0, 0.999),
            st.integers(0, 30),
            st.sampled_from(["", "{", "}", '"', "//", "\n", "Scenario", " x {"]),
        ),
        min_size=1,
        max_size=6,
    ),
)
def test_after_edits_a_story_is_cut_as_if_it_were_new(text: str, edits: list[tuple[float, int, str]]) -> None:
    for where, length, typed in edits:
        place = len(STORY_HEAD) + int(where * (len(text) - len(STORY_HEAD)))
        text = f"{text[:place]}{typed}{text[place + length :]}"
        after_edit = cut_story(text)
        forget_scan()
        assert after_edit == cut_story(text)
