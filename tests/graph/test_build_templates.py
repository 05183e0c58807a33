"""Templates and their clauses become the published triples, and ours where those have no term."""

import pytest

from graph.statements import built, of, statements
from kit import EVENTS, MODEL, TEMPLATE, fixture
from robbdd_tools.graph.write.build import build_graph

SETS = TEMPLATE.replace("var goal", "var goal\n    set var goals")
TIMED = "before <pick-start>"
REACHED = f"holds(<robot> can reach <part>, {TIMED})"


def with_given(given: str, template: str = TEMPLATE) -> str:
    start, end = template.index("on-bench"), template.index("    When:")
    return EVENTS + template[:start] + given + "\n" + template[end:]


def test_a_template_has_its_duration_its_parts_and_its_clauses_in_order() -> None:
    graph = built(EVENTS + TEMPLATE).graph
    assert of(graph, "t:fetch") == [
        "a bdd:ScenarioTemplate",
        "a time:DuringEventsConstraint",
        "a time:TimeConstraint",
        "bdd:has-clause (t:on-bench t:when-bhv-fetch.when t:in-tray)",
        "bdd:has-scene t:fetch-scene",
        "bdd:of-scenario t:fetch-scenario",
        "rbw:variables (t:var-part t:var-robot t:var-goal)",
        "time:after-event t:start",
        "time:before-event t:end",
    ]
    assert of(graph, "t:fetch-scenario") == [
        "a bdd:Scenario",
        "bdd:given t:fetch-scenario-given",
        "bdd:then t:fetch-scenario-then",
        "bdd:when t:fetch-scenario-when",
        "bhv:of-behaviour t:carry",
        "task:of-task t:task",
    ]
    assert of(graph, "t:fetch-scenario-given") == ["a bdd:Given"]


def test_variables_belong_to_the_namespace_and_not_to_the_template() -> None:
    other = TEMPLATE.replace("fetch", "bring").replace("on-bench", "on-b").replace("in-tray", "in-t")
    graph = built(EVENTS + TEMPLATE + other).graph
    assert of(graph, "t:var-part") == ["a bdd:ScenarioVariable"]
    assert "bdd:ref-object t:var-part" in of(graph, "t:on-b")


def test_a_set_variable_is_a_set() -> None:
    assert of(built(EVENTS + SETS).graph, "t:var-goals") == ["a bdd:ScenarioVariable", "a bdd:Set"]


def test_events_and_tasks_of_imported_files_are_typed() -> None:
    head = "//- main.bdd\nimport \"base.bdd\"\nns t = 'https://example.org/t/'\n"
    found = statements(built(f"{head}{TEMPLATE}//- base.bdd\n{EVENTS}").graph)
    assert {"t:start a time:Event", "t:task a task:Task"} <= found


def test_a_behaviour_carries_its_agent_its_targets_and_its_duration() -> None:
    graph = built(EVENTS + TEMPLATE).graph
    assert of(graph, "t:carry") == ["a bhv:Behaviour", "a bhv:Pick", "a bhv:Place"]
    assert of(graph, "t:when-bhv-fetch.when") == [
        "a bdd:WhenBehaviour",
        "a time:DuringEventsConstraint",
        "a time:TimeConstraint",
        "bdd:clause-of t:fetch-scenario-when",
        "bhv:of-behaviour t:carry",
        "bhv:target-agent t:var-robot",
        "bhv:target-object t:var-part",
        "bhv:target-workspace t:var-goal",
        "time:after-event t:pick-start",
        "time:before-event t:place-end",
    ]


@pytest.mark.parametrize(
    ("written", "stated"),
    [
        ("before <end>", ["a time:BeforeEventConstraint", "time:before-event t:end"]),
        ("after <end>", ["a time:AfterEventConstraint", "time:after-event t:end"]),
        (
            "from <start> until <end>",
            ["a time:DuringEventsConstraint", "time:after-event t:start", "time:before-event t:end"],
        ),
        (
            "2 seconds before <end>",
            [
                "a time:BeforeEventConstraint",
                "time:before-event t:end",
                'time:horizon-seconds "2.0"^^<http://www.w3.org/2001/XMLSchema#double>',
            ],
        ),
        (
            "within 2 seconds before <end>",
            [
                "a time:BeforeEventConstraint",
                "time:before-event t:end",
                'time:horizon-seconds "2.0"^^<http://www.w3.org/2001/XMLSchema#double>',
            ],
        ),
    ],
)
def test_a_time_constraint_stands_on_the_node_of_its_clause(written: str, stated: list[str]) -> None:
    graph = built(with_given(f"f: holds(<part> is held by <robot>, {written})")).graph
    about_time = [line for line in of(graph, "t:f") if "time:" in line and "TimeConstraint" not in line]
    assert about_time == stated
    assert "a time:TimeConstraint" in of(graph, "t:f")
    assert ("a rbw:AtSomeTime" in of(graph, "t:f")) == written.startswith("within")


