"""Type definition, implementation, call hierarchy, growing selections, links: ways from one place to others."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from kit import MODEL, MODELS, SCENE, Fixture, fixture
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.call_hierarchy import callable_at, calls_from, calls_to
from robbdd_tools.features.document_links import document_links
from robbdd_tools.features.implementation import implementation
from robbdd_tools.features.selection_ranges import selections
from robbdd_tools.features.type_definition import type_definition
from robbdd_tools.names.project import Project

RUNS = """//- run.bddx
import "main.bdd"
import "cell.scenex"
ns x = 'https://example.org/x/'
bhv impl (ns=x) arm-motion { catalog "pick-place" }
obs policy (ns=x) tray-policy for <fetch.in-tray> { trinary topic: "/tray" }
Scenario Exec (ns=x) nightly { variant: <fetching.bench-to-tray> scene inst: <cell> bhv: <arm-motion> }
//- cell.scenex
import "lab.scene"
ns x = 'https://example.org/x/'
scene inst (ns=x) cell { scene: <bench_scene> }
"""


def at(word: str, scene: bool = False) -> tuple[Fixture, str]:
    files = {"main.bdd": MODEL, "lab.scene": SCENE}
    name = "lab.scene" if scene else "main.bdd"
    assert word.replace("$0", "") in files[name]
    files[name] = files[name].replace(word.replace("$0", ""), word, 1)
    case = fixture("".join(f"//- {file}\n{text}" for file, text in files.items()) + RUNS)
    return case, f"file:///fixture/{name}"


def words(case: Fixture, places: list[tuple[str, Span]]) -> list[str]:
    texts = case.project.texts()
    return [texts[uri][1][span.start : span.end] if uri in texts else uri.rsplit("/", 1)[-1] for uri, span in places]


@pytest.mark.parametrize(
    ("word", "names"),
    [
        ("Scenario bench-$0to-tray", ["fetch"]),
        ("<arms.pan$0da>", ["arms"]),
        ("var pa$0rt", ["parts"]),
        ("var go$0al", ["places"]),
        ("<st$0art>", []),
    ],
)
def test_a_thing_leads_to_what_it_is_one_of(word: str, names: list[str]) -> None:
    case, uri = at(word)
    assert words(case, type_definition(case.snapshot, uri, case.cursor)) == names


@pytest.mark.parametrize(
    ("word", "names"),
    [
        ("template: <fe$0tch>", ["bench-to-tray"]),
        ("in-$0tray: holds", ["tray-policy"]),
        ("on-$0bench: holds", ["located_at.py"]),
        ("is loc$0ated at", ["located_at.py"]),
        ("Behaviour (ns=t) car$0ry", ["arm-motion", "pick_place.py"]),
        ("Task (ns=t) ta$0sk", ["fetch"]),
        ("Scenario bench-$0to-tray", ["nightly"]),
        ("scene: <bench_$0scene>", ["cell"]),
        ("var pa$0rt", []),
    ],
)
def test_what_is_stated_leads_to_what_carries_it_out(word: str, names: list[str]) -> None:
    case, uri = at(word)
    assert words(case, implementation(case.snapshot, uri, case.cursor)) == names


def test_stories_call_variants_these_templates_and_these_behaviours() -> None:
    case, uri = at("User Story (ns=t) fet$0ching")
    found = callable_at(case.snapshot, uri, case.cursor)
    chain: list[str] = []
    back: list[str] = []
    while found is not None:
        chain.append(found.symbol.name)
        back += [call.other.symbol.name for call in calls_to(case.snapshot, found)]
        calls = calls_from(case.snapshot, found)
        found = calls[0].other if calls else None
    assert chain == ["fetching", "bench-to-tray", "fetch", "carry"]
    assert back == ["fetching", "bench-to-tray", "fetch"]


def test_only_what_can_be_called_is_in_the_hierarchy() -> None:
    case, uri = at("var pa$0rt")
    assert callable_at(case.snapshot, uri, case.cursor) is None


def test_a_selection_grows_from_the_word_to_the_text() -> None:
    case, uri = at("in-tray: holds(<pa$0rt>")
    text = case.project.texts()[uri][1]
    found = [text[span.start : span.end] for span in selections(case.snapshot, uri, case.cursor)]
    assert found[:3] == ["part", "<part>", "<part> is located at <goal>"]
    assert found[-1] == text
    assert any(entry.startswith("in-tray: holds(") for entry in found)
    assert any(entry.startswith("Scenario Template") for entry in found)


def test_brackets_tell_what_to_select_in_broken_text() -> None:
    case = fixture("Scenario Template (ns=t) x { !!! ( one $0two ) }")
    text = case.project.texts()[case.uri][1]
    found = [text[span.start : span.end] for span in selections(case.snapshot, case.uri, case.cursor)]
    assert found[:3] == ["two", " one two ", "( one two )"]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_every_selection_holds_the_one_before(path: Path) -> None:
    project = Project()
    uri = path_to_uri(path)
    text = path.read_text(encoding="utf-8")
    project.open(uri, 1, text)
    for offset in range(0, len(text), 37):
        found = selections(project.snapshot(), uri, offset)
        assert found[-1] == Span(0, len(text))
        for inner, outer in pairwise(found):
            assert outer.start <= inner.start
            assert inner.end <= outer.end


def test_imports_and_model_files_are_links(tmp_path: Path) -> None:
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    (tmp_path / "arm.xml").write_text("<mujoco/>", encoding="utf-8")
    text = (
        'import "lab.scene"\nimport "gone.scene"\nns x = "http://x/"\n'
        "scene inst (ns=x) s { scene: <bench_scene> agn <arms.panda> {\n"
        'model arm as mjcf { sys path = "arm.xml" }\n} }\n'
    )
    uri = path_to_uri(tmp_path / "cell.scenex")
    project = Project()
    project.open(uri, 1, text)
    found = document_links(project.snapshot(), uri)
    assert [text[link.span.start : link.span.end] for link in found] == ["lab.scene", "arm.xml"]
    assert [link.target for link in found] == [path_to_uri(tmp_path / name) for name in ("lab.scene", "arm.xml")]
