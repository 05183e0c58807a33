"""Events that a template defines, and several conditions of a clause: triples, text, sentences, manifest."""

from __future__ import annotations

import json

import pytest
from rdflib import URIRef

from gherkin_kit import feature, model_of, pieces, steps
from graph.statements import built, of
from graph.test_text import assert_identity
from kit import EVENTS, STORY, TEMPLATE, fixture
from robbdd_tools.features.hover import hover
from robbdd_tools.features.rename import rename
from robbdd_tools.graph.acceptance_model import Iri, Variant
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.protocol.clauses import DefinedEvent, Fluent, from_plain, to_plain
from robbdd_tools.protocol.spec_changes import edited_clauses
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run.emitters import emitters_of
from robbdd_tools.run.related_scenarios import Relations
from robbdd_tools.run.scenario_specs import SpecWriter

NEAR = "event near when <robot> is nearer than 0.5 m to <goal> and <part> is held by <robot>"
DEFINED = TEMPLATE.replace(
    "    Given:",
    f"    var wait\n    {NEAR}\n    event parked when <robot> is at rest for <wait> seconds\n"
    "    event put when <part> is located at <goal> for 0.5 seconds\n    Given:",
).replace("<robot> is at rest", "<part> is at rest")
CLAUSE = """in-tray: holds(
            <part> is located at <goal> whenever <part> is held by <robot> and <robot> is nearer than 1 m to <goal>,
            0.5 seconds after every <near>
        )"""
TEMPLATES = EVENTS + DEFINED.replace(
    "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)", CLAUSE
)
WHOLE = TEMPLATES + STORY.replace("variation:\n", "variation:\n                var <fetch.wait>: { 2, 0.25 }\n")
T = "https://example.org/t/"


def test_the_conditions_of_an_event_are_nodes_in_order() -> None:
    graph = built(WHOLE).graph
    assert "rbw:defined-events (t:near t:parked t:put)" in of(graph, "t:fetch")
    assert {*of(graph, "t:near")} == {
        "a rbw:DefinedEvent",
        "a time:Event",
        "rbw:occurs-when t:occurs-when-fetch.near",
        "rbw:occurs-when t:occurs-when-fetch.near.1",
    }
    assert "rbw:distance 0.5 m" in " ".join(of(graph, "t:occurs-when-fetch.near")).replace('"', "").replace(
        "^^<https://w3id.org/cdt/ucum>", ""
    )
    assert "rbw:horizon-variable t:var-wait" in of(graph, "t:parked")
    assert {"rbw:whenever t:whenever-fetch.in-tray", "rbw:whenever t:whenever-fetch.in-tray.1"} < {
        *of(graph, "t:in-tray")
    }


def test_a_template_without_defined_events_has_no_such_list() -> None:
    assert "defined-events" not in " ".join(of(built(EVENTS + TEMPLATE + STORY).graph, "t:fetch"))


def test_the_text_of_the_graph_has_the_same_graph() -> None:
    assert_identity(built(WHOLE).graph)


def test_an_event_without_condition_violates_the_shapes() -> None:
    whole = built(WHOLE)
    assert not validate(whole)
    whole.graph.remove((URIRef(f"{T}parked"), URIRef(expand("rbw:occurs-when")), None))
    assert [entry.code for entry in validate(whole)] == ["shacl-defined-event-conditions"]


def test_the_feature_states_the_definitions_and_the_conditions() -> None:
    text = feature(WHOLE)
    assert (
        '    # event "t:near" occurs when "env:panda" is nearer than "0.5 m" to "env:bench_ws" '
        'and "env:bolt" is held by "env:panda"\n'
    ) in text
    assert '# event "t:parked" occurs when "env:bolt" is at rest for 2 seconds\n' in text
    assert '# event "t:parked" occurs when "env:bolt" is at rest for 0.25 seconds\n' in text
    then = steps(WHOLE)[-1].removeprefix("Then ")
    assert then == (
        '"env:bolt" is located at "env:bench_ws" whenever "env:bolt" is held by "env:panda" '
        'and "env:panda" is nearer than "1 m" to "env:bench_ws" for 0.5 seconds after every event "t:near"'
    )
    read = read_clause(then)
    assert isinstance(read, Fluent)
    assert read.condition is not None
    assert [one.predicate.name for one in read.condition.parts] == ["held-by", "is-nearer-than"]
    assert from_plain(json.loads(json.dumps(to_plain(read)))) == read


def test_the_outline_states_the_definitions_with_its_columns() -> None:
    assert '# event "t:near" occurs when "<robot>" is nearer than "0.5 m" to "<goal>"' in feature(WHOLE, "compact")


def spec(text: str) -> tuple[ScenarioSpec, Variant]:
    model = model_of(text)
    variant = model.stories[0].variants[0]
    scenario = next(piece.scenario for piece in pieces(text) if piece.scenario)
    return next(iter(SpecWriter(model, 1, Relations(model)).specs("f", model.stories[0].iri, scenario))), variant


def test_the_manifest_has_the_definitions_with_values() -> None:
    found, variant = spec(WHOLE)
    near, parked, put = found.defined
    assert [one.predicate.name for one in near.conditions] == ["is-nearer-than", "held-by"]
    assert near.conditions[0].arguments == {"one": "env:panda", "distance": "0.5 m", "other": "env:bench_ws"}
    assert (parked.name, parked.seconds, put.seconds) == ("t:parked", 2.0, 0.5)
    assert isinstance(near, DefinedEvent)
    assert {emitters_of(variant, None)[Iri(T + name)] for name in ("near", "parked", "put")} == {"defined"}


def test_a_clause_is_judged_again_if_the_definition_of_its_event_changes() -> None:
    before, _ = spec(WHOLE)
    after, _ = spec(WHOLE.replace("nearer than 0.5 m", "nearer than 0.4 m"))
    assert [clause.name for clause in edited_clauses(after, before)] == ["in-tray"]
    other, _ = spec(
        WHOLE.replace("at rest for", "at rest  for").replace("located at <goal> for 0.5", "located at <goal> for 1")
    )
    assert not edited_clauses(other, before)


def test_hover_shows_the_definition() -> None:
    case = fixture(WHOLE.replace("after every <near>", "after every <ne$0ar>"))
    found = hover(case.snapshot, case.uri, case.cursor)
    assert found is not None
    sentence = "near occurs when `<robot>` is nearer than 0.5 m to `<goal>` and `<part>` is held by `<robot>`"
    assert sentence in found.markdown
    assert "If it is true from the beginning, it first has to become false." in found.markdown


@pytest.mark.parametrize("place", ["start", "part"])
def test_an_event_is_renamed_with_its_uses(place: str) -> None:
    name = "near" if place == "start" else "parked"
    case = fixture(WHOLE.replace(f"event {name} when", f"event {name[:2]}$0{name[2:]} when"))
    edits = rename(case.snapshot, case.uri, case.cursor, "close-by")
    assert len(edits) == (2 if name == "near" else 1)
