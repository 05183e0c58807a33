"""Elements and values in clauses, where a variable may stand: triples, text, sentences, scene and findings."""

from __future__ import annotations

import pytest

from checks.models import found
from gherkin_kit import feature, model_of, pieces, steps
from graph.statements import built, of
from graph.test_text import assert_identity
from kit import EVENTS, STORY, TEMPLATE, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.goto_definition import definition
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.run.related_scenarios import Relations
from robbdd_tools.run.scenario_specs import SpecWriter

GIVEN = """        ( on-bench: holds(<part> is located at <goal>, before <pick-start>)
          and slow: holds(<robot> has config ee_speed = 0.25, before <pick-start>)
          and word: holds(<arms.panda> has config approach = "from above", before <pick-start>)
          and clear: holds(<robot> is farther than 1 cm from <furniture.tray>, before <pick-start>) )
"""
STATED = TEMPLATE.replace("        on-bench: holds(<part> is located at <goal>, before <pick-start>)\n", GIVEN)
NAMED = STATED.replace("picks <part> and places at <goal>", "picks <washers.washer1> and places at <places.tray_ws>")
WHOLE = EVENTS + NAMED + STORY


def test_the_slot_has_the_element_or_the_value() -> None:
    graph = built(WHOLE).graph
    assert "bhv:target-object lab:washer1" in of(graph, "t:when-bhv-fetch.when")
    assert "rbw:ref-other lab:tray" in of(graph, "t:clear")
    assert any("0.25" in line for line in of(graph, "t:slow"))
    assert any('"from above"' in line for line in of(graph, "t:word"))
    assert not [entry for entry in validate(built(WHOLE)) if entry.severity is Severity.ERROR]


def test_the_text_of_the_graph_has_the_same_graph() -> None:
    assert_identity(built(WHOLE).graph)


def test_the_sentences_are_those_of_variables_with_these_values() -> None:
    assert steps(WHOLE)[1:5] == [
        'Given "env:panda" has config "ee_speed" = "0.25" before event "t:pick-start"',
        'Given "env:panda" has config "approach" = "from above" before event "t:pick-start"',
        'Given "env:panda" is farther than "1 cm" from "env:tray" before event "t:pick-start"',
        'When "env:panda" picks "env:washer1" and places it at "env:tray_ws"',
    ]


def test_an_element_that_the_scene_lacks_belongs_to_the_scenario() -> None:
    model = model_of(WHOLE)
    scenario = next(piece.scenario for piece in pieces(WHOLE) if piece.scenario)
    (spec,) = SpecWriter(model, 1, Relations(model)).specs("f", model.stories[0].iri, scenario)
    assert "env:washer1" in spec.scene.objects
    assert not {"env:washer1", "env:tray"} & set(spec.scene.unused)
    assert [(one.target, one.name, one.value) for one in spec.scene.config] == [
        ("env:panda", "ee_speed", "0.25"),
        ("env:panda", "approach", "from above"),
    ]
    added = "    Given variable scene elements\n      | name |\n      | env:washer1 |\n"
    assert added in feature(WHOLE)
    # One row per scenario cannot list an element of a clause.
    assert "Scenario Outline" not in feature(WHOLE, "compact")
    assert "Scenario Outline" in feature(WHOLE.replace("washers.washer1", "parts.nut"), "compact")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("ee_speed = 0.25", "ee_speed = 99", "ee_speed"),
        ("<robot> has config ee_speed", "<parts.bolt> has config ee_speed", "has no ee_speed"),
    ],
)
def test_a_configuration_that_is_impossible_is_reported_where_it_is_written(old: str, new: str, message: str) -> None:
    (entry,) = [
        one for one in found(WHOLE.replace(old, new)) if one.code == "setting" and "approach" not in one.message
    ]
    assert message in entry.message
    assert entry.severity is Severity.WARNING


def test_an_element_of_another_kind_is_an_error() -> None:
    wrong = built(WHOLE.replace("<washers.washer1>", "<places.bench_ws>"))
    assert [entry.code for entry in validate(wrong) if entry.severity is Severity.ERROR] == ["shacl-pick-place-object"]


def test_a_name_that_is_neither_a_variable_nor_an_element_is_a_missing_variable() -> None:
    entry, *_ = [one for one in found(WHOLE.replace("holds(<part> is", "holds(<bolt> is")) if "'bolt'" in one.message]
    assert entry.message.startswith("there is no variable 'bolt'")


def test_definition_leads_to_the_element() -> None:
    case = fixture(WHOLE.replace("from <furniture.tray>", "from <furniture.tr$0ay>"))
    place = definition(case.snapshot, case.uri, case.cursor)
    assert place is not None
    assert place[0].endswith("lab.scene")
