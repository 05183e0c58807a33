"""Canonical layout: it changes white space only, keeps comments, and is stable."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from checks.models import LINES
from kit import MODEL, MODELS, SCENE, corpus, fixture
from robbdd_tools.features.layout import lay_out
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph


def test_indentation_follows_brackets_and_labels() -> None:
    text = """Scenario   Template (ns = t)  x {
var a
  Given :
(
f: holds(<a> is held by <b>,before < e >)
and
g: holds(
<a> can reach <b>, after <e>
)
)
When:
Behaviour (ns=t) b {
<a> picks <b>
}
for all ( var y in <s> ) {
Then:
h: holds(<y> is held by <b>, before <e>)
}
}
"""
    assert (
        lay_out(text)
        == """Scenario Template (ns=t) x {
    var a
    Given:
        (
            f: holds(<a> is held by <b>, before <e>)
            and
            g: holds(
                <a> can reach <b>, after <e>
            )
        )
    When:
        Behaviour (ns=t) b {
            <a> picks <b>
        }
    for all ( var y in <s> ) {
        Then:
            h: holds(<y> is held by <b>, before <e>)
    }
}
"""
    )


def test_tables_are_aligned_and_broken_rows_joined() -> None:
    text = """Scenario x {
variation:
| <t.a> |
<t.long-name> |
|---|
| { 1,2 } | 'a | b' | // odd
| set <s> | 3 |
}
"""
    assert (
        lay_out(text)
        == """Scenario x {
    variation:
        | <t.a>    | <t.long-name> |
        |----------|---------------|
        | { 1, 2 } | 'a | b'       |  // odd
        | set <s>  | 3             |
}
"""
    )


@pytest.mark.parametrize(
    ("text", "laid_out"),
    [
        ("", ""),
        ("\n\n  \n", ""),
        ("a\n\n\n\nb", "a\n\nb\n"),
        ("\ufeffTask (ns=t) a \t\r\nTask (ns=t) b", "Task (ns=t) a\nTask (ns=t) b\n"),
        ("  // note   \nTask (ns=t) a//x", "// note\nTask (ns=t) a  //x\n"),
        ('So That "two\n   lines"  // kept', 'So That "two\n   lines"  // kept\n'),
    ],
)
def test_white_space_is_tidied(text: str, laid_out: str) -> None:
    assert lay_out(text) == laid_out


def essence(text: str) -> str:
    """A text without white space and without the dashes of table rules, whose number is a matter of layout."""
    return re.sub(r"\|[-|\s]+\|", "|-|", re.sub(r"[\s\ufeff]+", "", text))


@given(st.text(alphabet=" \n\t{}()<>|\"'/,:=-.aGivenWhen", max_size=60))
def test_any_text_keeps_its_words_and_settles_at_once(text: str) -> None:
    once = lay_out(text)
    assert lay_out(once) == once
    assert essence(once) == essence(text)


TABLE = """                // before the header
                | <fetch.part> | <fetch.robot> | <fetch.goal> |  // behind the header
                // before the rule
                |---|---|---|
                | <parts.bolt> // in a cell
                  | <arms.panda> // between cells |
                  | { <places.tray_ws>, // in a list
                      <places.bench_ws> }
                |
                // between rows
                | <parts.nut> | <arms.ur10> | <places.tray_ws> | // behind a row
"""
WITH_TABLE = MODEL.replace(LINES, TABLE)
GAPS = [found.end() for found in re.finditer(r"[\w\-]+|[^\w\s]", WITH_TABLE)]


def test_comments_in_tables_stay_and_mean_nothing() -> None:
    once = lay_out(WITH_TABLE)
    assert lay_out(once) == once
    assert essence(once) == essence(WITH_TABLE)
    bare = re.sub(r"(?<!:)//.*", "", WITH_TABLE)
    assert graph(once) == graph(WITH_TABLE) == graph(bare) == graph(lay_out(bare))


@given(
    st.lists(
        st.tuples(
            st.sampled_from(GAPS),
            st.sampled_from([0, 1, 4, 30]),
            st.sampled_from(["", "// it's | a { note\n", " //\n", "\n", "\t", "\r\n", '"', "|", "}", "é🤖"]),
        ),
        max_size=6,
    ),
    st.sampled_from(["\n", "\r\n"]),
)
def test_a_damaged_model_keeps_its_words_and_settles_at_once(edits: list[tuple[int, int, str]], end: str) -> None:
    text = WITH_TABLE
    for place, length, piece in sorted(edits, reverse=True):
        text = text[:place] + piece + text[place + length :]
    once = lay_out(text.replace("\n", end))
    assert lay_out(once) == once
    assert essence(once) == essence(text)


def graph(text: str, scene: str = SCENE) -> str:
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{scene}")
    return serialize(build_graph(case.snapshot, case.uri).graph, "nt")


def test_the_graph_stays_the_same() -> None:
    squeezed = re.sub(r"\s+", " ", MODEL)
    assert graph(lay_out(MODEL), lay_out(SCENE)) == graph(MODEL) == graph(lay_out(squeezed))


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_examples_are_laid_out(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert lay_out(text) == text


def test_foreign_models_mean_the_same_afterwards() -> None:
    for path in corpus(".bdd"):
        text = path.read_text(encoding="utf-8")
        scene = path.with_name("lab.scene").read_text(encoding="utf-8")
        once = lay_out(text)
        assert lay_out(once) == once
        assert graph(once, lay_out(scene)) == graph(text, scene)


def test_an_address_outside_a_string_stays_whole() -> None:
    # A quote too many, or one that is missing, puts the next string outside.
    assert "'https://example.org/x/'" in lay_out("the world's end\nns x = 'https://example.org/x/'\n")
