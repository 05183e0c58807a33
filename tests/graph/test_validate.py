"""Each broken model gets exactly the violation it should, on the token that causes it."""

from dataclasses import replace

import pytest

from graph.statements import built
from graph.validated import HEAD, check, findings, scene, story
from kit import EVENTS, MODEL, SCENE, STORY, TEMPLATE
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.graph.shapes.validate import validate


def test_sound_models_conform() -> None:
    assert findings(MODEL) == []
    assert findings(f"//- lab.scene\n{SCENE}") == []


def test_a_template_without_duration_and_task_says_what_to_write() -> None:
    check(
        EVENTS
        + """Scenario Template (ns=t) fetch {
//                       ^^^^^ shacl-template-duration 'duration: from <start> until <end>'
//                       ^^^^^ shacl-scenario-task 'task: <task>'
    var robot
    var part
    When:
        Behaviour (ns=t) take { duration: from <pick-start> until <place-end> <robot> picks <part> }
}
"""
    )


def test_a_duration_between_one_event_is_a_warning() -> None:
    text = (
        EVENTS
        + """Scenario Template (ns=t) fetch {
    duration: from <start> until <start>
//                  ^^^^^ shacl-empty-duration single instant
    task: <task>
    var robot
    var part
    When:
        Behaviour (ns=t) take { duration: from <pick-start> until <place-end> <robot> picks <part> }
}
"""
    )
    check(text)
    assert findings(text)[0].severity is Severity.WARNING


@pytest.mark.parametrize("horizon", ["0", "-0.5"])
def test_a_horizon_is_a_positive_time(horizon: str) -> None:
    (found,) = findings(MODEL.replace("0.5 seconds", f"{horizon} seconds"))
    assert found.code == "shacl-horizon"
    assert found.span.end - found.span.start == len(horizon)


def test_free_text_is_not_empty() -> None:
    text = MODEL.replace("    When:", "    When: event <start> occurs", 1)
    text = text.replace("in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)", "'' after <end>")
    (found,) = findings(text)
    assert (found.code, text[found.span.start : found.span.end]) == ("shacl-text-clause-text", "''")


def test_the_text_of_a_predicate_is_not_empty() -> None:
    text = MODEL.replace("<part> is located at <goal>, before", "pred('', p=<part>), before")
    (found,) = findings(text)
    assert (found.code, text[found.span.start : found.span.end]) == ("shacl-text-predicate-text", "''")


def test_a_slot_for_a_set_takes_no_single_variable() -> None:
    text = MODEL.replace("<part> is located at <goal>, before", "<part> are sorted into <goal>, before")
    found = findings(text)
    assert [(entry.code, text[entry.span.start : entry.span.end]) for entry in found] == [
        ("shacl-sorted-into-objects", "part"),
        ("shacl-sorted-into-workspaces", "goal"),
    ]
    assert "name a 'set var' or an 'obj set'" in found[0].message
    assert found[0].related[0].message == "'fetch.part' is declared here"


@pytest.mark.parametrize("count", ["-2", "2.5", "20000"])
def test_a_similar_set_has_a_sensible_number_of_members(count: str) -> None:
    text = f"{HEAD}similar obj set (ns=env) balls {{ base name: ball  count: {count} }}\n"
    found = [entry for entry in findings(f"//- lab.scene\n{text}") if entry.code == "shacl-similar-count"]
    assert [text[entry.span.start : entry.span.end] for entry in found] == [count]
    assert count in found[0].message


def test_a_scene_has_members() -> None:
    check(scene("scene (ns=env) nothing { }\n//             ^^^^^^^ shacl-scene-entries 'nothing' has no members\n"))


def test_a_composition_is_not_empty() -> None:
    check(
        scene(
            "ws set (ns=env) places { workspace desk }\n"
            "comp (ns=env) bare of ws <places.desk> { }\n"
            "//            ^^^^ shacl-composition-contents write the object\n"
        )
    )


def test_a_workspace_does_not_lie_inside_itself() -> None:
    check(
        scene(
            "ws set (ns=env) places { workspace desk, workspace shelf }\n"
            "comp (ns=env) one of ws <places.desk> { ws comp <two> }\n"
            "//                       ^^^^^^^^^^^ shacl-composition-cycle 'places.desk' lies inside itself\n"
            "comp (ns=env) two of ws <places.shelf> { ws <places.desk> }\n"
            "//                       ^^^^^^^^^^^^ shacl-composition-cycle 'places.shelf' lies inside itself\n"
        )
    )


