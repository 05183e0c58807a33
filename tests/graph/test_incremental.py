"""After any edits, incremental validation finds the same as validation of the whole graph.

``ROBBDD_FUZZ`` sets the number of edit sequences; a failure shrinks to few edits.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from graph.models import EVERYTHING
from kit import EXAMPLES, FOLDER, MODEL, SCENE, STORY, TEMPLATE
from robbdd_tools.graph.shapes.incremental import Superseded, Validation
from robbdd_tools.graph.shapes.project_shapes import ProjectShapes, ShapeFile, shape_file
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project, Snapshot

SEQUENCES = int(os.environ.get("ROBBDD_FUZZ", "10"))
SCENARIO = re.compile(r"^ +Scenario [^{]*\{.*?^ {8}\}\n", re.MULTILINE | re.DOTALL)
DECLARATION = re.compile(r"^(?=\S)(?![})|])", re.MULTILINE)
MAIN, LAB = f"{FOLDER}main.bdd", f"{FOLDER}lab.scene"
PREFIXES = """@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix time: <https://secorolab.github.io/metamodels/time#> .
@prefix lab: <https://example.org/lab#> .
"""
SAFETY = """
lab:safety a sh:NodeShape ; sh:targetClass bdd:ScenarioTemplate ; sh:property [
    sh:path ( bdd:has-clause [ sh:zeroOrMorePath rdf:rest ] rdf:first ) ;
    sh:qualifiedValueShape [ sh:class bdd:DoesNotDropPredicate ] ; sh:qualifiedMinCount 1 ;
    sh:message "{focus} states no safety clause" ] .
"""
USED = """
lab:used a sh:NodeShape ; sh:targetClass bdd:ScenarioTemplate ; sh:property [
    sh:path [ sh:inversePath bdd:of-template ] ; sh:minCount 1 ; sh:message "{focus} is used by no scenario" ] .
