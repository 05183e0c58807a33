"""Properties that a scene states: their triples, their text, completion, hover and colours."""

from __future__ import annotations

import pytest
from rdflib import Literal, URIRef
from rdflib.namespace import XSD

from checks.models import fixed, found
from graph.statements import built
from graph.test_text import assert_identity, there_and_back
from kit import MODEL, SCENE, Fixture, fixture
from robbdd_tools.features.completion import complete
from robbdd_tools.features.hover import hover
from robbdd_tools.features.semantic_tokens import semantic_tokens
from robbdd_tools.graph.property_facts import properties_by_element
from robbdd_tools.graph.rdf.serialize import parse
from robbdd_tools.graph.rdf.vocabulary import QUANTITY
from robbdd_tools.graph.read.acceptance import read_model

ENV = "https://example.org/env/"
STATED = (
    SCENE.replace("object bolt", "object bolt { mass: 20 g  colour: red  fragile: true  size: 3  mates: <parts.nut> }")
    .replace("object nut", 'object nut { colour: "dark blue", grey }')
    .replace("workspace tray_ws }", "workspace tray_ws { colour: red correct for: obj <parts.bolt> height: 1.5 } }")
    .replace("count: 3", "count: 3  mass: 2.5e-3 kg  fragile: false")
)
BOTH = f"//- main.bdd\n{MODEL}//- lab.scene\n{STATED}"


def lab(text: str) -> Fixture:
    return fixture(f"//- lab.scene\n{text}")


def test_a_property_is_a_triple_in_the_namespace_of_its_set() -> None:
    graph = built(f"//- lab.scene\n{STATED}").graph

    def values(element: str, name: str) -> set[object]:
        return set(graph.objects(URIRef(ENV + element), URIRef(ENV + name)))

    assert values("bolt", "mass") == {Literal("20 g", datatype=URIRef(QUANTITY))}
    assert values("bolt", "fragile") == {Literal("true", datatype=XSD.boolean)}
    assert values("bolt", "size") == {Literal("3", datatype=XSD.integer)}
    assert values("bolt", "mates") == {URIRef(f"{ENV}nut")}
    assert values("nut", "colour") == {Literal("dark blue"), Literal("grey")}
    assert values("tray_ws", "height") == {Literal("1.5", datatype=XSD.double)}
    assert values("washer2", "mass") == {Literal("2.5e-3 kg", datatype=URIRef(QUANTITY))}
    assert values("washer0", "fragile") == {Literal("false", datatype=XSD.boolean)}


def test_an_imported_graph_can_state_the_same() -> None:
    turtle = f'@prefix env: <{ENV}> .\nenv:bolt env:mass "20 g"^^<{QUANTITY}> ; env:colour "red" ; env:fragile true .\n'
    stated = SCENE.replace("object bolt", "object bolt { mass: 20 g  colour: red  fragile: true }")
    own = lab(stated)
    other = fixture(f'//- lab.scene\nimport "p.ttl"\n{SCENE}//- p.ttl\n{turtle}')
    assert properties_by_element(own.snapshot, own.uri) == properties_by_element(other.snapshot, other.uri)
    assert set(parse(turtle, "ttl", "file:///p.ttl")) <= set(
        built(f"//- main.bdd\n{MODEL}//- lab.scene\n{stated}").graph
    )


def test_terms_of_vocabularies_are_no_properties() -> None:
    turtle = f"@prefix env: <{ENV}> .\nenv:tray_ws <https://robbdd.org/metamodels/workbench#correct-for> env:bolt .\n"
    case = fixture(f'//- lab.scene\nimport "p.ttl"\n{SCENE}//- p.ttl\n{turtle}env:bolt a env:Fragile .\n')
    assert properties_by_element(case.snapshot, case.uri) == {}


def test_properties_are_written_as_text_again() -> None:
    graph = built(BOTH.replace("comp <tray_comp> agn", "comp <tray_comp> obj set <washers> agn")).graph
    assert (URIRef(f"{ENV}washer2"), URIRef(f"{ENV}mass"), None) in graph
    assert_identity(graph)
    assert len(there_and_back(graph)[0]) == len(graph)


