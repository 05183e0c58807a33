"""Models become features whose steps the line map finds again."""

from __future__ import annotations

from gherkin_kit import edited, feature, pieces, steps
from kit import MODEL, SCENE, STORY
from robbdd_tools.gherkin.feature import feature_file_name
from robbdd_tools.graph.acceptance_model import AcceptanceModel, Iri, Story


def test_a_scenario_lists_its_scene_and_states_its_clauses() -> None:
    text = feature(MODEL)
    assert text.startswith(
        """# wording: 2
@story=https:;;example.org;t;fetching
Feature: t:fetching
  As a operator
  I want parts fetched
  So that work goes on

  Background:
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

"""
    )
    scenario = text[text.index("  Scenario: ") :]
    assert scenario.startswith(
        """  Scenario: t:bench-to-tray -- 1
    Given the scene is set up
    Given "env:bolt" is located at "env:bench_ws" before event "t:pick-start"
    When "env:panda" picks "env:bolt" and places it at "env:bench_ws"
    Then "env:bolt" is located at "env:bench_ws" for 0.5 seconds after event "t:place-end"
"""
    )
    assert text.count("Scenario:") == 4


def test_stories_over_several_scenes_list_them_in_each_scenario() -> None:
    second = STORY[STORY.index("        Scenario ") : STORY.rindex("}")].replace("bench-to-tray", "bare")
    source = MODEL[: MODEL.rindex("}")] + second.replace("<bench_scene>", "<bare_scene>") + "}\n"
    text = feature(source, scene=SCENE + "scene (ns=env) bare_scene { obj set <parts> }\n")
    assert "Background:" not in text
    bare = text[text.index("  Scenario: t:bare -- 1") :]
    assert "Given a set of objects\n      | name |\n      | env:bolt |\n      | env:nut |\n" in bare


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
        'Then "env:bolt" is located at "env:bench_ws" for 0.5 seconds after event "t:place-end"',
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
        'When "env:panda" picks "env:nut" and places it at "any of [\'env:bench_ws\', \'env:tray_ws\']"',
        'Then "env:nut" is located at "any of [\'env:bench_ws\', \'env:tray_ws\']" after event "t:place-end"',
        'When "env:panda" picks "env:bolt" and places it at "any of [\'env:bench_ws\', \'env:tray_ws\']"',
        'Then "env:bolt" is located at "any of [\'env:bench_ws\', \'env:tray_ws\']" after event "t:place-end"',
        "Then \"['env:nut', 'env:bolt']\" are sorted into \"['env:bench_ws', 'env:tray_ws']\""
        ' after event "t:place-end"',
    ]


def test_stories_of_one_name_get_files_of_their_own() -> None:
    stories = tuple(Story(Iri(iri), "", "", "", ()) for iri in ("a:tidy", "b:Tidy", "a:other/place"))
    model = AcceptanceModel(stories, {}, {}, {"a": "a:", "b": "b:"})
    names = [feature_file_name(model, story) for story in stories]
    assert names == ["tidy-1.feature", "Tidy-2.feature", "other_place.feature"]
