"""A scenario's data for the agent: quantified givens, awaited events, steps omitted by a template."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from gherkin_kit import edited, model_of
from kit import EVENTS
from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.gherkin.feature_files import whole_plan
from robbdd_tools.gherkin.user_template import sheet
from robbdd_tools.graph.acceptance_model import Execution, Iri
from robbdd_tools.monitor.policy import Observation, Policy, Provider, Rule, View
from robbdd_tools.protocol.clauses import Text
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run.prepare import lay_out

QUANTIFIED = (
    EVENTS
    + """Scenario Template (ns=t) all {
    duration: from <start> until <end>
    task: <task>
    var arm
    set var parts
    for all ( var x in <parts> ) {
        Given: there: holds(<x> is located at <places.bench_ws>, before <start>)
        When: Behaviour (ns=t) take { duration: from <pick-start> until <place-end> <arm> picks <x> }
    }
}
User Story (ns=t) sorting {
    As A "o" I Want "p" So That "w"
    Scenarios:
        Scenario sort {
            template: <all>
            scene: <bench_scene>
            variation:
                set var <all.parts>: { { <parts.bolt>, <parts.nut> } }
                var <all.arm>: { <arms.panda> }
        }
}
"""
)


def specs(folder: Path, text: str, template: str = "default") -> list[ScenarioSpec]:
    plan = replace(whole_plan(model_of(text)), sheet=sheet(template))
    found = list(lay_out(plan, "main.bdd", 1, folder))
    assert list(read_manifest(folder).scenarios) == found
    return found


def test_things_start_where_quantified_givens_want_them(tmp_path: Path) -> None:
    text = edited("var arm", "var arm\n    var place", QUANTIFIED).replace("<places.bench_ws>", "<place>")
    text = edited("var <all.arm>", "var <all.place>: { <places.bench_ws> }\n                var <all.arm>", text)
    (only,) = specs(tmp_path, text)
    assert only.scene.places == {"env:bolt": "env:bench_ws", "env:nut": "env:bench_ws"}


def test_an_awaited_event_is_bound_to_what_emits_it(tmp_path: Path) -> None:
    text = edited("When: Behaviour", "When: event <E_PICK_ENDED> occurs Behaviour", QUANTIFIED)
    text = edited("Event (ns=t) end", "Event (ns=t) end\nEvent (ns=t) E_PICK_ENDED", text)
    text = text.replace("located at <places.bench_ws>", "is located at <arm>").replace("is is", "is")
    text = edited("<x> is located at <arm>", "<x> is held by <arm>", text)
    (only,) = specs(tmp_path, text)
    assert only.events["t:E_PICK_ENDED"] == "pick-end"
    assert [clause.sentence for clause in only.clauses][1] == 'event "t:E_PICK_ENDED" occurs'


def test_only_steps_that_were_written_are_to_be_judged(tmp_path: Path) -> None:
    own = tmp_path / "own.feature.jinja"
    own.write_text(
        "{% block scenario %}Scenario: {{ scenario.name }}\n  When {{ scenario.steps[1].text }}\n{% endblock %}",
        encoding="utf-8",
    )
    text = QUANTIFIED.replace("<x> is located at <places.bench_ws>", "<x> is held by <arm>")
    (only,) = specs(tmp_path / "out", text, str(own))
    assert [(clause.line, clause.sentence) for clause in only.clauses] == [(2, '"env:panda" picks "env:bolt"')]


def test_users_code_is_told_the_arguments_of_its_clause_and_no_other(tmp_path: Path) -> None:
    placed = "holds(<x> is located at <places.bench_ws>,"
    model = model_of(edited(placed, "holds(pred('{x} is {how}', x=<x>, how=<arm>),", QUANTIFIED))
    (variant,) = model.stories[0].variants
    policies = (Policy("x:p", "https://example.org/t/there", Rule("python", "m:f")),)
    execution = Execution(Iri("x:e"), variant.iri, Implementation("x:i", "catalog", "pick"), policies=policies)
    plan = replace(whole_plan(model), sheet=sheet("default"))
    (only,) = list(lay_out(plan, "main.bdd", 1, tmp_path, (execution,)))
    shared = {"arm": "env:panda", "parts": ["env:bolt", "env:nut"], "how": "env:panda"}
    texts = [one.statement for one in only.clauses if isinstance(one.statement, Text)]
    assert [text.named for text in texts] == [{**shared, "x": "env:bolt"}, {**shared, "x": "env:nut"}]
    assert read_manifest(tmp_path).scenarios == (only,)


def test_a_policy_names_what_it_observes_and_its_sensor_like_the_scene(tmp_path: Path) -> None:
    env = "https://example.org/env/"
    camera = Provider("x:c", "ground-truth", 30.0, view=View(f"{env}panda", 0.3, 1.5))
    seen = Observation("x:o", camera, (f"{env}bolt", f"{env}nut"))
    policy = Policy("x:p", "https://example.org/t/there", Rule("python", "m:f"), observations=(seen,))
    model = model_of(QUANTIFIED)
    variant, built_in = model.stories[0].variants[0], Implementation("x:i", "catalog", "pick")
    plan = replace(whole_plan(model), sheet=sheet("default"))
    execution = Execution(Iri("x:e"), variant.iri, built_in, policies=(policy,))
    (only,) = list(lay_out(plan, "main.bdd", 1, tmp_path, (execution,)))
    assert only.execution is not None
    ((observation,),) = (one.observations for one in only.execution.policies)
    assert observation.targets == ("env:bolt", "env:nut")
    assert observation.provider.view == View("env:panda", 0.3, 1.5)
    assert read_manifest(tmp_path).scenarios == (only,)


def test_clauses_refer_to_the_behaviours_of_their_iteration(tmp_path: Path) -> None:
    nested = edited(
        "    for all ( var x in <parts> ) {",
        "    Given: first: holds(<parts> are sorted into <goals>, before <pick-start>)\n"
        "    for all ( var y in <parts> ) {\n"
        "    Given: outer: holds(<y> is held by <arm>, before <pick-start>)\n"
        "    for all ( var x in <parts> ) {",
        QUANTIFIED,
    )
    nested = edited(
        "<arm> picks <x> }\n    }\n",
        "<arm> picks <x> }\n    }\n"
        "    Then: inner: holds(<y> is held by <arm>, after <place-end>)\n    }\n"
        "    Then: last: holds(<parts> are sorted into <goals>, after <place-end>)\n",
        nested,
    )
    nested = nested.replace("located at <places.bench_ws>", "held by <arm>").replace(
        "<parts> are sorted into <goals>", "pred('all is well')"
    )
    (only,) = specs(tmp_path, nested)
    found = [(clause.name.partition("-")[0], clause.iterations) for clause in only.clauses]
    one, two = [("there", (1, 1)), ("when", (1, 1))], [("there", (2, 2)), ("when", (2, 2))]
    three, four = [("there", (3, 3)), ("when", (3, 3))], [("there", (4, 4)), ("when", (4, 4))]
    assert found == [
        ("first", (1, 4)),
        *[("outer", (1, 2)), *one, *two, ("inner", (1, 2))],
        *[("outer", (3, 4)), *three, *four, ("inner", (3, 4))],
        ("last", (1, 4)),
    ]


def test_a_single_behaviour_needs_no_iteration(tmp_path: Path) -> None:
    text = QUANTIFIED.replace("{ <parts.bolt>, <parts.nut> }", "{ <parts.bolt> }")
    (only,) = specs(tmp_path, text.replace("located at <places.bench_ws>", "held by <arm>"))
    assert {clause.iterations for clause in only.clauses} == {()}
