"""Templates with several parts: loops and Whens one after the other, with clauses between them."""

from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import BNode, URIRef
from rdflib.collection import Collection

from gherkin_kit import model_of, steps
from graph.statements import built, of
from graph.test_text import assert_identity
from kit import EVENTS, SCENE, STORY, TEMPLATE, fixture
from names.test_clause_places import in_graph
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.graph.acceptance_model import BehaviourClause, EventClause, Fluent, ForAll, Iri, behaviour_clauses
from robbdd_tools.graph.clause_parts import part_numbers, whens_of
from robbdd_tools.graph.rdf.vocabulary import expand
from robbdd_tools.graph.text.model_text import write_model
from robbdd_tools.judging.scenario_clauses import clause_of, iteration_of_event, iterations_of_events
from robbdd_tools.monitor.time import After, Before, During
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.protocol.clauses import EventOccurrence
from robbdd_tools.protocol.clauses import Fluent as Stated
from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec
from robbdd_tools.run.emitters import emitters_of
from run.test_scenario_specs import specs

T = "https://example.org/t/"
MORE = "".join(f"Event (ns=t) {name}\n" for name in ("look", "seen", "load-end", "put-start", "put-end"))
PARTS = """Scenario Template (ns=t) rounds {
    duration: from <start> until <end>
    task: <task>
    var arm
    set var first
    set var second
    Given:
        at-first: holds(<arm> can reach <parts.bolt>, before <pick-start>)
    for all ( var x in <first> ) {
        Given: there: holds(<x> is located at <places.bench_ws>, before <pick-start>)
        for all ( var y in <second> ) {
            When: Behaviour (ns=t) load { duration: from <pick-start> until <load-end> <arm> picks <x> }
            Then: inner: holds(<x> is held by <arm>, after <load-end>)
        }
        Then: outer: holds(<x> is held by <arm>, after <load-end>)
    }
    Then:
        loaded: holds(<first> is held by <arm>, after <load-end>)
        while-loading: holds(<arm> does not drop <parts.bolt>, from <pick-start> until <load-end>)
    When:
        event <look> occurs
        Behaviour (ns=t) watch { duration: from <look> until <seen> <arm> picks <parts.nut> }
    Given:
        still-there: holds(<first> is located at <places.tray_ws>, before <pick-start>)
    for all ( var x in <second> ) {
        When: Behaviour (ns=t) unload {
            duration: from <pick-start> until <put-end>
            <arm> picks <x> and places at <places.tray_ws>
            emits place-start as <put-start>
        }
    }
    Then:
        after-all: holds(<first> is located at <places.tray_ws>, after <load-end>)
        whole: holds(<arm> does not drop <parts.bolt>, from <pick-start> until <put-end>)
        mixed: holds(<arm> does not drop <parts.bolt>, from <look> until <load-end>)
        done: holds(<arm> can reach <parts.bolt>, after <end>)
        put-down: holds(<arm> can reach <parts.bolt>, after <put-start>)
        every-pick: holds(<arm> can reach <parts.bolt>, after every <pick-start>)
}
User Story (ns=t) story {
    As A "o" I Want "p" So That "w"
    Scenarios:
        Scenario sort {
            template: <rounds>
            scene: <bench_scene>
            Given: own-given: holds(<rounds.arm> can reach <parts.nut>, before <pick-start>)
            When: event <seen> occurs
            Then: own-then: holds(<rounds.arm> can reach <parts.nut>, after <load-end>)
            variation:
                var <rounds.arm>: { <arms.panda> }
                set var <rounds.first>: { { <parts.bolt>, <parts.nut> } }
                set var <rounds.second>: { { <washers.washer0>, <washers.washer1> } }
        }
}
"""
WHOLE = EVENTS + MORE + PARTS
# Iterations: 1 to 4 are those of the nested loops, 5 is that of the When, 6 and 7 are those of the last loop.


def only_spec(folder: Path, text: str = WHOLE) -> ScenarioSpec:
    (found,) = specs(folder, text)
    return found


def named(spec: ScenarioSpec, name: str) -> list[ClauseSpec]:
    return [clause for clause in spec.clauses if clause.name == name]


def test_the_text_is_sound() -> None:
    case = fixture(f"//- main.bdd\n{WHOLE}\n//- lab.scene\n{SCENE}")
    found = {one.code for one in all_diagnostics(case.snapshot, case.uri)}
    # Its things have no models, and it does not use all of its names.
    assert found <= {"unused-event", "unused-variable", "published-form", "no-model", "catalog-models", "not-in-scene"}


