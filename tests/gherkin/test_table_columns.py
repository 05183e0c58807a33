"""Properties of elements in the tables of features: ``obj set <parts> with mass, colour``."""

from __future__ import annotations

import pytest

from checks.models import fixed, found
from gherkin_kit import feature, model_of, pieces, read_by_behave, read_officially
from graph.test_text import assert_identity
from kit import MODEL, SCENE, STORY, fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.property_values import NUMBER, TEXT, PropertyValue
from robbdd_tools.features.completion import complete
from robbdd_tools.features.hover import hover
from robbdd_tools.features.layout import lay_out
from robbdd_tools.features.semantic_tokens import PROPERTY, semantic_tokens
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph

ENTRY = "obj set <parts>"
STATED = SCENE.replace(
    "object bolt, object nut",
    'object bolt { mass: 20 g  colour: red, "a|b"  size: 0.50 },'
    " object nut { fragile: true  belongs: <places.tray_ws>  note: 'a \\\\ b\nc' }",
)
COLOURED = SCENE.replace("object bolt, object nut", "object bolt { mass: 20 g  colour: red }, object nut { size: 3 }")


def scene(chosen: str, stated: str = STATED) -> str:
    assert f"{ENTRY} ws" in stated
    return stated.replace(f"{ENTRY} ws", f"{ENTRY} {chosen} ws")


def rows(text: str, title: str = "a set of objects") -> list[str]:
    """Return the lines of a table in a feature, beginning with those of its heading."""
    lines = [line.strip() for line in text.split(f"{title}\n", 1)[1].splitlines()]
    end = next(number for number, line in enumerate(lines) if not line.startswith("|"))
    return lines[:end]


def test_a_table_has_the_properties_that_the_scene_chooses() -> None:
    assert rows(feature(MODEL, scene=scene("with mass, size"))) == [
        "| name | mass | size |",
        "| env:bolt | 20 g | 0.5 |",
        "| env:nut |  |  |",
        "| env:bench |  |  |",
        "| env:tray |  |  |",
    ]


def test_all_other_lines_of_a_feature_stay() -> None:
    shown, plain = (feature(MODEL, scene=one).splitlines() for one in (scene("with mass"), STATED))
    added = {
        "| name | mass |": "| name |",
        "| env:bolt | 20 g |": "| env:bolt |",
        "| env:nut |  |": "| env:nut |",
        "| env:bench |  |": "| env:bench |",
        "| env:tray |  |": "| env:tray |",
    }
    changed = {before.strip(): after.strip() for before, after in zip(shown, plain, strict=True) if before != after}
    assert changed == added


@pytest.mark.parametrize(
    ("name", "bolt", "nut"),
    [
        ("colour", "a\\|b, red", ""),
        ("fragile", "", "true"),
        ("belongs", "", "env:tray_ws"),
        ("note", "", "a \\\\\\\\ b\\\\nc"),
    ],
)
def test_a_cell_has_all_values_escaped(name: str, bolt: str, nut: str) -> None:
    lines = rows(feature(MODEL, scene=scene(f"with {name}")))
    assert lines[:3] == [f"| name | {name} |", f"| env:bolt | {bolt} |", f"| env:nut | {nut} |"]


def test_workspaces_agents_and_several_sets_have_columns() -> None:
    stated = STATED.replace("workspace bench_ws", "workspace bench_ws { area: north }")
    stated = stated.replace("agent ur10", "agent ur10 { payload: 10 kg }").replace(
        "object tray }", "object tray { mass: 1 kg } }"
    )
    stated = stated.replace(
        f"{ENTRY} ws", f"{ENTRY} with size obj set <furniture> with mass, size ws set <places> with area ws"
    )
    text = feature(MODEL, scene=stated.replace("agn set <arms> }", "agn set <arms> with payload }"))
    assert rows(text)[:2] == ["| name | size | mass |", "| env:bolt | 0.5 | 20 g |"]
    assert rows(text)[-1] == "| env:tray |  | 1 kg |"
    assert rows(text, "a set of workspaces")[:2] == ["| name | area |", "| env:bench_ws | north |"]
    assert rows(text, "a set of agents") == ["| name | payload |", "| env:panda |  |", "| env:ur10 | 10 kg |"]


def test_properties_of_imported_graphs_and_similar_sets_are_shown() -> None:
    stated = 'import "p.ttl"\n' + SCENE.replace("count: 3", "count: 3  thread: M4")
    stated = stated.replace(f"{ENTRY} ws", f"{ENTRY} with weight obj set <washers> with thread ws")
    case = fixture(
        f"//- main.bdd\n{MODEL}\n//- lab.scene\n{stated}\n"
        "//- p.ttl\n<https://example.org/env/nut> <https://x.org/v#weight> 3.0 .\n"
    )
    columns = read_model(build_graph(case.snapshot, case.uri).graph).stories[0].variants[0].scene.columns
    weights, threads = (dict(one.values) for one in columns)
    assert weights == {"https://example.org/env/nut": (PropertyValue(NUMBER, "3.0"),)}
    assert threads == {f"https://example.org/env/washer{number}": (PropertyValue(TEXT, "M4"),) for number in range(3)}