@pytest.mark.parametrize(
    "value", ['"x"@de', "0.02", '"2020"^^<http://www.w3.org/2001/XMLSchema#gYear>', "[ a <https://x/Y> ]"]
)
def test_a_value_that_the_language_cannot_write_is_reported_as_lost(value: str) -> None:
    graph = built(BOTH).graph
    graph += parse(f"<{ENV}nut> <{ENV}other> {value} .", "ttl", "file:///x.ttl")
    assert any("env:other" in line for line in there_and_back(graph)[1].lost)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("object nut { mass: 12 }, object cog { mass: 3 g }", "'mass' is a mass here and a number elsewhere"),
        ("object nut { mass: 12 mm }, object cog { mass: 3 g }", "'mass' is a mass here and a length elsewhere"),
        ("object nut { wide: true }, object cog { wide: 3 }", "'wide' is a number here and a truth value elsewhere"),
        ("object nut { bolt: 3 }", "'bolt' is an element of this set"),
        ("object nut { a: 3 b: 2 a: 4 }", "'a' is already stated"),
    ],
)
def test_values_that_cannot_be_used_are_reported(text: str, message: str) -> None:
    findings = found(f"//- lab.scene\n{SCENE.replace('object nut', text)}", "property-value")
    assert [finding.message.startswith(message) for finding in findings] == [True]


@pytest.mark.parametrize(
    "text", ["object nut { mass: 12 g }, object cog { mass: 1 kg }", "object nut { a: 3, 2 b: 3 }"]
)
def test_values_of_one_kind_are_fine(text: str) -> None:
    assert found(f"//- lab.scene\n{SCENE.replace('object nut', text)}", "property-value") == []


def test_a_set_in_the_namespace_of_a_vocabulary_has_no_properties() -> None:
    scene = STATED.replace(ENV, "https://secorolab.github.io/metamodels/environment#")
    assert "published vocabulary" in found(f"//- lab.scene\n{scene}", "property-value")[0].message


def offered(text: str) -> list[tuple[str, str]]:
    case = lab(STATED.replace("object nut", text))
    entries = complete(case.snapshot, case.uri, case.cursor)
    return [(entry.label, entry.detail) for entry in entries if entry.kind in ("property", "value")]


def test_the_names_of_properties_are_completed_by_those_of_the_model() -> None:
    names = offered('object cog { colour: "dark blue" m$0 }, object nut')
    assert ("mass", "20 g, 2.5e-3 kg") in names
    assert {name for name, _ in names} == {"mass", "fragile", "size", "mates", "height"}


def test_values_are_completed_by_those_that_the_property_has() -> None:
    assert offered("object cog { colour: $0 }, object nut") == [("red", ""), ('"dark blue"', ""), ("grey", "")]
    assert offered("object cog { colour: red, $0 }, object nut") == [("red", ""), ('"dark blue"', ""), ("grey", "")]
    assert offered("object cog { unknown: $0 }, object nut") == []


def test_hover_describes_properties_and_elements() -> None:
    case = lab(STATED.replace("mass: 20 g", "m$0ass: 20 g"))
    shown = hover(case.snapshot, case.uri, case.cursor)
    assert shown is not None
    assert shown.markdown.startswith("**property** `mass`\n\nstated for 4 elements: 20 g, 2.5e-3 kg")
    case = lab(STATED.replace("object bolt", "object bo$0lt"))
    shown = hover(case.snapshot, case.uri, case.cursor)
    assert shown is not None
    assert "- `colour`: red" in shown.markdown


def test_names_and_words_have_colours() -> None:
    case = lab("ns e = 'https://e/'\nobj set (ns=e) s { object o { count: red  of: true  scene: 3 g } }\n")
    text = case.snapshot.document(case.uri).text
    colours = {text[one.span.start : one.span.end]: one.concept for one in semantic_tokens(case.snapshot, case.uri)}
    assert {colours[name] for name in ("count", "of", "scene")} == {"property"}
    assert (colours["red"], colours["true"]) == ("string", "keyword")


