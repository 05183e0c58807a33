"""Results of runs beside their model: one graph, one query.

``heights.results.json`` holds four executions of ``examples/tworobots`` as ``robbdd run --json`` wrote them, with some
of their clauses: both arms, the lowest and the tallest bin, the ball.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.ask.query import ready_query, run_query
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.graph.write.run_results import BadResults, add_results, read_results
from robbdd_tools.names.project import Project

RESULTS = (Path(__file__).parent / "heights.results.json").read_text(encoding="utf-8")
CRIT = "https://example.org/robbdd/heights/"


def graph_with(text: str = RESULTS) -> Any:
    project, uri = Project(), path_to_uri(EXAMPLES / "tworobots" / "heights.bdd")
    project.load(uri)
    graph = build_graph(project.snapshot(), uri).graph
    add_results(graph, read_results(text))
    return graph


def answer(query: str, text: str = RESULTS) -> list[tuple[str, ...]]:
    rows = run_query(graph_with(text), query).rows
    return [tuple("" if term is None else term.value.rpartition("/")[2] for term in row) for row in rows]


def test_which_clauses_fail_only_with_the_tall_bin_is_one_query() -> None:
    query = ready_query("fails-only-with")
    assert query is not None
    found = answer(query)
    assert ("at-goal", "var-scale", "1.1", "1") in found
    assert ("goal-untouched", "var-scale", "1.1", "1") in found
    assert {clause for clause, *_ in found} == {"at-goal", "goal-untouched"}
    assert ("at-goal", "var-robot", "ur10", "1") in found


def test_a_clause_that_fails_with_other_values_too_does_not_fail_only_with_one() -> None:
    document = json.loads(RESULTS)
    low = next(entry for entry in document["scenarios"] if entry["values"]["crit:var-scale"] == 0.8)
    next(clause for clause in low["clauses"] if clause["name"] == "at-goal")["verdict"] = "violated"
    found = answer(ready_query("fails-only-with") or "", json.dumps(document))
    assert "at-goal" not in {clause for clause, variable, *_ in found if variable == "var-scale"}


def test_verdicts_are_counted_with_their_smallest_margin() -> None:
    found = {row[0]: row[1:] for row in answer(ready_query("verdicts") or "")}
    document = json.loads(RESULTS)
    margins = [c["robustness"] for s in document["scenarios"] for c in s["clauses"] if c["name"] == "at-goal"]
    assert found["at-goal"] == ("3", "1", "0", str(min(margins)), "m")


def test_an_execution_is_an_activity_with_its_values_and_simulated_time() -> None:
    rows = answer(
        """SELECT ?value ?seconds { ?execution a prov:Activity, rbw:ScenarioRun ; rbw:duration-seconds ?seconds ;
           rbw:of-variant ?variant ; rbw:given-value ?given . ?variant a bdd:ScenarioVariant .
           ?given rbw:of-variable ?variable ; rbw:is-value ?value . ?value a agn:Agent }"""
    )
    durations = sorted(str(float(entry["duration"])) for entry in json.loads(RESULTS)["scenarios"])
    assert sorted(seconds for _, seconds in rows) == durations
    assert {value for value, _ in rows} == {"panda", "ur10"}


def test_a_judgement_is_an_assertion_about_a_clause_of_the_model() -> None:
    rows = answer(
        """SELECT DISTINCT ?clause { ?assertion a earl:Assertion ; earl:test ?clause ; earl:mode earl:automatic ;
           earl:result/earl:outcome earl:failed ; prov:wasGeneratedBy ?execution . ?clause a bdd:FluentClause }"""
    )
    assert {row[0] for row in rows} == {"at-goal", "goal-untouched"}


def test_the_same_results_give_the_same_bytes_in_whatever_order_their_fields_stand() -> None:
    turned = json.dumps(json.loads(RESULTS), sort_keys=True)
    assert serialize(graph_with(), "ttl") == serialize(graph_with(turned), "ttl")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("nothing", "not JSON"),
        ("[]", "the document is not an object"),
        ('{"seed": 1, "complete": true}', "'scenarios' of the run is missing"),
        ('{"seed": "1", "complete": true, "scenarios": []}', "'seed' of the run is not of the expected type"),
        (RESULTS.replace('"violated"', '"broken"'), "is 'broken', not one of holds, violated, unknown"),
    ],
)
def test_what_is_no_result_is_refused_with_its_place(text: str, words: str) -> None:
    with pytest.raises(BadResults, match=words):
        graph_with(text)
