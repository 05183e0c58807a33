"""A When with several behaviours: its triples, its text, its sentences, and the emitters of its events."""

from __future__ import annotations

import pytest
from rdflib import URIRef

from gherkin_kit import model_of, steps
from graph.statements import built, of
from graph.test_text import assert_identity
from kit import EVENTS, STORY, TEMPLATE
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.graph.acceptance_model import BehaviourClause
from robbdd_tools.graph.rdf.records import Records
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.read.clauses import ClauseReader
from robbdd_tools.judging.parsed_sentences import read_step
from robbdd_tools.protocol.clauses import BehaviourCall, from_plain, to_plain
from robbdd_tools.run.emitters import emitters_of

MORE = """        meanwhile event <lifted> occurs
        Behaviour (ns=t) other {
            duration: from <other-start> until <other-end>
            <helper> picks <part>
        }
        then event <button> occurs event <lifted> occurs
        Behaviour (ns=t) last {
            duration: from <other-end> until <last-end>
            <helper> places <part> at <goal>
            emits place-end as <put>
        }
"""
DECLARED = EVENTS + "".join(
    f"Event (ns=t) {name}\n"
    for name in ("lifted", "other-start", "other-end", "last-end", "button", "put", "evt-pick-end", "evt-place-start")
)
SEVERAL = TEMPLATE.replace("    var goal\n", "    var goal\n    var helper\n").replace(
    "and places at <goal>\n        }\n",
    f"and places at <goal>\n            emits pick-end as <lifted>\n        }}\n{MORE}",
)
STATED = STORY.replace("variation:\n", "variation:\n                var <fetch.helper>: { <arms.ur10> }\n")
WHOLE = DECLARED + SEVERAL + STATED
T = "https://example.org/t/"


def behaviours(text: str = WHOLE) -> list[BehaviourClause]:
    variant = model_of(text).stories[0].variants[0]
    return [clause for clause in variant.template.clauses if isinstance(clause, BehaviourClause)]


def test_the_clauses_are_in_order_and_meanwhile_leads_to_the_behaviour_before() -> None:
    graph = built(WHOLE).graph
    order = (
        "t:on-bench t:when-bhv-fetch.when t:when-evt-fetch.when2.0 t:when-bhv-fetch.when2 "
        "t:when-evt-fetch.when3.0 t:when-evt-fetch.when3.1 t:when-bhv-fetch.when3 t:in-tray"
    )
    assert f"bdd:has-clause ({order})" in of(graph, "t:fetch")
    assert "rbw:together-with t:when-bhv-fetch.when" in of(graph, "t:when-bhv-fetch.when2")
    assert not [line for line in of(graph, "t:when-bhv-fetch.when3") if "together" in line]
    scenario = of(graph, "t:fetch-scenario")
    assert {"bhv:of-behaviour t:carry", "rbw:further-behaviour t:last", "rbw:further-behaviour t:other"} < {*scenario}


def test_a_when_with_one_behaviour_has_none_of_these_terms() -> None:
    (only,) = behaviours(EVENTS + TEMPLATE + STORY)
    assert (only.together, only.has_siblings) == (None, False)


def test_the_text_of_the_graph_has_the_same_graph() -> None:
    assert_identity(built(WHOLE).graph)


def test_a_behaviour_is_together_with_the_one_before_it_only() -> None:
    graph = built(WHOLE).graph
    node = URIRef(f"{T}when-bhv-fetch.when3")
    graph.add((node, URIRef(expand("rbw:together-with")), URIRef(f"{T}when-bhv-fetch.when")))
    with pytest.raises(Exception, match=r"when3 is executed together with another behaviour than that before it"):
        ClauseReader(Records(graph)).clauses(f"{T}fetch")


def test_meanwhile_begins_a_sentence_and_then_is_a_further_step() -> None:
    when = [step for step in steps(WHOLE) if step.startswith("When")]
    assert when == [
        'When "env:panda" picks "env:bolt" and places it at "env:bench_ws"',
        'When event "t:lifted" occurs',
        'When meanwhile "env:ur10" picks "env:bolt"',
        'When event "t:button" occurs',
        'When event "t:lifted" occurs',
        'When "env:ur10" places "env:bolt" at "env:bench_ws"',
    ]
    read = read_step("when", when[2].removeprefix("When "))
    assert isinstance(read, BehaviourCall)
    assert (read.behaviour.name, read.is_meanwhile) == ("pick", True)


def test_the_manifest_keeps_the_part_the_duration_and_the_link() -> None:
    call = BehaviourCall(load("pick"), {"agent": "a", "object": "o"}, "t:part", "t:from", "t:until", True)
    assert from_plain(to_plain(call)) == call
    alone = BehaviourCall(load("pick"), {"agent": "a", "object": "o"})
    assert to_plain(alone) == {"behaviour": "pick", "arguments": {"agent": "a", "object": "o"}}


def load(name: str):

    return load_catalog().behaviours[name]


def test_each_behaviour_has_its_own_events_and_a_shared_one_is_emitted_by_the_first() -> None:
    variant = model_of(WHOLE).stories[0].variants[0]
    found = {event.removeprefix(T): name.removeprefix(T) for event, name in emitters_of(variant, None).items()}
    assert found == {
        "start": "scenario-start",
        "end": "scenario-end",
        "pick-start": "when-bhv-fetch.when pick-start",
        "place-end": "when-bhv-fetch.when place-end",
        "lifted": "when-bhv-fetch.when pick-end",
        "other-start": "when-bhv-fetch.when2 pick-start",
        "other-end": "when-bhv-fetch.when2 pick-end",
        "last-end": "when-bhv-fetch.when3 place-end",
        "button": "external",
    }


@pytest.mark.parametrize("event", ["evt-pick-end", "evt-place-start"])
def test_a_name_that_fits_several_behaviours_fits_none(event: str) -> None:
    text = WHOLE.replace("after <place-end>)\n}", f"after <{event}>)\n}}")
    variant = model_of(text).stories[0].variants[0]
    assert T + event not in emitters_of(variant, None)