def test_the_clauses_are_in_written_order_in_the_published_list() -> None:
    graph = built(WHOLE).graph
    order = (
        "t:at-first t:forall-rounds.all t:loaded t:while-loading "
        "t:when-evt-rounds.part2.when.0 t:when-bhv-rounds.part2.when t:still-there t:forall-rounds.part3.all "
        "t:after-all t:whole t:mixed t:done t:put-down t:every-pick"
    )
    assert f"bdd:has-clause ({order})" in of(graph, "t:rounds")
    assert "bdd:has-clause (t:there t:forall-rounds.all.all t:outer)" in of(graph, "t:forall-rounds.all")
    scenario = of(graph, "t:rounds-scenario")
    assert {"bhv:of-behaviour t:load", "rbw:further-behaviour t:unload", "rbw:further-behaviour t:watch"} < {*scenario}


def test_the_first_part_has_the_names_of_a_template_with_one_part() -> None:
    before = built(EVENTS + TEMPLATE + STORY).graph
    more = TEMPLATE.rpartition("}")[0] + "for all ( var x in <parts> ) { When: <robot> picks <x> }\n}\n"
    after = built(EVENTS + more + STORY).graph
    lost = {one for one in before if one not in after and not any(isinstance(node, BNode) for node in one)}
    assert lost == set()


def test_the_text_of_the_graph_has_the_same_graph() -> None:
    assert_identity(built(WHOLE).graph)


def test_the_clauses_of_the_text_are_those_of_the_graph() -> None:
    case = fixture(f"//- main.bdd\n{WHOLE}\n//- lab.scene\n{SCENE}")
    found = [clause.iri for clause in clauses_in(case.snapshot, case.uri)]
    assert {*found} == in_graph(case.snapshot, case.uri)
    assert len({*found}) == len(found)


def test_a_given_after_the_last_when_cannot_be_written_in_a_template_with_several_parts() -> None:
    graph = built(WHOLE).graph
    head = graph.value(URIRef(f"{T}rounds"), URIRef(expand("bdd:has-clause")))
    assert head is not None
    clauses = Collection(graph, head)
    clauses.append(clauses[0])
    left = write_model(graph, "model.scene").left_out
    assert left[f"{T}rounds"] == "it has a Given clause after its last When"


def test_the_steps_are_in_written_order_and_a_variants_own_ones_around_them() -> None:
    own = steps(WHOLE)
    assert own[0] == 'Given "env:panda" can reach "env:nut" before event "t:pick-start"'
    assert own[-1] == 'Then "env:panda" can reach "env:nut" after event "t:load-end"'
    assert own[-8] == 'When event "t:seen" occurs'
    order = [step.split()[0] for step in own]
    loop = ["Given", *["When", "Then"] * 2, "Then"]
    assert order == [*["Given"] * 2, *loop * 2, *["Then"] * 2, *["When"] * 2, "Given", *["When"] * 3, *["Then"] * 7]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("own-given", [(1, 7)]),
        ("at-first", [(1, 7)]),
        ("there", [(1, 2), (3, 4)]),
        ("inner", [(1, 1), (2, 2), (3, 3), (4, 4)]),
        ("outer", [(1, 2), (3, 4)]),
        ("loaded", [(1, 4)]),
        ("when-bhv-rounds.part2.when", [(5, 5)]),
        ("when-evt-rounds.part2.when.0", [(5, 5)]),
        ("still-there", [(6, 7)]),
        ("when-bhv-rounds.part3.all.when", [(6, 6), (7, 7)]),
        ("after-all", [(1, 7)]),
        ("own-then", [(1, 7)]),
    ],
)
def test_a_clause_is_about_what_is_before_a_then_and_after_a_given(
    tmp_path: Path, name: str, expected: list[tuple[int, int]]
) -> None:
    assert [clause.iterations for clause in named(only_spec(tmp_path), name)] == expected


