"""A clause is what the manifest states; its sentence is read where a person wrote it, or an earlier version ran."""

from __future__ import annotations

from dataclasses import replace

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.judging.scenario_clauses import stated_by_step, statement_of
from robbdd_tools.monitor.time import After
from robbdd_tools.protocol.clauses import Fluent, Junction
from robbdd_tools.protocol.specs import ClauseSpec

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
