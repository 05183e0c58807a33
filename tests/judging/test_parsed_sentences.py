"""Reading sentences of features back into clauses, behaviours and events."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.judging.parsed_sentences import read_clause, read_step
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint
from robbdd_tools.protocol.clauses import AnyOf, BehaviourCall, EventOccurrence, Fluent, Junction, Text, fluents_of

AT = '"env:cube" is located at "env:bin_ws"'


def fluent(text: str) -> Fluent:
    found = read_clause(text)
    assert isinstance(found, Fluent)
    return found


@pytest.mark.parametrize(
    ("words", "constraint"),
    [
        ('before event "t:e"', Before("t:e")),
        ('after event "t:e"', After("t:e")),
        ('for 0.5 seconds before event "t:e"', Before("t:e", 0.5)),
        ('for 2 seconds after event "t:e"', After("t:e", 2.0)),
        ('for 1e-05 seconds after event "t:e"', After("t:e", 1e-05)),
        ('from "t:a" until "t:b"', During("t:a", "t:b")),
        ('at some time within 2 seconds after event "t:e"', After("t:e", 2.0, some_time=True)),
        ('at some time within 2 seconds before event "t:e"', Before("t:e", 2.0, some_time=True)),
        ('at some time from "t:a" until "t:b"', During("t:a", "t:b", some_time=True)),
    ],
)
def test_reads_every_time_constraint(words: str, constraint: TimeConstraint) -> None:
    assert fluent(f"{AT} {words}").time == constraint


def test_within_means_throughout_in_the_first_wording_and_nothing_in_the_second() -> None:
    text = f'{AT} within 2 seconds after event "t:e"'
    found = read_clause(text, 1)
    assert isinstance(found, Fluent)
    assert found.time == After("t:e", 2.0)
    assert read_clause(text, 2) == Text(text)
    group = read_clause(f"not ( {text} )", 2)
    assert isinstance(group, Junction)
    assert group.operands == (Text(text),)
    free = 'the lamp is on within 2 seconds after event "t:e"'
    assert read_clause(free, 2) == Text(free)
    assert read_clause(free, 1) == Text("the lamp is on", After("t:e", 2.0))


def test_reads_sets_and_existential_choices_inside_the_quotes() -> None:
    found = fluent("\"['p:a', 'p:b']\" are sorted into \"any of ['p:x', 'p:y']\" after event \"t:e\"")
    assert found.arguments == {"objects": ("p:a", "p:b"), "workspaces": AnyOf(("p:x", "p:y"))}


def test_a_value_may_hold_anything() -> None:
    found = fluent('"env:bin" has config "height" = "0.9 of [the usual" before event "t:e"')
    assert found.arguments["value"] == "0.9 of [the usual"


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("[the usual]", "[the usual]"),
        (r"[a \"door\"]", '[a "door"]'),
        ("any of [them]", "any of [them]"),
        (r"\['a', 'b']", "['a', 'b']"),
        ("any of 'a'", "any of 'a'"),
        ("['a', 2]", ("a", "2")),
        ("any of ['a']", AnyOf(("a",))),
        ("[]", ()),
    ],
)
def test_brackets_are_a_set_only_if_they_list_values(written: str, value: object) -> None:
    assert fluent(f'"env:bin" has config "label" = "{written}" before event "t:e"').arguments["value"] == value


def test_a_text_has_a_condition_if_the_catalog_states_it() -> None:
    found = read_clause('the lamp is on whenever "env:cube" is held by "env:arm" after event "t:e"')
    assert isinstance(found, Text)
    assert (found.words, found.time) == ("the lamp is on", After("t:e"))
    assert found.condition is not None
    assert found.condition.predicate.name == "held-by"
    assert found.condition.arguments == {"object": "env:cube", "agent": "env:arm"}
    free = "the lamp is on whenever it rains"
    assert read_clause(f'{free} after event "t:e"') == Text(free, After("t:e"))
    again = read_clause(f'{free} whenever "env:cube" is held by "env:arm" before event "t:e"')
    assert isinstance(again, Text)
    assert (again.words, again.condition is None) == (free, False)


def test_reads_nested_junctions() -> None:
    text = f'( {AT} after event "t:e" or not ( "env:cube" is held by "env:arm" after event "t:e" ) )'
    found = read_clause(text)
    assert isinstance(found, Junction)
    assert found.operator == "or"
    assert isinstance(found.operands[1], Junction)
    assert found.operands[1].operator == "not"
    assert [one.predicate.name for one in fluents_of(found)] == ["located-at", "held-by"]


def test_reads_an_enumeration_without_parentheses() -> None:
    found = read_clause(f'{AT} before event "t:a" and {AT} after event "t:b"')
    assert isinstance(found, Junction)
    assert (found.operator, len(found.operands)) == ("and", 2)


def test_words_within_quotes_do_not_split_a_sentence() -> None:
    text = '"this and that" is located at "( here or there" after event "t:e"'
    assert fluent(text).arguments == {"object": "this and that", "workspace": "( here or there"}


def test_what_nothing_in_the_catalog_states_is_text() -> None:
    assert read_clause("the lamp is green") == Text("the lamp is green")
    assert read_clause(AT) == Text(AT)


def test_a_part_that_nothing_says_does_not_hide_the_others() -> None:
    found = read_clause(f'( the lamp is green or {AT} after event "t:e" )')
    assert isinstance(found, Junction)
    assert found.operands[0] == Text("the lamp is green")
    assert isinstance(found.operands[1], Fluent)


def test_the_longer_behaviour_is_not_taken_for_the_shorter() -> None:
    both = read_step("when", '"env:arm" picks "env:cube" and places it at "env:bin_ws"')
    pick = read_step("when", '"env:arm" picks "env:cube"')
    assert isinstance(both, BehaviourCall)
    assert isinstance(pick, BehaviourCall)
    assert (both.behaviour.name, pick.behaviour.name) == ("pick-place", "pick")
    assert read_step("when", '"env:arm" juggles "env:cube"') is None


def test_reads_an_event() -> None:
    assert read_step("when", 'event "t:e" occurs') == EventOccurrence("t:e")


@given(st.text(max_size=80))
def test_no_text_raises(text: str) -> None:
    read_clause(text)
    read_step("when", text)


@given(st.text(alphabet='()"andor not', max_size=60))
def test_no_arrangement_of_parentheses_raises(text: str) -> None:
    read_clause(f"( {text} )")


@pytest.mark.parametrize(
    ("written", "value"),
    [
        (r"a \"quoted\" word", 'a "quoted" word'),
        (r"back\\slash", "back\\slash"),
        (r"two\nlines\r\tand a tab", "two\nlines\r\tand a tab"),
        (r"\u00e9t\u00e9", "été"),
        (r"\q", "q"),
    ],
)
def test_what_a_backslash_escapes_is_read(written: str, value: str) -> None:
    found = fluent(f'"env:bin" has config "label" = "{written}" before event "t:e"')
    assert found.arguments["value"] == value


def test_parentheses_of_several_groups_are_not_taken_for_one() -> None:
    held = '"env:cube" is held by "env:arm" after event "t:e"'
    at = f'{AT} after event "t:e"'
    found = read_clause(f"( {at} or {held} ) and ( {held} or {at} )")
    assert isinstance(found, Junction)
    assert found.operator == "and"
    assert [one.operator for one in found.operands if isinstance(one, Junction)] == ["or", "or"]
    found = read_clause(f"not ( {at} ) and not ( {held} )")
    assert isinstance(found, Junction)
    assert [one.operator for one in found.operands if isinstance(one, Junction)] == ["not", "not"]
    assert read_clause(f") {at} (") == Text(f") {at} (")
