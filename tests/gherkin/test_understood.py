"""The sentence of a clause means the same as its data, to a reader of the feature and to the agent."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from kit import MODELS
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin.steps import StepWriter
from robbdd_tools.gherkin.variations import bindings
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    Cell,
    Clause,
    Condition,
    Exists,
    Fluent,
    Iri,
    Junction,
    TextClause,
    TextFluent,
)
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.judging.parsed_sentences import read_step
from robbdd_tools.judging.scenario_clauses import named_predicates
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint
from robbdd_tools.names.project import Project
from robbdd_tools.protocol import clauses as stated
from robbdd_tools.protocol.clauses import Statement, from_plain, to_plain

MODEL = AcceptanceModel((), {}, {Iri("x:set"): (Iri("x:a"), Iri("x:b"))}, {"x": "x:"})
WRITER = StepWriter(MODEL, load_catalog())
NAME, THING, PLACE, CHOICE = (Iri(f"x:{name}") for name in ("name", "thing", "place", "choice"))
# Words that look like the language around them, and every kind of character that ends something.
TEXT = st.text(st.sampled_from("a \"'\\()[]|\n\u2028é"), max_size=8) | st.sampled_from(
    ["and", "or", "not ( a )", ") or (", "any of ['a']", "['a']", 'a" or "b', "x and y", "( a or b )", " "]
)
SELECTED = [After("x:e", which="every"), Before("x:e", 2.0, 0, True, "first"), After("x:e", 3.0, which="last")]
SOME = [Before("x:e", 2.0, 0, True), After("x:e", 0.1, 0, True), During("x:a", "x:b", (0, 0), True)]
TIMES: st.SearchStrategy[TimeConstraint] = st.sampled_from(
    [Before("x:e"), After("x:e", 0.1), After("x:e", 1e-7), During("x:a", "x:b"), *SOME, *SELECTED]
)
CELLS: st.SearchStrategy[Cell] = TEXT | st.just(THING) | st.lists(TEXT, min_size=1, max_size=2).map(tuple)


def located(time: TimeConstraint) -> Clause:
    return Fluent(NAME, "then", "located-at", {"object": THING, "workspace": PLACE}, time)


def guarded(time: TimeConstraint) -> Clause:
    condition = Condition(NAME, "held-by", {"object": THING, "agent": PLACE})
    return Fluent(NAME, "then", "moves-safely", {"agent": THING}, time, (condition,))


def limited(quantity: str, time: TimeConstraint) -> Clause:
    condition = Condition(NAME, "is-nearer-than", {"one": THING, "distance": "30 cm", "other": PLACE})
    return Fluent(NAME, "then", "moves-slower-than", {"agent": THING, "limit": quantity}, time, (condition,))


def guarded_text(text: str, time: TimeConstraint) -> Clause:
    condition = Condition(NAME, "moves-safely", {"agent": THING})
    return TextFluent(NAME, "then", text, {}, time, (condition,))


def told(text: str, time: TimeConstraint) -> Clause:
    return TextClause(NAME, "then", text, time)


def junction(operator: str, operands: list[Clause]) -> Clause:
    return Junction(NAME, "then", operator, tuple(operands))


def junctions(parts: st.SearchStrategy[Clause]) -> st.SearchStrategy[Clause]:
    several = st.builds(junction, st.sampled_from(["and", "or"]), st.lists(parts, min_size=2, max_size=3))
    return several | st.builds(junction, st.just("not"), st.lists(parts, min_size=1, max_size=1))


SIMPLE: st.SearchStrategy[Clause] = (
    st.builds(located, TIMES)
    | st.builds(told, TEXT, TIMES)
    | st.builds(guarded, TIMES)
    | st.builds(limited, st.sampled_from(["0.25 m/s", "1e-05 m/s"]), TIMES)
    | st.builds(guarded_text, st.sampled_from(["the lamp is on", 'it "is" on']), TIMES)
)


def bare(statement: Statement | None) -> object:
    """What a statement says, without the IRIs that no sentence has; one operand alone is that operand."""
    match statement:
        case stated.Junction("and" | "or", (operand,)):
            return bare(operand)
        case stated.Junction(operator, operands):
            return (operator, *map(bare, operands))
        case stated.Fluent():
            return replace(statement, iri="")
        case stated.BehaviourCall():
            return replace(statement, part="", start="", end="")
        case stated.Text(words, time):
            return "text", _words(words), time, statement.condition
        case _:
            return statement


def _words(text: str) -> str:
    """The words of a text without the signs that keep them apart from a group around them."""
    return re.sub(r"\\(.)", r"\1", text).strip()


def read(sentence: str, role: str = "then") -> object:
    return bare(read_step(role, sentence))


@given(junctions(st.recursive(SIMPLE, junctions, max_leaves=6)), CELLS, CELLS)
@example(junction("and", [told("x and y", Before("x:e")), located(Before("x:e"))]), THING, THING)
def test_groups_are_read_back_as_they_were_written(clause: Clause, thing: Cell, place: Cell) -> None:
    for step in WRITER.steps((clause,), {THING: thing, PLACE: place}):
        assert read(step.text) == bare(step.statement)


@given(CELLS, CELLS, TIMES)
def test_values_are_read_back_as_they_were_written(thing: Cell, place: Cell, time: TimeConstraint) -> None:
    (step,) = WRITER.steps((located(time),), {THING: thing, PLACE: place})
    assert read(step.text) == bare(step.statement)


def test_an_existential_choice_is_read_back_as_one() -> None:
    body = Fluent(NAME, "then", "located-at", {"object": THING, "workspace": CHOICE}, After("x:e"))
    (step,) = WRITER.steps((Exists(NAME, "then", CHOICE, Iri("x:set"), (body,)),), {})
    assert isinstance(step.statement, stated.Fluent)
    assert step.statement.arguments["workspace"] == stated.AnyOf(("x:a", "x:b"))
    assert read(step.text) == bare(step.statement)


def test_a_choice_that_must_do_several_things_is_read_back_as_alternatives() -> None:
    bodies = tuple(
        Fluent(NAME, "then", "located-at", {"object": THING, "workspace": CHOICE}, time)
        for time in (Before("x:e"), After("x:e"))
    )
    (step,) = WRITER.steps((Exists(NAME, "then", CHOICE, Iri("x:set"), bodies),), {})
    found = bare(step.statement)
    assert isinstance(step.statement, stated.Junction)
    assert [one.operator for one in step.statement.operands if isinstance(one, stated.Junction)] == ["and", "and"]
    assert read(step.text) == found


@given(junctions(st.recursive(SIMPLE, junctions, max_leaves=6)), CELLS, CELLS)
def test_what_a_clause_states_survives_json(clause: Clause, thing: Cell, place: Cell) -> None:
    for step in WRITER.steps((clause,), {THING: thing, PLACE: place}):
        assert from_plain(json.loads(json.dumps(to_plain(step.statement)))) == step.statement


@pytest.mark.parametrize("model", [path for path in MODELS if path.suffix == ".bdd"], ids=lambda path: path.name)
def test_every_sentence_of_the_examples_says_what_its_clause_states(model: Path) -> None:
    project = Project()
    uri = path_to_uri(model)
    project.load(uri)
    criteria = read_model(build_graph(project.snapshot(), uri).graph)
    writer = StepWriter(criteria, load_catalog())
    for story in criteria.stories:
        for variant in story.variants:
            values = next(bindings(variant.variation))
            steps = list(writer.steps((*variant.template.clauses, *variant.clauses), values))
            named = named_predicates(step.statement for step in steps)
            for step in steps:
                assert bare(read_step(step.role, step.text, named=named)) == bare(step.statement)