"""


def _pairs() -> list[dict[str, str]]:
    """Models with the files they import: ours, and foreign ones if available."""
    second = TEMPLATE.replace("fetch", "bring").replace("on-bench", "on-b").replace("in-tray", "in-t")
    both = MODEL + second + STORY.replace("fetch", "bring").replace("bench-to-tray", "again")
    pairs = [{"main.bdd": both, "lab.scene": SCENE}, {"main.bdd": EVERYTHING, "lab.scene": SCENE}]
    pairs.append({"main.bdd": one_story(4), "lab.scene": SCENE})
    folders = [EXAMPLES / "pickplace", EXAMPLES / "tworobots"]
    if corpus := os.environ.get("ROBBDD_CORPUS"):
        folders.append(Path(corpus, "current"))
    for folder in folders:
        texts = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.*"))}
        for name, text in texts.items():
            if name.endswith((".bdd", ".bddx")):
                imported = {other: texts[other] for other in re.findall(r'^import "([^"]*)"', text, re.MULTILINE)}
                pairs.append({name: text, **imported, **{other: texts[other] for other in texts if ".scene" in other}})
    return pairs


def one_story(count: int) -> str:
    """Return a model whose only story has many scenarios."""
    scenario = SCENARIO.search(STORY)
    assert scenario is not None
    copies = (scenario[0].replace("bench-to-tray", f"bench-to-tray{number}") for number in range(count))
    return MODEL.replace(scenario[0], "".join(copies))


PAIRS = _pairs()
EDIT = st.tuples(
    st.sampled_from(["reference", "line", "declaration", "copy", "scenario", "number", "word", "piece", "undo"]),
    st.floats(0, 0.999),
    st.floats(0, 0.999),
    st.booleans(),
)


def edited(text: str, other: str, kind: str, where: float, what: float) -> str:
    """Return a text after an edit of the kind that users make; most edits keep it valid."""

    def replaced(pattern: str, *choices: str) -> str:
        places = list(re.finditer(pattern, text, SCENARIO.flags))
        if not places:
            return text
        found = places[int(where * len(places))]
        pool = list(choices) or [place[0] for place in places]
        return text[: found.start()] + pool[int(what * len(pool))] + text[found.end() :]

    starts = [found.start() for found in DECLARATION.finditer(text)] + [len(text)]
    number = int(where * (len(starts) - 1))
    declaration = text[starts[number] : starts[min(number + 1, len(starts) - 1)]]
    match kind:
        case "reference":
            return replaced(r"(?<=<)[\w.-]+(?=>)")
        case "line":
            return replaced(r"[^\n]*\n", "")
        case "declaration":
            return text.replace(declaration, "", 1) if declaration else text
        case "copy":
            place = starts[int(what * len(starts))]
            return text[:place] + declaration + text[place:]
        case "scenario":
            return replaced(SCENARIO.pattern, "", *(f"{place[0]}{place[0]}" for place in SCENARIO.finditer(text)))
        case "number":
            return replaced(r"\b\d+(\.\d+)?\b", "0", "1", "2", "7")
        case "word":
            return replaced(r"\b(set var|var|obj|ws|agn|before|after|picks|places)\b", "set var", "var", "obj", "ws")
        case _:
            start, length = int(what * len(other)), 1 + int(what * 1000) % 12
            place = int(where * len(text))
            return text[:place] + other[start : start + length] + text[place:]


@settings(max_examples=SEQUENCES, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.sampled_from(PAIRS), st.lists(EDIT, min_size=2, max_size=8), st.booleans())
def test_what_an_edit_touched_is_enough(
    shape_files: ProjectShapes, texts: dict[str, str], edits: list[tuple[str, float, float, bool]], with_shapes: bool
) -> None:
    files = {FOLDER + name: text for name, text in texts.items()}
    main, *others = files
    shapes = shape_files if with_shapes else ProjectShapes()
    project, validation = Project(), Validation()
    for uri, text in files.items():
        project.open(uri, 0, text)
    _compare(validation, project.snapshot(), main, shapes)
    for version, (kind, where, what, in_import) in enumerate(edits, start=1):
        uri = others[0] if in_import and others else main
        before = files[uri]
        files[uri] = (
            texts[uri.removeprefix(FOLDER)] if kind == "undo" else edited(before, files[main], kind, where, what)
        )
        project.open(uri, version, files[uri])
        _compare(validation, project.snapshot(), main, shapes)


def _compare(validation: Validation, snapshot: Snapshot, uri: str, shapes: ProjectShapes) -> None:
    assert validation.run(snapshot, uri, shapes) == validate(build_graph(snapshot, uri), project=shapes)


@pytest.fixture(scope="module")
def shape_files(tmp_path_factory: pytest.TempPathFactory) -> ProjectShapes:
    folder = tmp_path_factory.mktemp("shapes")
    return ProjectShapes(tuple(_shape_file(folder, name, text) for name, text in (("safe", SAFETY), ("used", USED))))


def _shape_file(folder: Path, name: str, text: str) -> ShapeFile:
    path = folder / f"{name}.ttl"
    path.write_text(PREFIXES + text, encoding="utf-8")
    return shape_file(path)


def opened(text: str = MODEL, scene: str = SCENE) -> Project:
    project = Project()
    project.open(LAB, 1, scene)
    project.open(MAIN, 1, text)
    return project


def many(count: int) -> str:
    """Return a model of many templates, each with a story."""
    return MODEL[: len(MODEL) - len(TEMPLATE) - len(STORY)] + "".join(
        re.sub(r"\b(fetch|fetching|on-bench|in-tray|bench-to-tray|carry)\b", rf"\g<1>{number}", TEMPLATE + STORY)
        for number in range(count)
    )


@pytest.mark.parametrize(
    ("old", "new", "most"),
    [
        ("0.5 seconds", "0 seconds", 3),
        ('"parts fetched"', '"parts brought"', 1),
        ("Scenario Template (ns=t) fetch7 ", "// a remark\nScenario Template (ns=t) fetch7 ", 1),
    ],
)
def test_an_edit_costs_what_it_touches_whatever_else_the_file_holds(old: str, new: str, most: int) -> None:
    project, validation = opened(many(20)), Validation()
    validation.run(project.snapshot(), MAIN)
    assert validation.looked_at > 40
    project.open(MAIN, 2, many(20).replace(old, new, 1))
    validation.run(project.snapshot(), MAIN)
    assert validation.looked_at <= most


def test_an_edit_in_a_story_looks_at_one_scenario() -> None:
    text = one_story(20)
    project, validation = opened(text), Validation()
    assert validation.run(project.snapshot(), MAIN) == []
    place = text.index("bench-to-tray10")
    project.open(MAIN, 2, text[:place] + text[place:].replace("template: <fetch>", "template:  <fetch>", 1))
    assert validation.run(project.snapshot(), MAIN) == []
    assert validation.looked_at == 1


def test_an_error_in_a_scenario_hides_no_finding_in_the_others() -> None:
    text = one_story(3)
    first, second = text.index("bench-to-tray0"), text.index("bench-to-tray1")
    broken = text[:second] + text[second:].replace("scene: <", "scene: <nothing.", 1)
    wrong = broken[:first] + broken[first:].replace("{ <arms.panda> }", "{ <parts.bolt> }", 1)
    project = opened(wrong)
    found = Validation().run(project.snapshot(), MAIN)
    assert found == validate(build_graph(project.snapshot(), MAIN))
    assert [wrong.count("Scenario bench", 0, entry.span.start) for entry in found] == [1]


def test_an_edit_of_a_scene_looks_at_the_stories_that_use_it() -> None:
    project, validation = opened(many(3)), Validation()
    assert validation.run(project.snapshot(), MAIN) == []
    project.open(LAB, 2, SCENE.replace("object bolt, object nut", ""))
    found = validation.run(project.snapshot(), MAIN)
    assert {entry.uri for entry in found} == {LAB, MAIN}


def test_newer_work_takes_over_between_groups_and_nothing_is_lost() -> None:
    project, validation = opened(many(60).replace("0.5 seconds", "0 seconds")), Validation()
    answers = iter([False, True])
    with pytest.raises(Superseded):
        validation.run(project.snapshot(), MAIN, is_superseded=lambda: next(answers))
    before = validation.looked_at
    found = validation.run(project.snapshot(), MAIN)
    afterwards, whole = validation.looked_at, Validation()
    whole.run(project.snapshot(), MAIN)
    assert before > 0
    assert before + afterwards == whole.looked_at
    assert found == validate(build_graph(project.snapshot(), MAIN))
    assert len(found) == 60


def test_two_nodes_with_one_iri_are_found_in_a_part_as_in_the_whole() -> None:
    project = Project()
    project.open(LAB, 0, SCENE)
    project.open(MAIN, 0, MODEL + TEMPLATE.replace("fetch", "bring").replace("in-tray", "in-t"))
    snapshot = project.snapshot()
    whole = validate(build_graph(snapshot, MAIN))
    assert "duplicate-iri" in [entry.code for entry in whole]
    assert Validation().run(snapshot, MAIN) == whole