@pytest.mark.parametrize(
    ("phrase", "stated"),
    [
        ("<part> is located at <goal>", ["LocatedAtPredicate", "ref-object t:var-part", "ref-workspace t:var-goal"]),
        ("<part> is held by <robot>", ["IsHeldPredicate", "ref-agent t:var-robot", "ref-object t:var-part"]),
        (
            "<goals> are sorted into <goals>",
            ["SortedIntoPredicate", "ref-object t:var-goals", "ref-workspace t:var-goals"],
        ),
        (
            "<robot> has config speed = <goal>",
            ["HasConfigPredicate", 'config-name "speed"', "config-target t:var-robot", "config-variable t:var-goal"],
        ),
        ("<robot> can reach <part>", ["CanReach", "ref-agent t:var-robot", "ref-object t:var-part"]),
        ("<robot> does not drop <part>", ["DoesNotDropPredicate", "ref-agent t:var-robot", "ref-object t:var-part"]),
        ("<robot> does not collide <goal>", ["DoesNotCollidePredicate", "ref-agent t:var-robot", "target t:var-goal"]),
        (
            "pred('{p} rests', p=<part>)",
            [
                "StringTemplatePredicate",
                'argument-names ("p")',
                "argument-variables (t:var-part)",
                'template-string "{p} rests"',
            ],
        ),
    ],
)
def test_each_predicate_has_its_class_and_its_arguments(phrase: str, stated: list[str]) -> None:
    graph = built(with_given(f"f: holds({phrase}, {TIMED})", SETS)).graph
    about_predicate = [line for line in of(graph, "t:f") if "time:" not in line]
    kind, *arguments = stated
    expected = ["a bdd:FluentClause", f"a bdd:{kind}", "bdd:clause-of t:fetch-scenario-given"]
    assert about_predicate == sorted([*expected, *(f"bdd:{argument}" for argument in arguments)])


def test_an_and_around_the_clauses_of_a_role_is_their_list() -> None:
    held, reached = (f"holds({what}, {TIMED})" for what in ("<part> is held by <robot>", "<robot> can reach <part>"))
    text = with_given(f"( a: {held} and ( b: {reached} ) )")
    assert "bdd:has-clause (t:a t:b t:when-bhv-fetch.when t:in-tray)" in of(built(text).graph, "t:fetch")


@pytest.mark.parametrize(
    ("written", "node", "stated"),
    [
        (
            f'( a: {REACHED} or "free" {TIMED} )',
            "t:or-fetch.given.0",
            ["a rbw:Disjunction", "rbw:operands (t:a t:text-fetch.given.0.1)"],
        ),
        (
            f"( not a: holds(<robot> can reach <part>, {TIMED}) )",
            "t:not-fetch.given.0",
            ["a rbw:Negation", "rbw:operands (t:a)"],
        ),
        (
            f"( not ( a: {REACHED} and b: {REACHED} ) )",
            "t:and-fetch.given.0.0",
            ["a rbw:Conjunction", "rbw:operands (t:a t:b)"],
        ),
        (
            f'"all is well" {TIMED}',
            "t:text-fetch.given.0",
            [
                "a rbw:TextClause",
                "a time:BeforeEventConstraint",
                "a time:TimeConstraint",
                'rbw:text "all is well"',
                "time:before-event t:pick-start",
            ],
        ),
    ],
)
def test_what_the_published_vocabulary_lacks_has_terms_of_ours(written: str, node: str, stated: list[str]) -> None:
    graph = built(with_given(written)).graph
    assert of(graph, node) == sorted([*stated, "bdd:clause-of t:fetch-scenario-given"])


def test_events_in_when_come_before_the_behaviour() -> None:
    text = EVENTS + TEMPLATE.replace("    When:\n", "    When:\n        event <start> occurs event <end> occurs\n")
    graph = built(text).graph
    assert (
        "bdd:has-clause (t:on-bench t:when-evt-fetch.when.0 t:when-evt-fetch.when.1 t:when-bhv-fetch.when t:in-tray)"
        in of(graph, "t:fetch")
    )
    assert of(graph, "t:when-evt-fetch.when.1") == [
        "a rbw:WhenEvent",
        "bdd:clause-of t:fetch-scenario-when",
        "rbw:event t:end",
    ]