@pytest.mark.parametrize("template", ["default", "compact", "de"])
def test_parsers_read_the_columns_in_every_layout(template: str) -> None:
    text = feature(MODEL, template, scene("with colour, mass"))
    assert "| env:bolt | a\\|b, red | 20 g |" in text
    plain = feature(MODEL, template)
    for read in (read_by_behave, read_officially):
        assert [one.tables for one in read(text)] == [one.tables for one in read(plain)]


def test_the_line_map_counts_the_same_lines() -> None:
    changed = [piece.scenario for piece in pieces(MODEL, scene=scene("with mass")) if piece.scenario]
    plain = [piece.scenario for piece in pieces(MODEL) if piece.scenario]
    assert [(one.line, one.lines) for one in changed] == [(one.line, one.lines) for one in plain]


def test_an_outline_does_not_replace_parts_of_a_property() -> None:
    second = STORY[STORY.index("        Scenario ") : STORY.rindex("}")].replace("bench-to-tray", "bare")
    source = MODEL[: MODEL.rindex("}")] + second.replace("<bench_scene>", "<bare_scene>") + "}\n"
    bare = "scene (ns=env) bare_scene { obj set <parts> with colour }\n"
    for word, outlines in (("red", 2), ("<part>", 1)):
        stated = SCENE.replace("object bolt", f'object bolt {{ colour: "{word}" }}') + bare
        text = feature(source, "compact", stated)
        assert text.count("Scenario Outline:") == outlines
        assert f"| env:bolt | {word} |" in text


def test_the_graph_keeps_the_columns() -> None:
    stated = scene("with mass, colour").replace("agn set <arms> }", "agn set <arms> obj set <furniture> with size }")
    case = fixture(f"//- main.bdd\n{MODEL}\n//- lab.scene\n{stated}")
    graph = build_graph(case.snapshot, case.uri).graph
    assert_identity(graph)
    assert "PropertyColumn" in graph.serialize(format="nt")
    assert model_of(MODEL, stated).stories[0].variants[0].scene.columns[2].name == "size"
    plain = fixture(f"//- main.bdd\n{MODEL}\n//- lab.scene\n{STATED}")
    assert "olumn" not in build_graph(plain.snapshot, plain.uri).graph.serialize(format="nt")


def test_only_properties_of_the_set_are_completed() -> None:
    stated = COLOURED.replace("object tray", "object tray { depth: 3 cm }")
    for cut, labels in (
        ("with $0", ["colour", "mass", "size"]),
        ("with mass, $0", ["colour", "size"]),
        ("with mass, co$0", ["colour", "size"]),
    ):
        case = fixture(f"//- lab.scene\n{scene(cut, stated)}")
        entries = [one for one in complete(case.snapshot, case.uri, case.cursor) if one.kind == "property"]
        assert [one.label for one in entries] == labels
        assert [one.text for one in entries] == labels
    case = fixture(f"//- lab.scene\n{scene('$0', stated)}")
    assert "with" in [one.label for one in complete(case.snapshot, case.uri, case.cursor)]


def test_hover_describes_the_property_and_the_word() -> None:
    for cut, expected in (("with colour, ma$0ss", "20 g"), ("wi$0th mass", "the tables of the elements")):
        case = fixture(f"//- lab.scene\n{scene(cut, COLOURED)}")
        shown = hover(case.snapshot, case.uri, case.cursor)
        assert shown is not None
        assert expected in shown.markdown


def test_the_first_column_is_not_repeated() -> None:
    assert rows(feature(MODEL, scene=scene("with name, mass, mass")))[:2] == ["| name | mass |", "| env:bolt | 20 g |"]


def test_columns_have_the_colour_of_properties() -> None:
    case = fixture(f"//- lab.scene\n{scene('with mass, colour', COLOURED)}")
    source = case.project.texts()[case.uri][1]
    start = source.index("with mass")
    found = {
        source[one.span.start : one.span.end]: one.concept
        for one in semantic_tokens(case.snapshot, case.uri)
        if one.span.start >= start
    }
    assert (found["mass"], found["colour"]) == (PROPERTY, PROPERTY)


def test_columns_stay_with_their_set_when_laid_out() -> None:
    assert (
        lay_out("scene s {\nobj set <a> with  mass ,colour\n}\n") == "scene s {\n    obj set <a> with mass, colour\n}\n"
    )


def test_misspelt_and_repeated_columns_are_reported() -> None:
    text = f"//- lab.scene\n{scene('with color, mass, mass, name', COLOURED)}"
    messages = [one.message for one in found(text, "table-column")]
    assert messages == [
        "no element of 'parts' has the property 'color': did you mean 'colour'?",
        "the table already has a column 'mass': choose another property, or remove this one",
        "the table already has a column 'name': choose another property, or remove this one",
    ]
    assert {one.severity for one in found(text, "table-column")} == {Severity.WARNING}
    assert "with colour, mass" in fixed(text, "table-column")
    assert not found(f"//- lab.scene\n{scene('with colour, mass, size', COLOURED)}", "table-column")


@pytest.mark.parametrize("cut", ["with", "with mass,"])
def test_an_unfinished_choice_leaves_the_other_entries(cut: str) -> None:
    assert [one.code for one in found(f"//- lab.scene\n{scene(cut, COLOURED)}")] == ["syntax"]
    (other,) = found(f"//- main.bdd\n{MODEL}\n//- lab.scene\n{scene(cut, COLOURED)}")
    assert other.message == "'lab.scene' has an error, the first: unexpected 'ws': expected a property"
