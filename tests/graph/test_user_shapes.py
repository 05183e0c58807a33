"""A project's own shapes: found upwards, reported at the tokens and with the shape, broken ones at their place."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import MODEL, SCENE
from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.names.project import Project

SAFETY = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix lab: <https://example.org/lab#> .

lab:safety a sh:NodeShape ;
    sh:targetClass bdd:ScenarioTemplate ;
    sh:property [
        sh:path ( bdd:has-clause [ sh:zeroOrMorePath rdf:rest ] rdf:first ) ;
        sh:qualifiedValueShape [ sh:class bdd:DoesNotDropPredicate ] ;
        sh:qualifiedMinCount 1 ;
        sh:severity sh:Warning ;
        sh:message "{focus} states no safety clause: write 'does not drop' in Then" ] .
"""
TOML = '[tool.robbdd]\nshapes = ["shapes/*.ttl"]\n'


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "models").mkdir()
    (tmp_path / "shapes").mkdir()
    (tmp_path / "models" / "main.bdd").write_text(MODEL, encoding="utf-8")
    (tmp_path / "models" / "lab.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "shapes" / "safety.ttl").write_text(SAFETY, encoding="utf-8")
    (tmp_path / "pyproject.toml").write_text(TOML, encoding="utf-8")
    return tmp_path


def check(folder: Path) -> list[Diagnostic]:
    """Return the findings, without remarks on models, which every scene without a .scenex has."""
    uri = (folder / "models" / "main.bdd").as_uri()
    loaded = Project()
    loaded.load(uri)
    return [one for one in all_diagnostics(loaded.snapshot(), uri) if one.code not in ("catalog-models", "no-model")]


def words(folder: Path) -> list[tuple[str, str, str]]:
    """File, code and message of each finding."""
    return [(found.uri.rpartition("/")[2], found.code, found.message) for found in check(folder)]


def test_a_finding_stands_at_the_token_with_the_shape_as_related_place(project: Path) -> None:
    (found,) = check(project)
    assert MODEL[found.span.start : found.span.end] == "fetch"
    assert (found.code, found.severity) == ("shape-safety", Severity.WARNING)
    assert found.message == "fetch states no safety clause: write 'does not drop' in Then"
    (related,) = [place for place in found.related if place.uri.endswith("safety.ttl")]
    assert Document("", 0, SAFETY).position(related.span.start).line == 5


def test_a_model_that_keeps_the_rule_is_clean(project: Path) -> None:
    safe = MODEL.replace(
        "        in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
        "        ( in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
        " and safe: holds(<robot> does not drop <part>, from <start> until <end>) )",
    )
    (project / "models" / "main.bdd").write_text(safe, encoding="utf-8")
    assert check(project) == []


def test_the_nearest_configuration_counts_and_robbdd_toml_is_one(project: Path) -> None:
    (project / "models" / "pyproject.toml").write_text('[project]\nname = "x"\n', encoding="utf-8")
    assert len(check(project)) == 1
    (project / "models" / "robbdd.toml").write_text("shapes = []\n", encoding="utf-8")
    assert check(project) == []


def test_a_changed_shape_is_read_again(project: Path) -> None:
    assert len(check(project)) == 1
    (project / "shapes" / "safety.ttl").write_text(SAFETY.replace("{focus} states", "This template states"), "utf-8")
    assert check(project)[0].message.startswith("This template states")


def test_a_broken_file_is_reported_at_its_place_and_the_others_are_still_checked(project: Path) -> None:
    (project / "shapes" / "broken.ttl").write_text("@prefix x: <https://e.org/> .\nx:a x:b ;;; y\n", encoding="utf-8")
    found = {entry.code: entry for entry in check(project)}
    assert set(found) == {"shapes-syntax", "shapes-unchecked", "shape-safety"}
    assert found["shapes-syntax"].uri.endswith("/shapes/broken.ttl")
    assert found["shapes-syntax"].span.start > len("@prefix x: <https://e.org/> .")
    assert found["shapes-unchecked"].uri.endswith("/main.bdd")
    assert found["shapes-unchecked"].related[0].uri.endswith("/shapes/broken.ttl")


def test_shapes_that_make_no_sense_are_reported_and_the_others_are_still_checked(
    project: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    senseless = """@prefix sh: <http://www.w3.org/ns/shacl#> .
<https://example.org/s> a sh:NodeShape ; sh:targetNode <https://example.org/x> ; sh:minCount 1 .
"""
    (project / "shapes" / "a.ttl").write_text(senseless, encoding="utf-8")
    found = words(project)
    assert [code for _, code, _ in found] == ["shapes-unchecked", "shape-safety", "shapes-syntax"]
    assert "MinCountConstraintComponent can only be present on a PropertyShape" in found[2][2]
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(
    "asks",
    [
        'sh:sparql [ a sh:SPARQLConstraint ; sh:select "SELECT $this WHERE { %s }" ]',
        'sh:rule [ a sh:SPARQLRule ; sh:construct "CONSTRUCT { $this ?p ?o } WHERE { %s }" ]',
    ],
)
def test_a_shape_that_would_ask_a_server_is_refused(project: Path, asks: str) -> None:
    query = asks % "SERVICE <https://example.org/> { $this ?p ?o }"
    asking = f"{SAFETY}lab:ask a sh:NodeShape ; sh:targetClass bdd:UserStory ; {query} .\n"
    (project / "shapes" / "safety.ttl").write_text(asking, encoding="utf-8")
    assert [code for _, code, _ in words(project)] == ["shapes-unchecked", "shapes-syntax"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[tool.robbdd]\nshapes = "shapes/*.ttl"\n', "'shapes' is a list of file patterns, such as"),
        ('[tool.robbdd]\nshapes = ["rules/*.ttl"]\n', "no file matches the shapes 'rules/*.ttl'"),
        ('[tool.robbdd]\nshapes = ["/abs/*.ttl"]\n', "'/abs/*.ttl' is not a file pattern"),
        ("[tool.robbdd]\nshapes = [\n", "not valid TOML: "),
    ],
)
def test_a_wrong_configuration_is_reported_at_its_place(project: Path, text: str, message: str) -> None:
    (project / "pyproject.toml").write_text(text, encoding="utf-8")
    warning, error = check(project)
    assert warning.code == "shapes-unchecked"
    assert (error.uri.rpartition("/")[2], error.code) == ("pyproject.toml", "config")
    assert error.message.startswith(message)
    assert Document("", 0, text).position(error.span.start).line >= 1


def test_a_project_without_configuration_has_our_shapes_only(project: Path) -> None:
    (project / "pyproject.toml").write_text("[tool.other]\nx = 1\n", encoding="utf-8")
    assert check(project) == []
