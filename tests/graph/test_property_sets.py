"""Sets by property: their elements, scenarios, graph and text."""

from __future__ import annotations

import pytest

from checks.models import found, story
from graph.test_text import assert_identity
from kit import MODEL, SCENE, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.property_conditions import PropertyCondition
from robbdd_tools.base.property_values import NUMBER, QUANTITY, TEXT, TRUTH, PropertyValue
from robbdd_tools.features.completion import complete
from robbdd_tools.gherkin.variations import count
from robbdd_tools.graph.acceptance_model import Product
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph

STATED = SCENE.replace("object bolt", "object bolt { mass: 20 g  colour: red  fragile: true }").replace(
    "object nut", "object nut { mass: 0.5 kg  colour: blue, grey }"
)
ENV = "https://example.org/env/"


def model(condition: str, scene: str = STATED, extra: str = "") -> str:
    lines = (
        f"                var <fetch.part>: obj set <parts> where {condition}\n"
        "                var <fetch.robot>: { <arms.panda> }\n"
        "                var <fetch.goal>: { <places.tray_ws> }\n"
    )
    return f"//- main.bdd\n{story(lines)}//- lab.scene\n{scene}{extra}"


def selected(text: str) -> list[str]:
    """The values of the first variable."""
    case = fixture(text)
    variant = read_model(build_graph(case.snapshot, case.uri).graph).stories[0].variants[0]
    assert isinstance(variant.variation, Product)
    choices = variant.variation.choices[0]
    assert isinstance(choices, tuple)
    assert count(variant.variation) == len(choices)
    return [str(one).removeprefix(ENV) for one in choices]


@pytest.mark.parametrize(
    ("condition", "names"),
    [
        ("colour = red", ["bolt"]),
        ("colour = grey", ["nut"]),
        ("colour != grey", ["bolt"]),
        ("mass = 0.02 kg", ["bolt"]),
        ("mass <= 500 g", ["bolt", "nut"]),
        ("mass < 500 g", ["bolt"]),
        ("mass >= 0.02 kg and mass > 20 g", ["nut"]),
        ("fragile", ["bolt"]),
        ("not fragile", ["nut"]),
        ("fragile != false", ["bolt"]),
    ],
)
def test_conditions_select_elements(condition: str, names: list[str]) -> None:
    assert selected(model(condition)) == names
    findings = found(model(condition), "property-condition", "not-in-scene")
    assert [one for one in findings if one.severity is not Severity.INFORMATION] == []


def test_properties_of_imported_graphs_count() -> None:
    text = model("weight = 3", f'import "p.ttl"\n{SCENE}', f"//- p.ttl\n<{ENV}nut> <https://x.org/v#weight> 3.0 .\n")
    assert selected(text) == ["nut"]


def test_a_set_by_property_is_written_as_text_again() -> None:
    scene = STATED.replace(
        "tray_ws }", "tray_ws { correct for: obj set <parts> where not fragile and mass > 3 g } }", 1
    )
    case = fixture(model('colour = red and mass < 1 kg and colour != "dark red"', scene))
    assert_identity(build_graph(case.snapshot, case.uri).graph)


def test_a_set_variable_has_no_conditions() -> None:
    text = MODEL.replace("var part\n", "set var parts\n    var part\n")
    text = text.replace("Then:\n", 'Then:\n (var y exists in <parts> where a = b) such that { "x" after <end> }\n', 1)
    assert any("is a variable" in one.message for one in found(text, "property-condition"))


@pytest.mark.parametrize(
    ("values", "comparison", "wanted", "expected"),
    [
        ([("quantity", "20 g")], "=", PropertyValue(QUANTITY, "0.020 kg"), True),
        ([("number", "3")], "=", PropertyValue(NUMBER, "3.0"), True),
        ([("number", "3")], "=", PropertyValue(TEXT, "3"), False),
        ([("number", "3"), ("number", "5")], "<", PropertyValue(NUMBER, "4"), False),
        ([("number", "inf")], ">", PropertyValue(NUMBER, "4"), False),
        ([], "!=", PropertyValue(NUMBER, "4"), False),
        ([], "not", PropertyValue(TRUTH, "true"), True),
    ],
)
def test_values_are_compared(
    values: list[tuple[str, str]], comparison: str, wanted: PropertyValue, expected: bool
) -> None:
    has = {"p": [PropertyValue(*value) for value in values]}
    assert PropertyCondition("p", comparison, wanted).holds(has) is expected


def test_names_and_words_are_completed_in_conditions() -> None:
    for cut, kind, label in (("where $0", "property", "colour"), ("where colour = $0", "value", "red")):
        case = fixture(model("colour = red").replace("where colour = red", cut))
        entries = [one for one in complete(case.snapshot, case.uri, case.cursor) if one.kind == kind]
        assert label in [one.label for one in entries]
        assert all(":" not in one.text for one in entries)