@pytest.mark.parametrize(
    ("name", "time"),
    [
        ("at-first", Before("t:pick-start", iteration=1)),
        ("loaded", After("t:load-end", iteration=4)),
        ("while-loading", During("t:pick-start", "t:load-end", (1, 4))),
        ("still-there", Before("t:pick-start", iteration=6)),
        # The event of another part than the last one: its own last occurrence counts.
        ("after-all", After("t:load-end", iteration=4)),
        ("own-then", After("t:load-end", iteration=4)),
        ("whole", During("t:pick-start", "t:put-end", (1, 7))),
        ("mixed", During("t:look", "t:load-end", (5, 4))),
        # The end of the scenario belongs to every iteration.
        ("done", After("t:end", iteration=7)),
        ("put-down", After("t:put-start", iteration=7)),
        ("every-pick", After("t:pick-start", which="every", scope=(1, 7))),
    ],
)
def test_each_event_is_that_of_the_iterations_that_emit_it(tmp_path: Path, name: str, time: object) -> None:
    spec = only_spec(tmp_path)
    (clause,) = named(spec, name)
    found = clause_of(clause, spec)
    assert isinstance(found, Stated)
    assert found.time == time


@pytest.mark.parametrize(("sentence", "iteration"), [('event "t:look" occurs', 5), ('event "t:seen" occurs', 5)])
def test_an_event_of_a_when_is_expected_where_it_is_emitted(tmp_path: Path, sentence: str, iteration: int) -> None:
    spec = only_spec(tmp_path)
    (clause,) = [one for one in spec.clauses if one.sentence == sentence]
    assert isinstance(clause.statement, EventOccurrence)
    assert iteration_of_event(clause.statement.event, clause, spec) == iteration


def test_loops_may_share_their_events(tmp_path: Path) -> None:
    spec = only_spec(tmp_path)
    first, last = f"{T}when-bhv-rounds.all.all.when", f"{T}when-bhv-rounds.part3.all.when"
    assert spec.events["t:pick-start"] == f"{first} pick-start | {last} pick-start"
    assert spec.events["t:load-end"] == f"{first} pick-end"
    assert iterations_of_events(spec) == {
        "t:pick-start": {1, 2, 3, 4, 6, 7},
        "t:load-end": {1, 2, 3, 4},
        "t:look": {5},
        "t:seen": {5},
        "t:put-start": {6, 7},
        "t:put-end": {6, 7},
    }


def test_an_empty_loop_has_no_occurrences_for_the_clauses_about_it(tmp_path: Path) -> None:
    text = WHOLE.replace("set var <rounds.first>: { { <parts.bolt>, <parts.nut> } }", "set var <rounds.first>: { { } }")
    spec = only_spec(tmp_path, text)
    (clause,) = named(spec, "loaded")
    # The When is iteration 1, the last loop 2 and 3; no behaviour was executed before the clause.
    assert clause.iterations == (4, 4)


def test_a_thing_starts_where_the_first_part_expects_it(tmp_path: Path) -> None:
    assert only_spec(tmp_path).scene.places == {"env:bolt": "env:bench_ws", "env:nut": "env:bench_ws"}
    later = WHOLE.replace("        Given: there: holds(<x> is located at <places.bench_ws>, before <pick-start>)\n", "")
    unmoved = later.replace("still-there: holds(<first> is", "still-there: holds(<parts.nut> is")
    assert only_spec(tmp_path / "later", unmoved).scene.places == {"env:nut": "env:tray_ws"}


def test_behaviours_of_a_template_with_several_are_told_apart() -> None:
    variant = model_of(WHOLE).stories[0].variants[0]
    assert [clause.has_siblings for clause in behaviour_clauses(variant.template.clauses)] == [True] * 3
    assert [[str(one.iri).removeprefix(T) for one in when] for when in whens_of(variant.template.clauses)] == [
        ["when-bhv-rounds.part2.when"],
        ["when-bhv-rounds.all.all.when"],
        ["when-bhv-rounds.part3.all.when"],
    ]
    assert emitters_of(variant, None)[Iri(f"{T}start")] == "scenario-start"


def fluent(name: str, role: str) -> Fluent:
    return Fluent(Iri(name), role, "located-at", {}, After("e"))


def test_clauses_of_graphs_in_any_order_have_parts() -> None:
    given, then = fluent("g", "given"), fluent("t", "then")
    event, loop = EventClause(Iri("e"), Iri("x")), ForAll(Iri("a"), Iri("v"), Iri("s"), ())
    act = BehaviourClause(Iri("b"), "pick", {}, Iri("s"), Iri("e"))
    assert part_numbers([given, event, act, act, then]) == (0, 0, 0, 0, 0)
    assert part_numbers([event, given, act, then, given]) == (0, 0, 0, 0, 1)
    assert part_numbers([act, then, event, act, loop, given, loop, then]) == (0, 0, 1, 1, 2, 3, 3, 3)
    assert part_numbers([then, given]) == (0, 0)
