"""Models become features whose steps the line map finds again."""

from importlib import import_module
from typing import Any

import pytest

from kit import MODEL, SCENE, fixture
from robbdd_tools.gherkin.feature import FeaturePiece, feature_pieces
from robbdd_tools.graph.build import build_graph
from robbdd_tools.graph.read import read_model


def pieces(text: str, scene: str = SCENE) -> list[FeaturePiece]:
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{scene}")
    model = read_model(build_graph(case.snapshot, case.uri).graph)
    return [piece for story in model.stories for piece in feature_pieces(model, story)]


def feature(text: str) -> str:
    return "".join(piece.text for piece in pieces(text))


def steps(text: str, number: int = 0) -> list[str]:
    scenario = [piece.scenario for piece in pieces(text) if piece.scenario][number]
    return [f"{step.keyword} {step.text}" for step in scenario.steps]


def edited(old: str, new: str) -> str:
    assert old in MODEL
    return MODEL.replace(old, new, 1)


def test_a_scenario_lists_its_scene_and_states_its_clauses() -> None:
    text = feature(MODEL)
    assert text.startswith(
        """Feature: t:fetching
  As a operator
  I want parts fetched
  So that work goes on

  Scenario: t:bench-to-tray -- 1
    Given a set of objects
      | name |
      | env:bolt |
      | env:nut |
      | env:bench |
      | env:tray |
    Given a set of workspaces
      | name |
      | env:bench_ws |
      | env:tray_ws |
    Given a set of agents
      | name |
      | env:panda |
      | env:ur10 |
    Given the scene is set up
    Given "env:bolt" is located at "env:bench_ws" before event "t:pick-start"
    When "env:panda" picks "env:bolt" and places it at "env:bench_ws"
    Then "env:bolt" is located at "env:bench_ws" within 0.5 seconds after event "t:place-end"
"""
    )
    assert text.count("Scenario:") == 4


def test_values_that_the_scene_lacks_are_listed_apart() -> None:
    text = feature(edited("obj set <parts>", "{ <washers.washer1> }"))
    assert "Given variable scene elements\n      | name |\n      | env:washer1 |\n" in text


def test_every_step_is_found_at_its_line() -> None:
    lines = feature(MODEL).split("\n")
    for piece in pieces(MODEL):
        if piece.scenario is not None:
            assert lines[piece.scenario.line - 1] == f"  Scenario: {piece.scenario.name}"
            found = [lines[line - 1].strip() for line in piece.scenario.lines]
            assert found == [f"{step.keyword} {step.text}" for step in piece.scenario.steps]


def test_a_variants_clauses_follow_the_templates_in_each_role() -> None:
    more = """scene: <bench_scene>
            Given: own: holds(<fetch.robot> can reach <fetch.part>, before <start>)
            Then: also: holds(<fetch.part> is held by <fetch.robot>, from <pick-start> until <place-end>)"""
    assert steps(edited("scene: <bench_scene>", more)) == [
        'Given "env:bolt" is located at "env:bench_ws" before event "t:pick-start"',
        'Given "env:panda" can reach "env:bolt" before event "t:start"',
        'When "env:panda" picks "env:bolt" and places it at "env:bench_ws"',
        'Then "env:bolt" is located at "env:bench_ws" within 0.5 seconds after event "t:place-end"',
        'Then "env:bolt" is held by "env:panda" from "t:pick-start" until "t:place-end"',
    ]


def test_placeholders_of_text_predicates_reach_names_only() -> None:
    clause = "pred('\"{part}\" {part.__class__} {other}', part=<part>)"
    (given, *_) = steps(edited("<part> is located at <goal>, before", f"{clause}, before"))
    assert given == 'Given "env:bolt" {part.__class__} {other} before event "t:pick-start"'


QUANTIFIED = """
    set var parts
    set var goals
    var robot
    for all ( var x in <parts> ) {
        When:
            Behaviour (ns=t) carry {
                duration: from <pick-start> until <place-end>
                <robot> picks <x> and places at <goals>
            }
        Then:
            ( var y exists in <goals> ) such that { some: holds(<x> is located at <y>, after <place-end>) }
    }
    Then:
        all: holds(<parts> are sorted into <goals>, after <place-end>)
}
User Story (ns=t) sorting {
    As A "operator" I Want "parts sorted" So That "work goes on"
    Scenarios:
        Scenario sort {
            template: <sort-all>
            scene: <bench_scene>
            variation:
                set var <sort-all.parts>: select 2 permutations from <parts>
                set var <sort-all.goals>: { { <places.bench_ws>, <places.tray_ws> } }
                var <sort-all.robot>: agn set <arms>
        }
}
"""


def test_quantifiers_are_unrolled_over_their_sets() -> None:
    events = MODEL[: MODEL.index("Scenario Template")]
    head = "Scenario Template (ns=t) sort-all { duration: from <start> until <end> task: <task>"
    assert steps(events + head + QUANTIFIED, 2) == [
        'When "env:panda" picks "env:nut" and places it at "[\'env:bench_ws\', \'env:tray_ws\']"',
        'Then "env:nut" is located at "any of [\'env:bench_ws\', \'env:tray_ws\']" after event "t:place-end"',
        'When "env:panda" picks "env:bolt" and places it at "[\'env:bench_ws\', \'env:tray_ws\']"',
        'Then "env:bolt" is located at "any of [\'env:bench_ws\', \'env:tray_ws\']" after event "t:place-end"',
        "Then \"['env:nut', 'env:bolt']\" are sorted into \"['env:bench_ws', 'env:tray_ws']\""
        ' after event "t:place-end"',
    ]


@pytest.mark.parametrize("word", ['a "quoted" word', "a | pipe", "two\nlines"])
def test_every_feature_is_read_by_behave(word: str) -> None:
    parse_feature: Any = import_module("behave.parser").parse_feature
    escaped = word.replace('"', '\\"')
    text = edited("{ <arms.panda> }", f'{{ "{escaped}" }}')
    parsed = parse_feature(feature(text))
    assert parsed is not None
    assert len(parsed.scenarios) == 4
