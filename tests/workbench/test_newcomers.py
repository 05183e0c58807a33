"""Models that were written from the published language and the paper alone, in a newcomer's names and forms.

Each has its own traits: words inside names, events in several styles, nested conditions (``kitchen``); ``for all`` and
sets of places (``ewaste``); several arms and namespaces, and faults (``handover``); several stories (``stories``); the
paper's form with an event between the behaviour's ends (``printed``) and its criteria (``criteria``); JSON-LD in three
files as it is published.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from rdflib import Graph
from rdflib.compare import isomorphic

import robbdd_tools as robbdd
from robbdd_tools.cli import main
from robbdd_tools.graph.rdf.serialize import parse
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.plan import Plan, Selection
from workbench.test_known_before import assert_known, covering, unknown

MODELS = sorted(Path(__file__).with_name("newcomers").glob("*.bdd"))
PUBLISHED = ("story.json", "templates.json", "environment.json")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return shutil.copytree(MODELS[0].parent, tmp_path / "newcomers")


def verdicts(model: robbdd.Model) -> set[str]:
    with Plan.of(model, Selection(choices=[covering(model)])).run(seed=1, keeping=Keeping(keep=False)) as run:
        return {clause.verdict for result in run for clause in result.clauses}


@pytest.mark.physics
@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_each_unknown_is_known_before_the_run(path: Path, folder: Path) -> None:
    assert_known(unknown(folder / path.name))


@pytest.mark.physics
def test_the_printed_form_and_the_published_graph_hold(folder: Path) -> None:
    assert verdicts(robbdd.load(folder / "printed.bdd")) == {"holds"}
    published = robbdd.load(*(folder / name for name in PUBLISHED))
    assert published.diagnostics == ()
    assert verdicts(published) == {"holds"}


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_the_graph_of_a_model_becomes_text_with_the_same_graph(path: Path, folder: Path) -> None:
    graph = robbdd.load(folder / path.name).graph()
    (folder / "graph.ttl").write_text(graph, encoding="utf-8")
    assert main(["import", str(folder / "graph.ttl"), "-o", str(folder / "imported.bdd")]) == 0
    again = robbdd.load(folder / "imported.bdd").graph()
    assert isomorphic(without_positions(graph), without_positions(again))


def without_positions(text: str) -> Graph:
    graph = parse(text, "ttl")
    graph.remove((None, next(term for term in graph.predicates() if str(term).endswith("#position")), None))
    return graph


def test_the_warnings_of_a_model_say_what_is_wrong_where(folder: Path) -> None:
    every = robbdd.load(folder / "handover.bdd").diagnostics
    warnings = [one for one in every if one.severity < robbdd.Severity.INFORMATION]
    found = {(one.place.file.rpartition("/")[2], one.place.line, one.code) for one in warnings}
    assert found == {
        ("handover.bdd", 27, "no-evaluator"),
        ("handover.bdd", 38, "setting"),
        ("handover.bdd", 41, "no-region"),
        ("handover.bdd", 51, "setting"),
        ("cell.scene", 3, "no-model"),
    }


@pytest.mark.physics
def test_the_criteria_of_the_paper_are_judged_and_the_text_among_them_is_known_before(folder: Path) -> None:
    model = robbdd.load(folder / "criteria.bdd")
    warned = [one for one in model.diagnostics if one.severity < robbdd.Severity.INFORMATION]
    assert {one.code for one in warned} == {"no-correct-place"}
    assert ("catalog-phrase", 55) in {(one.code, one.place.line) for one in model.diagnostics}
    with Plan.of(model, Selection()).run(seed=1, keeping=Keeping(keep=False)) as run:
        picked, _, placed, _ = ([clause.verdict for clause in result.clauses] for result in run.results)
    assert picked == ["holds"] * 4
    assert placed == [*["holds"] * 4, "unknown"]


@pytest.mark.physics
@pytest.mark.parametrize("correct", ["ws-bin1", "ws-bin2"])
def test_the_criterion_of_the_correct_container_is_judged(correct: str, folder: Path) -> None:
    path, scene = folder / "criteria.bdd", folder / "criteria.scene"
    text = path.read_text(encoding="utf-8")
    free = 'pred("{container} is correct for {obj}", container=<container>, obj=<target-obj>)'
    assert free in text
    path.write_text(text.replace(free, "<container> is correct for <target-obj>"), encoding="utf-8")
    elements = scene.read_text(encoding="utf-8")
    stated = f"workspace {correct} {{ correct for: obj set <lab_objects> }}"
    assert f"workspace {correct}" in elements
    scene.write_text(elements.replace(f"workspace {correct}", stated), encoding="utf-8")
    model = robbdd.load(path)
    assert [one for one in model.diagnostics if one.severity < robbdd.Severity.INFORMATION] == []
    with Plan.of(model, Selection()).run(seed=1, keeping=Keeping(keep=False)) as run:
        _, _, *placed = ([clause.verdict for clause in result.clauses] for result in run.results)
    verdict = "holds" if correct == "ws-bin1" else "violated"
    assert placed == [[*["holds"] * 4, verdict]] * 2


PLACED = """import "cell.scene"
ns sim = 'https://example.org/sim/'
scene inst (ns=sim) placed {
    scene: <cell>
    kgraph (ns=sim) poses {
        body room { frame origin { } }
        body foot {
            frame base { pose p { wrt: <room.origin> xyz: (3, 2, 0) m orientation: quat { xyzw: (0, 0, 0, 1) } } }
        }
    }
    agn <arms.spare_ur10> { model spare as mjcf { catalog "ur10" map body <poses.foot> to "base" } }
}
"""


@pytest.mark.physics
@pytest.mark.parametrize("placed", [False, True])
def test_a_bystander_is_left_out_and_named_once_unless_a_scenex_places_it(
    placed: bool, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "placed.scenex").write_text(PLACED, encoding="utf-8")
    scenex = ["--scenex", str(folder / "placed.scenex")] if placed else []
    where = ["--where", "what = 'blueCube' and dest = 'left_zone'"]
    main(["run", str(folder / "handover.bdd"), "--no-store", *where, *scenex])
    captured = capsys.readouterr()
    (note,) = [
        line for line in (captured.out + captured.err).splitlines() if "not simulated" in line and "panda" not in line
    ]
    assert "a:coffee_machine" in note
    assert ("b:spare_ur10" in note) is not placed


@pytest.mark.physics
def test_an_object_whose_name_says_nothing_more_is_simulated_and_named_once(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = folder / "cell.scene"
    scene.write_text(scene.read_text(encoding="utf-8").replace("blueCube", "blue_item"), encoding="utf-8")
    model = folder / "handover.bdd"
    model.write_text(model.read_text(encoding="utf-8").replace("blueCube", "blue_item"), encoding="utf-8")
    main(["run", str(model), "--no-store", "--where", "what = 'blue_item' and dest = 'left_zone'", "--repeat", "2"])
    said = capsys.readouterr()
    notes = [line for line in (said.out + said.err).splitlines() if "say nothing more" in line]
    assert notes == ["warning: simulated as 'part' of the catalog, as their names say nothing more: a:blue_item"]
    assert "there is no model" not in said.out
