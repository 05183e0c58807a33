"""``pred(…)`` takes literals and elements as well as variables: in the graph, in text, in JSON-LD and in sentences."""

from __future__ import annotations

import pytest
from rdflib.compare import isomorphic

from gherkin_kit import model_of, steps
from graph.statements import built, of
from graph.test_text import assert_identity
from kit import MODEL
from robbdd_tools.graph.acceptance_model import Iri, TextFluent, every_clause
from robbdd_tools.graph.rdf.serialize import parse, serialize

GIVEN = "on-bench: holds(<part> is located at <goal>, before <pick-start>)"
PRED = (
    'on-bench: holds(pred("{r} waves {side} {times} times {far} {near}", r=<robot>, side="left \\"hand\\"", times=3, '
    "far=0.5 m, near=<places.bench_ws>), before <pick-start>)"
)
TEXT = MODEL.replace(GIVEN, PRED)


def test_the_values_are_in_the_published_list() -> None:
    found = of(built(TEXT).graph, "t:on-bench")
    assert 'bdd:argument-names ("r" "side" "times" "far" "near")' in found
    (values,) = [one for one in found if one.startswith("bdd:argument-variables")]
    integer, quantity = "http://www.w3.org/2001/XMLSchema#integer", "https://w3id.org/cdt/ucum"
    written = f't:var-robot "left \\"hand\\"" "3"^^<{integer}> "0.5 m"^^<{quantity}> lab:bench_ws'
    assert values == f"bdd:argument-variables ({written})"


def test_the_text_of_the_graph_has_the_same_graph() -> None:
    assert_identity(built(TEXT).graph)


@pytest.mark.parametrize("form", ["json-ld", "json-ld-expanded", "ttl"])
def test_each_form_has_the_same_graph(form: str) -> None:
    graph = built(TEXT).graph
    again = parse(serialize(graph, form), "ttl" if form == "ttl" else "json-ld")
    assert isomorphic(again, graph)


def test_a_literal_stays_text_and_an_element_has_its_iri() -> None:
    clauses = every_clause(model_of(TEXT).stories[0].variants[0].template.clauses)
    (found,) = [clause for clause in clauses if isinstance(clause, TextFluent)]
    robot, bench = Iri("https://example.org/t/var-robot"), Iri("https://example.org/env/bench_ws")
    assert found.arguments == {"r": robot, "side": 'left "hand"', "times": "3", "far": "0.5 m", "near": bench}
    assert [isinstance(value, Iri) for value in found.arguments.values()] == [True, False, False, False, True]


def test_the_sentence_has_the_values() -> None:
    (step,) = [step for step in steps(TEXT) if "waves" in step]
    assert step == 'Given env:panda waves left \\"hand\\" 3 times 0.5 m env:bench_ws before event "t:pick-start"'
