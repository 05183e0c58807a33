"""Phrases that the catalog does not have are reported once each, with the phrases that they may mean."""

from __future__ import annotations

import pytest

from kit import MODEL
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SyntaxFault
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.symbols import walk

TEMPLATE = MODEL[MODEL.index("Scenario Template") : MODEL.index("User Story")]
GIVEN = "on-bench: holds(<part> is located at <goal>, before <pick-start>)"
NEARER = "<one> is nearer than <distance> to <other>"


def faults(text: str) -> tuple[SyntaxFault, ...]:
    return parse_declaration("bdd", text).faults


def in_clause(phrase: str) -> str:
    text = TEMPLATE.replace(GIVEN, f"on-bench: holds({phrase}, before <pick-start>)")
    assert phrase in text
    return text


@pytest.mark.parametrize(
    ("phrase", "nearest", "fix"),
    [
        ("<part> is lokated at <goal>", "<object> is located at <workspace>", "is located at <goal>"),
        ("<part> is inside <goal>", "<object> is entirely inside <workspace>", "is entirely inside <goal>"),
        ("<part> is in <goal>", "<object> is located at <workspace>", "is located at <goal>"),
        ("<part> sits in <goal>", "<object> is located at <workspace>", None),
        ("<robot> is closer than 3 m to <goal>", NEARER, "is nearer than 3 m to <goal>"),
        ("<robot> doesn't touch <part>", "<one> does not touch <other>", "does not touch <part>"),
        ("<part> stands still", "<object> is at rest", None),
        # Its subject is the object of the nearest phrase.
        ("<robot> grips <part>", "<object> is held by <agent>", None),
        ("<part> is gripped by <robot>", "<object> is held by <agent>", "is held by <robot>"),
    ],
)  # fmt: skip
def test_the_nearest_phrases_are_named_and_written_where_the_values_fit(
    phrase: str, nearest: str, fix: str | None
) -> None:
    text = in_clause(phrase)
    (fault,) = faults(text)
    written = phrase.partition("> ")[2]
    assert text[fault.span.start : fault.span.end] == written
    head, _, listed = fault.message.partition(": the nearest ")
    assert head == f"there is no phrase '{written}'"
    assert listed.removeprefix("is ").removeprefix("are ").split("'")[1] == nearest
    if fix is None:
        assert fault.fix is None
        return
    assert fault.fix is not None
    assert fault.fix.text == fix
    assert faults(text[: fault.fix.span.start] + fix + text[fault.fix.span.end :]) == ()


def test_a_phrase_like_no_other_leads_to_words_of_ones_own() -> None:
    (fault,) = faults(in_clause("<part> glows"))
    assert fault.message.startswith("there is no phrase 'glows': define it by 'Predicate (ns=…) ")
    assert fault.fix is None


def test_several_unknown_phrases_are_reported_once_each_and_keep_their_neighbours() -> None:
    lines = ("a: holds(<part> sits in <goal>, before <end>)", GIVEN, "b: holds(<part> is goldish today, after <end>)")
    text = TEMPLATE.replace(GIVEN, f"( {' and '.join(lines)} )")
    declaration = parse_declaration("bdd", text)
    assert [text[one.span.start : one.span.end] for one in declaration.faults] == ["sits in <goal>", "is goldish today"]
    assert declaration.tree is not None
    names = [node.name.text for node in walk(declaration.tree) if isinstance(node, tree.Fluent)]
    assert names == ["a", "on-bench", "b", "in-tray"]


def test_an_unknown_condition_is_reported_as_well() -> None:
    fault = faults(in_clause("<part> is at rest whenever <robot> is close to <part>"))[0]
    assert fault.message.startswith("there is no phrase 'is close to <part>': the nearest ")


@pytest.mark.parametrize(
    ("phrase", "found", "message"),
    [
        ("<robot> moves slower than 0.25", "0.25", "a number needs a unit here: write for example '0.25 m/s'"),
        ("<robot> is nearer than 3 to <part>", "3", "a number needs a unit here: write for example '3 m'"),
        ("<part> is tilted less than 10", "10", "a number needs a unit here: write for example '10 deg'"),
        ("<robot> is nearer than '3 m' to <part>", "'3 m'", "a quantity is written without quotes"),
        ('<part> is located at "goal"', '"goal"', "names must be in angle brackets, without quotes"),
    ],
)
def test_values_in_another_form_are_explained(phrase: str, found: str, message: str) -> None:
    text = in_clause(phrase)
    fault = faults(text)[0]
    assert text[fault.span.start : fault.span.end] == found
    assert fault.message.startswith(message)


def test_no_synonym_is_a_phrase_of_another_predicate() -> None:
    predicates = load_catalog().predicates
    assert any(word.synonyms for word in predicates.values())
    for word in predicates.values():
        assert len(set(word.synonyms)) == len(word.synonyms), word.name
