"""A model imports graphs: their statements join its graph, its shapes see them, and their faults have places."""

from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import RDF, Literal, URIRef

from kit import FOLDER, MODEL, SCENE
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.features.hover import hover
from robbdd_tools.features.quoted_completion import quoted
from robbdd_tools.features.references import references
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.graph.shapes.incremental import Validation
from robbdd_tools.graph.shapes.project_shapes import ProjectShapes, shape_file
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.graph.write.node_positions import turtle_statements
from robbdd_tools.names.project import Project, Snapshot

MAIN, LAB, EXTRA = (f"{FOLDER}{name}" for name in ("main.bdd", "lab.scene", "extra.ttl"))
ENV, PROPERTIES = "https://example.org/env/", "https://example.org/properties#"
TURTLE = """@prefix env: <https://example.org/env/> .
@prefix ex: <https://example.org/properties#> .
# 0.5 is not a statement.
env:bolt a ex:Fragile ; ex:mass 0.02 ; ex:colour "red; . or blue" .
env:panda ex:payload [ ex:value 3.0 ; ex:unit ex:kg ] .
ex:Fragile ex:label "breaks" .
"""
HEAVY = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix ex: <https://example.org/properties#> .
@prefix env: <https://secorolab.github.io/metamodels/environment#> .
ex:masses a sh:NodeShape ; sh:targetClass env:Object ;
    sh:property [ sh:path ex:mass ; sh:maxInclusive 0.01 ; sh:message "{focus} is too heavy" ] .
ex:labels a sh:NodeShape ; sh:targetClass ex:Fragile ;
    sh:property [ sh:path ex:hazard ; sh:minCount 1 ; sh:message "{focus} states no hazard" ] .
