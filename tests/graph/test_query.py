"""SPARQL over a model's graph: prefixes, order, built-in queries checked against the text, nothing fetched."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec

import pytest
from rdflib import Graph

from graph.models import EVERYTHING
from graph.statements import built
from kit import EXAMPLES, MODEL
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.graph.ask.query import BadQuery, Rows, Term, ready_queries, ready_query, run_query
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project


@cache
def example(name: str) -> Graph:
    uri, project = path_to_uri(EXAMPLES / name), Project()
    project.load(uri)
    return build_graph(project.snapshot(), uri).graph


def absent(_name: str) -> None:
    """Say of every module that it is not installed."""


def answer(query: str, text: str = MODEL) -> Rows:
    return run_query(built(text).graph, query)


def local(rows: Rows) -> list[tuple[str, ...]]:
    values = [["" if cell is None else cell.value for cell in row] for row in rows.rows]
    return [tuple(value.replace("#", "/").rpartition("/")[2] for value in row) for row in values]


def ready(name: str, text: str = MODEL) -> list[tuple[str, ...]]:
    query = ready_query(name)
    assert query is not None
    return local(answer(query, text))


def test_the_users_prefixes_and_the_vocabularys_are_declared() -> None:
    assert local(answer("SELECT ?c { t:bench-to-tray bdd:of-template/bdd:has-clause/rdf:first ?c }")) == [("on-bench",)]


def test_rows_are_sorted_unless_the_query_orders_them() -> None:
    events = ["end", "pick-start", "place-end", "start"]
    assert local(answer("SELECT ?e { ?e a time:Event }")) == [(event,) for event in events]
    assert local(answer("SELECT ?e { ?e a time:Event } ORDER BY DESC(?e)")) == [(event,) for event in events[::-1]]


def test_ask_and_construct_are_answered_as_rows() -> None:
    assert answer("ASK { t:start a time:Event }").rows == (
        (Term("literal", "true", "http://www.w3.org/2001/XMLSchema#boolean"),),
    )
    made = answer("CONSTRUCT { ?e a rbw:Thing } WHERE { ?e a time:Event }")
    assert made.columns == ("subject", "predicate", "object")
    assert len(made.rows) == 4


@pytest.mark.parametrize(
    ("query", "offset", "words"),
    [
        ("SELECT ?x WHERE { ?x a nope:Thing }", 23, "the prefix 'nope' is not declared; there are"),
        ("SELEKT ?x", 0, "cannot be parsed from here on"),
        ("SELECT ?x { SERVICE <https://example.org/> { ?x ?y ?z } }", 12, "SERVICE and FROM are not followed"),
        ("SELECT ?x FROM <https://example.org/> { ?x ?y ?z }", 10, "SERVICE and FROM are not followed"),
        ("INSERT DATA { t:a t:b t:c }", 0, "cannot be parsed from here on"),
        ("", 0, "cannot be parsed from here on"),
    ],
)
def test_a_bad_query_is_refused_at_its_place(query: str, offset: int, words: str) -> None:
    with pytest.raises(BadQuery, match=words) as caught:
        answer(query)
    assert caught.value.offset == offset


def test_every_ready_query_tells_what_it_is_for_and_can_be_asked_of_anything() -> None:
    assert all(tells.endswith(".") for tells in ready_queries().values())
    for name in ready_queries():
        query = ready_query(name)
        assert query is not None
        assert len(run_query(Graph(), query).columns) > 0
        run_query(built(EVERYTHING).graph, query)
    assert ready_query("no-such") is None


def test_which_clauses_speak_of_a_workspace() -> None:
    assert ready("clauses-by-workspace") == [
        (workspace, "bench-to-tray", clause, "var-goal")
        for workspace in ("bench_ws", "tray_ws")
        for clause in ("in-tray", "on-bench", "when-bhv-fetch.when")
    ]


def test_a_workspace_counts_only_for_the_variable_that_gets_it() -> None:
    found = ready("clauses-by-workspace", EVERYTHING)
    assert {row for row in found if row[1] == "table" and row[2] in ("at", "placed")} == {
        ("bench_ws", "table", "at", "var-goal"),
        ("tray_ws", "table", "at", "var-goal"),
    }
    assert ("tray_ws", "product", "sorted", "var-bins") in found
    assert not [row for row in found if row[3] in ("var-parts", "var-robot")]


def test_which_events_time_nothing() -> None:
    assert ready("idle-events") == []
    assert ready("idle-events", MODEL.replace("Event (ns=t) end\n", "Event (ns=t) end\nEvent (ns=t) idle\n")) == [
        ("idle",)
    ]


def test_how_often_predicates_are_used() -> None:
    assert ready("predicate-coverage") == [("LocatedAtPredicate", "2", "1")]
    counts = {name: (clauses, variants) for name, clauses, variants in ready("predicate-coverage", EVERYTHING)}
    assert counts["LocatedAtPredicate"] == ("3", "2")
    assert counts["CanReach"] == ("3", "4")
    assert counts["SortedIntoPredicate"] == ("7", "2")


def test_when_clauses_have_to_hold() -> None:
    assert ("in-tray", "place-end", "", "0.5") in ready("clause-times")


def test_what_no_variation_uses() -> None:
    assert ready("idle-elements") == [("ur10", "Agent"), ("bench", "Object"), ("tray", "Object")]


def test_what_variants_there_are() -> None:
    assert ready("variants") == [("fetching", "bench-to-tray", "fetch", "bench_scene")]


@pytest.mark.parametrize("name", sorted(ready_queries()))
@pytest.mark.parametrize(
    "model", ["ownrobot/tidy.bdd", "pickplace/pickplace.bdd", "sorting/sorting.bdd", "tworobots/heights.bdd"]
)
def test_both_engines_give_the_same_rows(model: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert find_spec("oxrdflib") is not None
    text, graph = ready_query(name) or "", example(model)
    fast = run_query(graph, text)
    monkeypatch.setattr("robbdd_tools.graph.ask.query.find_spec", absent)
    assert run_query(graph, text) == fast


@pytest.mark.parametrize(
    "text",
    [
        "SELECT ?s ?v { ?s ?p ?v FILTER(isLiteral(?v)) }",
        "SELECT (SUM(?v) AS ?sum) (MAX(?v) AS ?most) { ?s time:horizon-seconds ?v }",
        "SELECT ?s (STRLEN(STR(?s)) AS ?n) (1.50 AS ?d) { ?s a time:Event }",
        "ASK { ?s a time:Event }",
        "CONSTRUCT { ?s a ?k } WHERE { ?s a ?k FILTER(isIRI(?s)) }",
    ],
)
def test_both_engines_write_numbers_and_triples_alike(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    graph = example("pickplace/pickplace.bdd")
    fast = run_query(graph, text)
    assert fast.rows
    monkeypatch.setattr("robbdd_tools.graph.ask.query.find_spec", absent)
    assert run_query(graph, text) == fast