NESTED = (
    EVENTS
    + """Scenario Template (ns=t) sort {
    duration: from <start> until <end>
    task: <task>
    set var parts
    set var bins
    var robot
    for all ( var x in <parts> ) {
        Given:
            seen: holds(<robot> can reach <x>, before <pick-start>)
        for all ( var b in <bins> ) {
            When:
                Behaviour (ns=t) carry {
                    duration: from <pick-start> until <place-end>
                    <robot> picks <x> and places at <b>
                }
        }
        Then:
            ( var y exists in <bins> ) such that { placed: holds(<x> is located at <y>, after <place-end>) }
    }
    Then:
        sorted: holds(<parts> are sorted into <bins>, after <end>)
}
"""
)


def test_quantifiers_nest_and_keep_given_when_then_in_order() -> None:
    graph = built(NESTED).graph
    assert "bdd:has-clause (t:forall-sort.all t:sorted)" in of(graph, "t:sort")
    assert of(graph, "t:forall-sort.all") == [
        "a bdd:ForAll",
        "bdd:clause-of t:sort-scenario-when",
        "bdd:has-clause (t:seen t:forall-sort.all.all t:exists-sort.all.then.0)",
        "bdd:in-set t:var-parts",
        "bdd:ref-variable t:var-x",
    ]
    assert "bdd:has-clause (t:when-bhv-sort.all.all.when)" in of(graph, "t:forall-sort.all.all")
    assert of(graph, "t:exists-sort.all.then.0") == [
        "a bdd:ThereExists",
        "bdd:clause-of t:sort-scenario-then",
        "bdd:has-clause (t:placed)",
        "bdd:in-set t:var-bins",
        "bdd:ref-variable t:var-y",
    ]
    assert of(graph, "t:var-y") == ["a bdd:ScenarioVariable"]


def test_a_name_taken_twice_in_a_namespace_is_left_out_the_second_time() -> None:
    other = TEMPLATE.replace("fetch", "bring").replace("is located at <goal>, before", "is located at <goal>, after")
    graph = built(EVENTS + TEMPLATE + other).graph
    assert "time:before-event t:pick-start" in of(graph, "t:on-bench")
    assert "time:after-event t:pick-start" not in of(graph, "t:on-bench")
    assert "bdd:has-clause (t:when-bhv-bring.when)" in of(graph, "t:bring")


def test_prefixes_are_stated_so_that_they_survive_in_every_format() -> None:
    assert {'t: rbw:prefix "t"', 'lab: rbw:prefix "env"'} <= statements(built(MODEL).graph)


OTHER_EVENT = "ns t = 'https://example.org/t/'\nEvent (ns=t) kept\n"


@pytest.mark.parametrize(
    ("text", "kept", "lost"),
    [
        (OTHER_EVENT + "ns u = 'not an iri'\nEvent (ns=u) e\n", "t:kept a time:Event", "not an iri"),
        (OTHER_EVENT + "ns u = 'https://example.org/a b/'\nEvent (ns=u) e\n", "t:kept a time:Event", "a b/"),
        (OTHER_EVENT + "Event (ns=nowhere) e\n", "t:kept a time:Event", "nowhere"),
        (
            MODEL.replace("<part> is", "<none> is"),
            "t:on-bench bdd:ref-workspace t:var-goal",
            "t:on-bench bdd:ref-object",
        ),
        (
            MODEL.replace("template: <fetch>", "template: <none>"),
            "t:bench-to-tray rbw:scene lab:bench_scene",
            "of-template",
        ),
        (
            MODEL.replace("scene: <bench_scene>", "scene: <none>"),
            "t:bench-to-tray bdd:of-template t:fetch",
            "bdd:has-scene lab:",
        ),
        (MODEL.replace("task: <task>", "task: <"), "t:fetch a bdd:ScenarioTemplate", "of-task"),
        (MODEL.replace('import "lab.scene"', 'import "none.scene"'), "t:fetch a bdd:ScenarioTemplate", "lab:"),
    ],
)
def test_what_is_broken_is_left_out_and_the_rest_stays(text: str, kept: str, lost: str) -> None:
    found = statements(built(text).graph)
    assert kept in found
    assert not any(lost in line for line in found)


def test_deep_parentheses_do_not_exhaust_the_stack() -> None:
    text = with_given("( not " * 150 + f"a: holds(<robot> can reach <part>, {TIMED})" + " )" * 150)
    assert "a rbw:Negation" in of(built(text).graph, "t:not-fetch.given.0")


def test_an_unreadable_file_has_an_empty_graph() -> None:
    assert len(build_graph(fixture(MODEL).snapshot, "file:///fixture/none.bdd").graph) == 0