def test_a_name_that_means_two_things_in_one_namespace_is_an_error() -> None:
    text = EVENTS + TEMPLATE + TEMPLATE.replace("fetch", "bring").replace("in-tray", "in-t")
    (found,) = findings(text)
    assert (found.code, found.severity) == ("duplicate-iri", Severity.ERROR)
    assert found.span.start == text.rindex("on-bench")
    assert found.related[0].span.start == text.index("on-bench")


def test_a_behaviour_may_be_shared_by_templates_but_not_mean_two_things() -> None:
    other = TEMPLATE.replace("fetch", "bring").replace("on-bench", "on-b").replace("in-tray", "in-t")
    assert findings(EVENTS + TEMPLATE + other) == []
    text = EVENTS + TEMPLATE + other.replace("<robot> picks <part> and places at <goal>", "<robot> picks <part>")
    assert [entry.code for entry in findings(text)] == ["duplicate-iri"]


def test_violations_in_an_imported_file_come_back_to_that_file() -> None:
    check(
        f'//- main.bdd\nimport "base.bdd"\n{STORY}//- base.bdd\n{EVENTS}'
        + TEMPLATE.replace(
            "    duration: from <start> until <end>\n",
            "    duration: from <start> until <start>\n//                  ^^^^^ shacl-empty-duration\n",
        )
    )


@pytest.mark.parametrize(
    "text",
    [
        MODEL.replace("<part> is located", "<prat> is located"),
        MODEL.replace("task: <task>", "task: <tsk>"),
        MODEL.replace("duration: from <start> until <end>", "duration: from <strat> until <end>"),
        MODEL.replace("duration: from <start> until", "duration: frm <start> until"),
        MODEL.replace("scene: <bench_scene>", "scene: <bunch_scene>"),
        MODEL.replace("obj set <parts>", "obj set <prats>"),
        MODEL.replace('import "lab.scene"', 'import "lob.scene"'),
        f"//- main.bdd\n{MODEL}//- lab.scene\n{SCENE.replace('object bolt, object nut', 'objct bolt')}",
        f"//- main.bdd\n{MODEL}//- lab.scene\n{SCENE.replace('workspace bench_ws,', 'workspace bench_ws')}",
        f"//- lab.scene\n{HEAD}scene (ns=env) all {{ obj set <none> }}\n",
        f"//- lab.scene\n{HEAD}obj set (ns=none) parts {{ }}\n",
    ],
)
def test_what_syntax_and_names_prove_is_not_said_again(text: str) -> None:
    assert findings(text) == []


def test_an_error_elsewhere_does_not_hide_an_independent_violation() -> None:
    broken = TEMPLATE.replace("fetch", "bring").replace("on-bench", "on-b").replace("in-tray", "in-t")
    text = MODEL.replace("0.5 seconds", "0 seconds") + broken.replace("<part> is", "<prat> is")
    assert [entry.code for entry in findings(text)] == ["shacl-horizon"]


def test_an_error_in_a_clause_does_not_hide_a_mistake_in_a_table_that_uses_the_template() -> None:
    text = story("| <fetch.part> | <fetch.robot> | <fetch.goal> |\n|---|\n| <parts.bolt> |\n")
    text = text.replace("<part> is located at <goal>, before", "<prat> is located at <goal>, before")
    assert [entry.code for entry in findings(text)] == ["shacl-row-width"]


def test_two_results_with_one_message_at_one_place_are_one_diagnostic() -> None:
    text = MODEL.replace("    duration: from <start> until <end>\n", "")
    assert [entry.code for entry in findings(text)] == ["shacl-template-duration"]


def test_findings_do_not_depend_on_the_order_of_the_triples() -> None:
    graph = built(MODEL.replace("0.5 seconds", "0 seconds").replace("obj set <parts>", "ws set <places>"))
    first = validate(graph)
    turned = type(graph.graph)()
    for triple in reversed(list(graph.graph)):
        turned.add(triple)
    assert validate(replace(graph, graph=turned)) == first
    assert len(first) == 3
