"""What we write into a feature, the agent reads back as the same clause."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin.steps import StepWriter
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Cell, Clause, Exists, Fluent, Iri, Junction, TextClause
from robbdd_tools.judging import parsed_sentences as read
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint

MODEL = AcceptanceModel((), {}, {Iri("x:set"): (Iri("x:a"), Iri("x:b"))}, {"x": "x:"})
WRITER = StepWriter(MODEL, load_catalog())
NAME, THING, PLACE, CHOICE = (Iri(f"x:{name}") for name in ("name", "thing", "place", "choice"))
# Words that look like the language around them, and every kind of character that ends something.
TEXT = st.text(st.sampled_from("a \"'\\()[]|\n\u2028é"), max_size=8) | st.sampled_from(
    ["and", "or", "not ( a )", ") or (", "any of ['a']", "['a']", 'a" or "b', "x and y", "( a or b )", " "]
)
TIMES: st.SearchStrategy[TimeConstraint] = st.sampled_from(
    [Before("x:e"), After("x:e", 0.1), After("x:e", 1e-7), During("x:a", "x:b")]
)
CELLS: st.SearchStrategy[Cell] = TEXT | st.just(THING) | st.lists(TEXT, min_size=1, max_size=2).map(tuple)


def located(time: TimeConstraint) -> Clause:
    return Fluent(NAME, "then", "located-at", {"object": THING, "workspace": PLACE}, time)


def told(text: str, time: TimeConstraint) -> Clause:
    return TextClause(NAME, "then", text, time)


def junction(operator: str, operands: list[Clause]) -> Clause:
    return Junction(NAME, "then", operator, tuple(operands))


def junctions(parts: st.SearchStrategy[Clause]) -> st.SearchStrategy[Clause]:
    several = st.builds(junction, st.sampled_from(["and", "or"]), st.lists(parts, min_size=2, max_size=3))
    return several | st.builds(junction, st.just("not"), st.lists(parts, min_size=1, max_size=1))


SIMPLE: st.SearchStrategy[Clause] = st.builds(located, TIMES) | st.builds(told, TEXT, TIMES)


def shape(clause: Clause) -> object:
    """The structure of a clause that is written."""
    match clause:
        case Junction(operator=operator, operands=operands):
            return (operator, *map(shape, operands))
        case Fluent(time=time):
            return time
        case _:
            return "text"


def shape_read(clause: read.Clause) -> object:
    """The structure of a clause that was read."""
    match clause:
        case read.Junction(operator, operands):
            return (operator, *map(shape_read, operands))
        case read.Fluent(time=time):
            return time
        case read.Unmatched():
            return "text"


@given(junctions(st.recursive(SIMPLE, junctions, max_leaves=6)), CELLS, CELLS)
def test_groups_are_read_back_as_they_were_written(clause: Clause, thing: Cell, place: Cell) -> None:
    sentence = WRITER.sentence(clause, {THING: thing, PLACE: place})
    assert shape_read(read.read_clause(sentence)) == shape(clause)


@given(CELLS, CELLS, TIMES)
def test_values_are_read_back_as_they_were_written(thing: Cell, place: Cell, time: TimeConstraint) -> None:
    (sentence,) = WRITER.steps((located(time),), {THING: thing, PLACE: place})
    found = read.read_clause(sentence.text)
    assert isinstance(found, read.Fluent)
    assert (found.arguments, found.time) == ({"object": thing, "workspace": place}, time)


def test_an_existential_choice_is_read_back_as_one() -> None:
    body = Fluent(NAME, "then", "located-at", {"object": THING, "workspace": CHOICE}, After("x:e"))
    (step,) = WRITER.steps((Exists(NAME, "then", CHOICE, Iri("x:set"), (body,)),), {})
    found = read.read_clause(step.text)
    assert isinstance(found, read.Fluent)
    assert found.arguments["workspace"] == read.AnyOf(("x:a", "x:b"))


def test_a_choice_that_must_do_several_things_is_read_back_as_alternatives() -> None:
    bodies = tuple(
        Fluent(NAME, "then", "located-at", {"object": THING, "workspace": CHOICE}, time)
        for time in (Before("x:e"), After("x:e"))
    )
    (step,) = WRITER.steps((Exists(NAME, "then", CHOICE, Iri("x:set"), bodies),), {})
    one = ("and", Before("x:e"), After("x:e"))
    assert shape_read(read.read_clause(step.text)) == ("or", one, one)