"""


def project(extra: str, name: str = "extra.ttl", importer: str = "lab.scene") -> Project:
    """Return the project of a model, one file of which imports a graph."""
    loaded = Project()
    for file, text in (("lab.scene", SCENE), ("main.bdd", MODEL)):
        loaded.open(FOLDER + file, 0, f'import "{name}"\n{text}' if file == importer else text)
    loaded.open(FOLDER + name, 0, extra)
    return loaded


def found(snapshot: Snapshot, code: str = "imported-statement") -> list[tuple[str, str, str]]:
    """Return file, marked text and message of the findings with a code."""
    return [
        (one.uri.rpartition("/")[2], snapshot.document(one.uri).text[one.span.start : one.span.end], one.message)
        for one in all_diagnostics(snapshot, MAIN)
        if one.code == code
    ]


@pytest.mark.parametrize("importer", ["lab.scene", "main.bdd"])
def test_statements_of_an_imported_graph_are_in_the_graph_of_the_model(importer: str) -> None:
    graph = build_graph(project(TURTLE, importer=importer).snapshot(), MAIN).graph
    bolt = URIRef(f"{ENV}bolt")
    assert (bolt, RDF.type, URIRef(f"{PROPERTIES}Fragile")) in graph
    assert str(graph.value(bolt, URIRef(f"{PROPERTIES}mass"))) == "0.02"
    assert (None, URIRef(f"{PROPERTIES}unit"), URIRef(f"{PROPERTIES}kg")) in graph


def test_json_ld_says_the_same_as_turtle() -> None:
    linked = serialize(parse(TURTLE, "ttl", EXTRA), "json-ld")
    turtle = build_graph(project(TURTLE).snapshot(), MAIN).graph
    json_ld = build_graph(project(linked, "extra.jsonld").snapshot(), MAIN).graph
    assert serialize(turtle, "nt") == serialize(json_ld, "nt")


def test_the_graph_of_a_model_without_imported_graphs_is_the_same_as_before() -> None:
    with_graph = set(build_graph(project(TURTLE).snapshot(), MAIN).graph)
    plain = Project()
    plain.open(LAB, 0, SCENE)
    plain.open(MAIN, 0, MODEL)
    without = build_graph(plain.snapshot(), MAIN)
    assert len(with_graph) == len(without.graph) + len(parse(TURTLE, "ttl")) + 1  # The prefix of the properties.
    assert without.faults == ()


def test_output_keeps_the_prefixes_of_imported_graphs() -> None:
    text = serialize(build_graph(project(TURTLE).snapshot(), MAIN).graph, "ttl")
    assert "ex:mass 0.02" in text
    assert f"@prefix ex: <{PROPERTIES}>" in text


def test_the_criteria_themselves_cannot_be_imported() -> None:
    text = TURTLE + (
        "@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .\n"
        "env:parts bdd:elements env:tray .\nenv:bolt a bdd:ScenarioVariant .\n"
    )
    snapshot = project(text).snapshot()
    assert found(snapshot) == [
        (
            "extra.ttl",
            "env:tray",
            "'bdd:elements' of 'env:parts' cannot be added by an import: write it in the model",
        ),
        (
            "extra.ttl",
            "bdd:ScenarioVariant",
            "the type 'bdd:ScenarioVariant' of 'env:bolt' cannot be added by an import: write it in the model",
        ),
    ]
    graph = build_graph(snapshot, MAIN).graph
    assert (URIRef(f"{ENV}parts"), None, URIRef(f"{ENV}tray")) not in graph


def test_an_imported_graph_may_repeat_what_the_model_says() -> None:
    text = f"{TURTLE}@prefix e: <https://secorolab.github.io/metamodels/environment#> .\nenv:bolt a e:Object .\n"
    assert found(project(text).snapshot()) == []


def test_the_relation_of_correct_places_may_be_imported() -> None:
    text = (
        f"{TURTLE}@prefix rbw: <https://robbdd.org/metamodels/workbench#> .\nenv:tray_ws rbw:correct-for env:bolt .\n"
    )
    snapshot = project(text).snapshot()
    assert found(snapshot) == []
    graph = build_graph(snapshot, MAIN).graph
    assert (None, URIRef("https://robbdd.org/metamodels/workbench#correct-for"), URIRef(f"{ENV}bolt")) in graph


def test_a_subject_with_a_misspelt_name_is_reported_with_a_fix() -> None:
    snapshot = project(TURTLE.replace("env:bolt", "env:bolts")).snapshot()
    (one,) = [one for one in all_diagnostics(snapshot, MAIN) if one.code == "imported-statement"]
    assert one.severity is Severity.WARNING
    assert one.message == "no model declares 'bolts', so its statements are not used; did you mean 'bolt'?"
    (edit,) = one.fixes[0].edits
    text = snapshot.document(EXTRA).text
    assert text[: edit.span.start] + edit.text + text[edit.span.end :] == TURTLE


def test_a_syntax_error_is_reported_in_the_graph_and_at_the_import() -> None:
    snapshot = project("@prefix env: <https://example.org/env/> .\nenv:bolt env:x env:y ; ; z").snapshot()
    by_code = {one.code: one for one in all_diagnostics(snapshot, MAIN)}
    assert by_code["graph-syntax"].uri == EXTRA
    line = by_code["broken-import"]
    assert (line.uri, SCENE[:0] + snapshot.document(LAB).text[line.span.start : line.span.end]) == (LAB, "extra.ttl")
    assert [place.uri for place in line.related] == [EXTRA]


@pytest.mark.parametrize("name", ["extra.ttl", "extra.jsonld"])
def test_only_some_files_import_graphs(name: str) -> None:
    loaded = project("{}" if name.endswith("ld") else "", name)
    loaded.open(f"{FOLDER}run.bddx", 0, f'import "{name}"\n')
    (one,) = [one for one in all_diagnostics(loaded.snapshot(), f"{FOLDER}run.bddx") if one.code == "import"]
    assert one.message == "only '.bdd' and '.scenex' files can be imported here"


def test_an_imported_graph_is_never_an_unused_import() -> None:
    snapshot = project(TURTLE, importer="main.bdd").snapshot()
    assert found(snapshot, "unused-import") == []


def _shapes(folder: Path) -> ProjectShapes:
    folder.joinpath("rules.ttl").write_text(HEAVY, encoding="utf-8")
    return ProjectShapes((shape_file(folder / "rules.ttl"),))


def _with_text(loaded: Project, diagnostics: list[Diagnostic]) -> list[tuple[str, str]]:
    snapshot = loaded.snapshot()
    return [
        (one.message, snapshot.document(one.uri).text[one.span.start : one.span.end])
        for one in diagnostics
        if one.code.startswith("shape-")
    ]


def test_own_shapes_check_imported_statements_where_they_are_written(tmp_path: Path) -> None:
    loaded = project(TURTLE)
    findings = validate(build_graph(loaded.snapshot(), MAIN), project=_shapes(tmp_path))
    assert _with_text(loaded, findings) == [
        ("parts.bolt is too heavy", "ex:mass"),
        ("parts.bolt states no hazard", "bolt"),
    ]


def test_incremental_validation_finds_the_same_after_a_change_of_the_graph(tmp_path: Path) -> None:
    shapes, validation, loaded = _shapes(tmp_path), Validation(), project(TURTLE)
    lighter = TURTLE.replace("0.02", "0.01")
    for text in (TURTLE, lighter, f"{lighter}env:bolt <{PROPERTIES}hazard> 1 .\n", "broken", TURTLE):
        loaded.open(EXTRA, 0, text)
        snapshot = loaded.snapshot()
        whole = validate(build_graph(snapshot, MAIN), project=shapes)
        assert validation.run(snapshot, MAIN, shapes) == whole
        assert bool(_with_text(loaded, whole)) == (text in (TURTLE, lighter))


def test_hover_lists_what_graphs_say_and_references_lead_there() -> None:
    snapshot = project(TURTLE, importer="main.bdd").snapshot()
    at = SCENE.index("bolt")
    shown = hover(snapshot, LAB, at)
    assert shown is not None
    said = ("type `ex:Fragile`", "`ex:colour`: red; . or blue", "`ex:mass`: 0.02")
    assert "\n".join(f"- {words} (extra.ttl:4)" for words in said) in shown.markdown
    start = TURTLE.index("env:bolt")
    places = [(place, span.start) for place, span in references(snapshot, LAB, at, with_declaration=False)]
    assert (EXTRA, start) in places


def test_hover_on_the_import_counts_statements() -> None:
    snapshot = project(TURTLE).snapshot()
    shown = hover(snapshot, LAB, 10)
    assert shown is not None
    assert shown.markdown == "**graph** `extra.ttl`\n\nadds 7 statements about 4 things"


def test_completion_offers_graphs_to_import(tmp_path: Path) -> None:
    for name in ("extra.ttl", "more.jsonld", "notes.txt"):
        (tmp_path / name).touch()
    scene, execution = ((tmp_path / name).as_uri() for name in ("lab.scene", "run.bddx"))
    assert [name for name, *_ in quoted(scene, 'import "')] == ["extra.ttl", "more.jsonld"]
    assert list(quoted(execution, 'import "')) == []


def test_a_graph_may_import_others_of_its_folder(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").write_text(f'import "extra.ttl"\n{SCENE}', encoding="utf-8")
    (tmp_path / "extra.ttl").write_text("<> <http://www.w3.org/2002/07/owl#imports> <more.ttl> .", encoding="utf-8")
    (tmp_path / "more.ttl").write_text(TURTLE, encoding="utf-8")
    uri = (tmp_path / "lab.scene").as_uri()
    loaded = Project()
    loaded.load(uri)
    assert (URIRef(f"{ENV}bolt"), URIRef(f"{PROPERTIES}colour"), Literal("red; . or blue")) in build_graph(
        loaded.snapshot(), uri
    ).graph


def test_places_of_statements_in_turtle() -> None:
    text = """PREFIX e: <https://e.org/>
    e:a e:p 0.5, -1. e:b a e:T ; e:q "x . y ; z" , [ e:r e:s ], ( e:t 1.5 ) ; e:u '''a
    . e:v''' .
    _:a e:w e:x . [] e:y e:z . <https://e.org/c> <https://e.org/p> e:a ."""
    found = turtle_statements(text, {"e": "https://e.org/", "": "https://e.org/"}, "file:///x.ttl")
    named = {
        tuple(part.removeprefix("https://e.org/") for part in key): text[span.start : span.end]
        for key, span in found.items()
        if key[0].startswith("https://e.org/")
    }
    type_ = str(RDF.type)
    assert named == {
        ("a", "p"): "e:p",
        ("b", type_): "a",
        ("b", type_, "T"): "e:T",
        ("b", "q"): "e:q",
        ("b", "u"): "e:u",
        ("c", "p"): "<https://e.org/p>",
        ("c", "p", "a"): "e:a",
    }


