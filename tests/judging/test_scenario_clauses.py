"""A clause is read from the manifest; its sentence is parsed only if edited by hand or from an earlier version."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.judging.scenario_clauses import (
    behaviour_calls,
    clause_of,
    iteration_of,
    judged_clause,
    stated_by_step,
    statement_of,
)
from robbdd_tools.monitor.time import After
from robbdd_tools.protocol.clauses import BehaviourCall, EventOccurrence, Fluent, Junction, Text, leaves_of
from robbdd_tools.protocol.specs import ClauseSpec
from world.worlds import scenario

LEFT, RIGHT = (
    Fluent(load_catalog().predicates["located-at"], {"object": "t:a", "workspace": f"t:{place}"}, After("t:e"), place)
    for place in ("l", "r")
)
SENTENCE = '( "t:a" is located at "t:l" after event "t:e" or "t:a" is located at "t:r" after event "t:e" )'
KNOWN = ClauseSpec(5, "t:c", "c", "then", SENTENCE, Junction("or", (LEFT, RIGHT)), ("l", "r"))


def test_a_step_states_what_the_manifest_has_whatever_its_words_are() -> None:
    worded = replace(KNOWN, sentence="in one of the bins")
    assert stated_by_step("then", "in one of the bins", worded) == Junction("or", (LEFT, RIGHT))


def test_a_sentence_that_a_person_has_edited_is_read() -> None:
    edited = SENTENCE.replace(" or ", " and ")
    assert stated_by_step("then", edited, KNOWN) == Junction("and", (LEFT, RIGHT))


def test_a_clause_of_an_earlier_version_is_read_from_its_sentence() -> None:
    assert statement_of(replace(KNOWN, statement=None)) == KNOWN.statement


def test_a_sentence_names_its_parts_in_order() -> None:
    read = statement_of(replace(KNOWN, statement=None, parts=("l",)))
    assert isinstance(read, Junction)
    assert [leaf.iri for leaf in leaves_of(read)] == ["l", ""]
    single = statement_of(replace(KNOWN, statement=None, sentence="the lamp is green", parts=()))
    assert single == Text("the lamp is green", None, "t:c")


def test_a_step_without_a_clause_is_read() -> None:
    assert stated_by_step("then", "the lamp is green", None) == Text("the lamp is green")
    assert stated_by_step("when", 'event "t:e" occurs', None) == EventOccurrence("t:e")


def test_an_edited_sentence_is_read_in_the_wording_of_its_feature_and_a_stored_one_in_the_first() -> None:
    within = '"t:a" is located at "t:l" within 2 seconds after event "t:e"'
    throughout = replace(LEFT, time=After("t:e", 2.0), iri="l")
    assert stated_by_step("then", within, KNOWN, 1) == throughout
    assert stated_by_step("then", within, KNOWN, 2) == Text(within, iri="l")
    assert statement_of(replace(KNOWN, statement=None, sentence=within, parts=("l",))) == throughout


WHEN = ClauseSpec(2, "t:w", "w", "when", '"env:arm" picks "env:cube"')


def test_when_clauses_keep_their_content() -> None:
    assert statement_of(replace(WHEN, sentence='event "t:e" occurs')) == EventOccurrence("t:e")
    call = statement_of(WHEN)
    assert isinstance(call, BehaviourCall)
    assert call.arguments == {"agent": "env:arm", "object": "env:cube"}
    assert statement_of(replace(WHEN, sentence="somebody sings")) is None


def test_a_when_clause_is_not_judged() -> None:
    for sentence in (WHEN.sentence, 'event "t:e" occurs', "somebody sings"):
        with pytest.raises(TypeError, match=f"^{re.escape(sentence)} is a When clause$"):
            clause_of(replace(WHEN, sentence=sentence), scenario())


def test_a_clause_is_judged_in_its_iterations() -> None:
    found = clause_of(replace(KNOWN, iterations=(2, 4)), scenario())
    assert found == Junction("or", tuple(replace(one, time=After("t:e", None, 4)) for one in (LEFT, RIGHT)))
    given = replace(KNOWN, role="given", statement=LEFT, iterations=(2, 4))
    assert clause_of(given, scenario()) == replace(LEFT, time=After("t:e", None, 2))
    assert judged_clause(LEFT, None, scenario()) == LEFT
    assert judged_clause(Text("green"), KNOWN, scenario()) == Text("green")


def test_the_behaviours_of_a_scenario_are_those_of_its_when_clauses() -> None:
    placing = replace(WHEN, sentence='"env:arm" picks "env:cube" and places it at "t:l"')
    event = replace(WHEN, sentence='event "t:e" occurs')
    named = replace(KNOWN, sentence=WHEN.sentence, statement=None)
    calls = behaviour_calls(scenario(clauses=(named, WHEN, event, placing)))
    assert [call.behaviour.name for call, _ in calls] == ["pick", "pick-place"]


def test_a_when_clause_expects_its_event_in_its_first_iteration() -> None:
    assert iteration_of(replace(WHEN, iterations=(3, 5))) == 3
    assert iteration_of(WHEN) == iteration_of(None) == 0
