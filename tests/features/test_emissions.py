"""``emits pick-end as <event>``: checks, hover, completion, layout, graph, text, and the events of a run."""

from __future__ import annotations

from pathlib import Path

from rdflib.compare import isomorphic

from checks.models import found, marked
from features.test_completion import labels
from features.test_hover import shown
from graph.statements import built
from graph.test_text import assert_identity
from kit import MODEL
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.document import Document
from robbdd_tools.features.layout import lay_out
from robbdd_tools.graph.acceptance_model import BehaviourClause
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.foreign import read_graph_file
from run.test_scenario_specs import specs

ACTION = "<robot> picks <part> and places at <goal>"
TEXT = (
    MODEL.replace("Event (ns=t) end\n", "Event (ns=t) end\nEvent (ns=t) in-hand\n")
    .replace(ACTION, f"{ACTION}\n            emits pick-end as <in-hand>")
    .replace("0.5 seconds after <place-end>", "after <in-hand>")
)


def codes(text: str) -> list[str]:
    return [one.code for one in found(text) if one.severity <= Severity.WARNING and one.code != "no-model"]


def test_a_clause_may_wait_for_an_event_that_the_behaviour_emits_under_another_name() -> None:
    assert codes(TEXT) == []
    assert codes(TEXT.replace("            emits pick-end as <in-hand>\n", "")) == ["no-emitter"]


def test_a_run_stamps_the_event_of_the_model_when_the_behaviour_emits_its_own(tmp_path: Path) -> None:
    first, *_ = specs(tmp_path, TEXT)
    assert first.events["t:in-hand"] == "pick-end"


def test_what_is_stated_counts_more_than_a_name(tmp_path: Path) -> None:
    text = TEXT.replace("in-hand", "place-start")
    first, *_ = specs(tmp_path, text)
    assert first.events["t:place-start"] == "pick-end"


def test_an_event_that_the_behaviour_does_not_have_is_an_error_with_its_events() -> None:
    text = TEXT.replace("emits pick-end", "emits pick-ends")
    (only,) = found(text, "emission")
    assert only.message == (
        "'pick-place' does not emit 'pick-ends': it emits pick-start, pick-end, place-start, place-end"
    )
    assert [edit.text for edit in only.fixes[0].edits] == ["pick-end"]
    assert marked(text, "emits «pick-ends» as", "emission").count("^^^^^^^^^ emission") == 1


def test_one_event_is_emitted_once() -> None:
    again = TEXT.replace("as <in-hand>\n", "as <in-hand>\n            emits place-start as <in-hand>\n")
    assert codes(again) == ["emission"]


def test_hover_and_completion_know_emissions() -> None:
    told = shown(TEXT.replace("emits pick-end", "emits pick-$0end"))
    assert told == "When the behaviour emits its own event `pick-end`, the event `in-hand` of the model occurs."
    assert labels(TEXT.replace("emits pick-end", "emits $0pick-end")) == [
        *(
            "close-start",
            "close-end",
            "hand-over-start",
            "laid-down",
            "hand-over-end",
            "move-start",
            "move-end",
            "open-start",
            "open-end",
        ),
        *("pick-start", "pick-end", "place-start", "place-end", "push-start", "push-end"),
    ]
    offered = labels(TEXT.replace("emits pick-end as <in-hand>", "emits pick-end as <$0>"))
    assert "in-hand" in offered
    assert "emits" in labels(TEXT.replace("emits pick-end as <in-hand>", "$0"))


def test_a_misspelt_word_is_mended_and_costs_nothing_else() -> None:
    broken = TEXT.replace("emits pick-end as", "emit pick-end as")
    assert [one.code for one in found(broken) if one.severity is Severity.ERROR] == ["syntax"]


def test_layout_leaves_an_emission_on_its_line() -> None:
    squeezed = TEXT.replace("            emits pick-end as <in-hand>", "  emits   pick-end  as < in-hand >")
    assert "\n            emits pick-end as <in-hand>\n" in lay_out(squeezed)


def test_the_graph_states_emissions_and_gives_them_back() -> None:
    graph = built(TEXT).graph
    text = serialize(graph, "ttl")
    assert 'a rbw:Emission ;\n    rbw:event t:in-hand ;\n    rbw:moment "pick-end"' in text
    assert "rbw:emission-list ( t:emits-fetch.when.0 )" in text
    assert_identity(graph)
    model = read_model(graph)
    (clause,) = [one for one in model.stories[0].variants[0].template.clauses if isinstance(one, BehaviourClause)]
    assert clause.emits == (("pick-end", "https://example.org/t/in-hand"),)


def test_emissions_go_through_json_ld() -> None:
    graph = built(TEXT).graph
    again = parse(serialize(graph, "json-ld"), "json-ld")
    assert isomorphic(again, graph)


def test_an_emission_of_a_foreign_graph_needs_an_event_and_its_name() -> None:
    text = serialize(built(TEXT).graph, "ttl")
    for old, new, code in (
        ("rbw:event t:in-hand ;\n    ", "", "shacl-emission-event"),
        ('rbw:moment "pick-end"', "rbw:moment 3", "shacl-emission-moment"),
    ):
        assert old in text
        broken = Document("file:///m.ttl", 1, text.replace(old, new, 1))
        assert code in [one.code for one in validate(read_graph_file(broken))]