RELATED = """@prefix env: <https://example.org/env/> .
@prefix rbw: <https://robbdd.org/metamodels/workbench#> .
env:tray_ws rbw:correct-for env:bolt , env:washers , env:washer1 .
env:panda <https://example.org/properties#beside> env:tray .
<https://example.org/t/fetch> <https://example.org/properties#owner> "me" .
<https://example.org/t/bench-to-tray> <https://example.org/properties#owner> "me" .
"""


def collecting(text: str = RELATED) -> Project:
    """Return a project whose main file only imports a model and a graph about elements in the model's scene."""
    loaded = Project()
    files = {"lab.scene": SCENE, "model.bdd": MODEL, "extra.ttl": text}
    for name, content in {**files, "main.bdd": 'import "model.bdd"\nimport "extra.ttl"\n'}.items():
        loaded.open(FOLDER + name, 0, content)
    return loaded


def test_a_file_that_only_imports_a_model_and_a_graph_has_no_findings_on_correct_statements() -> None:
    snapshot = collecting().snapshot()
    assert [one for one in all_diagnostics(snapshot, MAIN) if one.severity is Severity.ERROR] == []
    assert validate(build_graph(snapshot, MAIN)) == [] == Validation().run(snapshot, MAIN)


def test_only_the_described_elements_are_added_to_such_a_file() -> None:
    graph = build_graph(collecting().snapshot(), MAIN).graph
    kinds = {
        str(kind).rpartition("#")[2]: {str(node).rpartition("/")[2] for node in graph.subjects(RDF.type, kind)}
        for kind in set(graph.objects(None, RDF.type))
    }
    assert kinds.pop("Set") == kinds.pop("ConstantSet") == {"parts", "furniture", "places", "arms", "washers"}
    assert kinds == {
        "Object": {"bolt", "nut", "bench", "tray", "washer0", "washer1", "washer2"},
        "Workspace": {"bench_ws", "tray_ws"},
        "Agent": {"panda", "ur10"},
    }


def test_wrong_statements_are_still_found_there() -> None:
    snapshot = collecting(RELATED.replace("env:bolt", "env:panda")).snapshot()
    (one,) = [one for one in all_diagnostics(snapshot, MAIN) if one.severity is Severity.ERROR]
    assert one.message.startswith("'arms.panda' is not an object")


@pytest.mark.parametrize("edited", ["places { ", "parts { ", "arms { "])
def test_after_an_edit_the_links_of_imported_graphs_lead_to_unchanged_declarations(edited: str) -> None:
    loaded, validation = project(RELATED), Validation()
    assert validation.run(loaded.snapshot(), MAIN) == []
    loaded.open(LAB, 1, f'import "extra.ttl"\n{SCENE.replace(edited, edited + " ")}')
    assert validation.run(loaded.snapshot(), MAIN) == []
    assert 0 < validation.looked_at < 20