def test_a_graph_that_only_the_executable_scene_imports_states_correct_places() -> None:
    turtle = f"@prefix env: <{ENV}> .\nenv:tray_ws <https://robbdd.org/metamodels/workbench#correct-for> env:bolt .\n"
    execution = """//- main.bddx
import "main.bdd"
import "lab.scenex"
ns x = 'https://example.org/x/'
bhv impl (ns=x) built-in { catalog "pick-place" }
Scenario Exec (ns=x) once { variant: <fetching.bench-to-tray> scene inst: <models> bhv: <built-in> }
//- lab.scenex
import "lab.scene"
import "p.ttl"
ns s = 'https://example.org/s/'
scene inst (ns=s) models { scene: <bench_scene> }
"""
    graph = built(f"{execution}//- p.ttl\n{turtle}//- main.bdd\n{MODEL}//- lab.scene\n{SCENE}").graph
    assert read_model(graph).correct_places == {f"{ENV}bolt": (f"{ENV}tray_ws",)}


def test_mass_and_friction_of_objects_are_settings_in_si_units() -> None:
    stated = STATED.replace("colour: red  fragile", "colour: red  friction: 0.3  fragile", 1)
    several = stated.replace("count: 3  mass: 2.5e-3 kg", "count: 3  mass: 1 g, 2 g  friction: low")
    settings = read_model(built(f"//- lab.scene\n{stated}").graph).stated_settings
    assert settings == {f"{ENV}bolt": {"mass": "0.02", "friction": "0.3"}} | {
        f"{ENV}washer{number}": {"mass": "0.0025"} for number in range(3)
    }
    settings = read_model(built(f"//- lab.scene\n{several}").graph).stated_settings
    assert set(settings) == {f"{ENV}bolt"}


def test_an_imported_graph_states_a_mass_that_is_simulated() -> None:
    turtle = f'@prefix env: <{ENV}> .\nenv:bolt env:mass "0.5 kg"^^<{QUANTITY}> .\n'
    graph = built(f'//- main.bdd\n{MODEL}//- lab.scene\nimport "p.ttl"\n{SCENE}//- p.ttl\n{turtle}').graph
    assert read_model(graph).stated_settings == {f"{ENV}bolt": {"mass": "0.5"}}


@pytest.mark.parametrize(
    ("properties", "words"),
    [
        ("mass: 0 kg", "no scene with this object can be set up: 'mass' cannot be '0': it must be a number from 0.001"),
        ("mass: 80 kg", "'mass' cannot be '80'"),
        ("friction: 50", "'friction' cannot be '50': it must be a number from 0.01 to 2"),
        ("mass: 20", "a mass without a unit is not simulated: write its unit, as in '20 g'"),
    ],
)
def test_a_mass_or_friction_that_no_simulation_has_is_reported(properties: str, words: str) -> None:
    text = SCENE.replace("object bolt", f"object bolt {{ {properties} }}")
    (finding,) = found(f"//- lab.scene\n{text}", "property-value")
    assert words in finding.message
    assert text[finding.span.start : finding.span.end] == properties


def test_the_unit_of_a_mass_is_added_by_a_fix() -> None:
    text = f"//- lab.scene\n{SCENE}".replace("count: 3", "count: 3 mass: 20")
    assert "mass: 20 kg }" in fixed(text, "property-value", "Add 'kg'")


@pytest.mark.parametrize(
    "properties", ["mass: 20 g", "friction: 0.4", "friction: low", "mass: heavy", "mass: 1 g, 0 g"]
)
def test_other_masses_and_frictions_are_not_reported(properties: str) -> None:
    assert (
        found(f"//- lab.scene\n{SCENE}".replace("object bolt", f"object bolt {{ {properties} }}"), "property-value")
        == []
    )


def test_the_mass_of_an_agent_only_describes() -> None:
    assert found(f"//- lab.scene\n{SCENE}".replace("agent panda", "agent panda { mass: 0 kg }"), "property-value") == []
