"""A behaviour is linked to a node of a coordination model that RobBDD does not execute, by the node's IRI."""

from __future__ import annotations

import pytest

from checks.models import found
from graph.statements import built, of
from graph.test_text import assert_identity
from kit import EVENTS, FOLDER, SCENE, STORY, TEMPLATE, Fixture, fixture
from robbdd_tools.base.document import Document, Span
from robbdd_tools.features.completion import complete
from robbdd_tools.features.format_range import format_range
from robbdd_tools.features.hover import hover
from robbdd_tools.features.outside_names import outside_name_at, outside_references
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.shapes.validate import validate

ACTION = "<robot> picks <part> and places at <goal>\n"
NODE = "https://example.org/states#grasping"
LINKED = EVENTS + TEMPLATE.replace(ACTION, f'{ACTION}            node: "{NODE}"\n') + STORY
STATES = """@prefix fsm: <https://example.org/states#> .
@prefix env: <https://example.org/env/> .
fsm:grasping a fsm:State ; fsm:next fsm:carrying .
fsm:carrying a fsm:State .
env:bolt fsm:weight 3 .
"""


def importing(text: str) -> Fixture:
    return fixture(f'//- main.bdd\nimport "states.ttl"\n{text}//- lab.scene\n{SCENE}//- states.ttl\n{STATES}')


def test_the_link_is_in_the_graph_and_in_json_ld() -> None:
    graph = built(LINKED).graph
    assert f"rbw:external-node <{NODE}>" in of(graph, "t:carry")
    json_ld = serialize(graph, "json-ld")
    assert f'"external-node": "{NODE}"' in json_ld
    assert serialize(parse(json_ld, "json-ld"), "nt") == serialize(graph, "nt")


def test_the_graph_is_written_back_as_text() -> None:
    assert_identity(built(LINKED).graph)


def test_the_graph_fits_the_shapes_and_a_run_ignores_the_link() -> None:
    assert validate(built(LINKED)) == []
    (story,) = read_model(built(LINKED).graph).stories
    plain = read_model(built(EVENTS + TEMPLATE + STORY).graph).stories[0]
    assert story.variants[0].template.clauses == plain.variants[0].template.clauses


@pytest.mark.parametrize("node", ["grasping", "", "a b://c", "https://example.org/ x"])
def test_the_node_is_an_absolute_iri(node: str) -> None:
    (one,) = found(f"//- main.bdd\n{LINKED.replace(NODE, node)}//- lab.scene\n{SCENE}", "namespace-iri")
    assert one.message.startswith(f"'{node}' is not an absolute IRI: write that of a node, such as ")
    assert of(built(LINKED.replace(NODE, node)).graph, "t:carry") == of(
        built(EVENTS + TEMPLATE + STORY).graph, "t:carry"
    )


def test_hover_definition_and_references_use_an_imported_graph() -> None:
    case = importing(LINKED.replace("grasping", "gra$0sping"))
    shown = hover(case.snapshot, case.uri, case.cursor)
    assert shown is not None
    assert "type `fsm:State`" in shown.markdown
    named = outside_name_at(case.snapshot, case.uri, case.cursor)
    place = None if named is None else named.definition()
    assert place is not None
    assert (place.uri, place.text[place.span.start : place.span.end]) == (f"{FOLDER}states.ttl", "fsm:grasping")
    uses, _ = outside_references(case.snapshot, case.uri, case.cursor)
    assert [uri for uri, _ in uses] == [case.uri]


def test_without_a_graph_hover_says_that_the_link_is_exported_only() -> None:
    case = fixture(LINKED.replace("grasping", "gra$0sping"))
    shown = hover(case.snapshot, case.uri, case.cursor)
    assert shown is not None
    assert "exported only" in shown.markdown


def test_nodes_of_imported_graphs_are_completed() -> None:
    case = importing(LINKED.replace(NODE, "https://example.org/st$0"))
    offered = [one.label for one in complete(case.snapshot, case.uri, case.cursor)]
    assert offered == [f"https://example.org/states#{name}" for name in ("carrying", "grasping")]


def test_the_formatter_keeps_the_link() -> None:
    document = Document("file:///main.bdd", 0, LINKED.replace("            node", "  node  "))
    changed = format_range(document, Span(0, len(document.text)))
    text = document.text
    for edit in sorted(changed, key=lambda one: one.span, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert text == LINKED
