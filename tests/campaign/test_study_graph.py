"""The graph of a study: what it plans, and what its executions had as results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from rdflib import Graph
from rdflib.compare import isomorphic

from campaign.study_agents import QuickAgent, write_study
from kit import EXAMPLES
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.document import Document
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_graph import study_graph
from robbdd_tools.cli import main
from robbdd_tools.graph.rdf.serialize import parse, serialize
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.foreign import read_graph_file
from robbdd_tools.run import scheduler

EVERY_SETTING = """import "MODEL.bddx"
Study all {
    where: "robot=panda"
    repeat: 3
    seed: 7
    batch: 40
    timeout: 90 seconds
    stop: rate 0.95 against 0.9
    block: repetition
    traces: failures 20 MB
    cover: { pairs 90 %, events 100 % }
    factor bhv <tested>: { <tested>, pick-place }
}
"""
SCENES = 'import "MODEL.bdd" Study scenes { factor scene: { "bench.scenex" } }'


@pytest.fixture(scope="module")
def ranges() -> Graph:
    return study_graph(load_study(EXAMPLES / "study" / "ranges.study")).graph


@pytest.fixture
def every_setting(tmp_path: Path) -> Graph:
    return graph_of(tmp_path, EVERY_SETTING)


def graph_of(folder: Path, text: str) -> Graph:
    path, here = folder / "x.study", (EXAMPLES / "study").as_posix()
    path.write_text(text.replace("MODEL", f"{here}/study").replace("bench.", f"{here}/bench."), encoding="utf-8")
    study = load_study(path)
    assert [str(one) for one in study.findings if one.is_error] == []
    return study_graph(study).graph


def rows(graph: Graph, query: str) -> list[tuple[str, ...]]:
    prefixes = "PREFIX rbw: <https://robbdd.org/metamodels/workbench#> PREFIX prov: <http://www.w3.org/ns/prov#> "
    prefixes += "PREFIX bdd: <https://secorolab.github.io/metamodels/acceptance-criteria/bdd#> "
    prefixes += "PREFIX earl: <http://www.w3.org/ns/earl#> PREFIX rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> "
    found: Any = graph.query(prefixes + query)
    return sorted(tuple(str(term).rpartition("/")[2].rpartition("#")[2] for term in row) for row in found)


def test_ranges_are_factors_with_their_variables_bounds_and_design(ranges: Graph) -> None:
    query = """SELECT ?variable ?low ?high ?unit {
        ?study a rbw:Study, prov:Plan ; rbw:factor-list/rdf:rest*/rdf:first ?one .
        ?one a rbw:RangeFactor ; rbw:of-variable ?variable ; rbw:from-value ?low ; rbw:to-value ?high .
        OPTIONAL { ?one rbw:unit ?unit } }"""
    expected = [
        ("var-friction", "0.2", "0.6", "None"),
        ("var-speed", "0.2", "0.7", "s"),
        ("var-travel", "0.28", "0.32", "m"),
    ]
    assert rows(ranges, query) == expected
    design = (
        "SELECT ?size ?scenario { ?study rbw:design [ a rbw:LatinHypercube ; rbw:design-size ?size ] ; rbw:seed 1 ; "
    )
    assert rows(ranges, design + "rbw:of-variant ?scenario . ?scenario a bdd:ScenarioVariant }") == [("64", "of-panda")]


def test_factors_have_their_levels_in_written_order(every_setting: Graph, tmp_path: Path) -> None:
    query = "SELECT ?level { ?one a rbw:SceneFactor ; rbw:level-list/rdf:rest*/rdf:first ?level }"
    assert rows(graph_of(tmp_path, SCENES), query) == [("bench.scenex",)]
    ordered = """SELECT ?first ?second { ?one a rbw:BehaviourFactor ; rbw:replaces ?tested ; rbw:level-list ?list .
        ?list rdf:first ?first ; rdf:rest/rdf:first ?second . ?tested a bdd:BehaviourImplementation }"""
    assert rows(every_setting, ordered) == [("tested", "pick-place")]


def test_a_required_rate_repetitions_blocks_and_traces_are_stated(every_setting: Graph) -> None:
    query = """SELECT ?repeat ?seed ?batch ?time ?block ?traces ?limit ?rate ?refuted {
        ?study a rbw:Study ; rbw:seed ?seed ;
        rbw:repetitions ?repeat ; rbw:batch-size ?batch ; rbw:timeout-seconds ?time ; rbw:block ?block ;
        rbw:kept-traces ?traces ; rbw:trace-limit-megabytes ?limit ; rbw:selection "robot=panda" ;
        rbw:stopping-rule [ a rbw:RateRule ; rbw:required-rate ?rate ; rbw:refuted-rate ?refuted ] }"""
    wanted = ("3", "7", "40", "90.0", "repetition", "failures", "20", "0.95", "0.9")
    assert rows(every_setting, query) == [wanted]
    goals = "SELECT ?kind ?share { ?study rbw:coverage-goal [ rbw:coverage-kind ?kind ; rbw:percentage ?share ] }"
    assert rows(every_setting, goals) == [("events", "100.0"), ("pairs", "90.0")]


def test_a_study_in_json_ld_or_turtle_is_read_as_the_same_sound_graph(every_setting: Graph, ranges: Graph) -> None:
    for graph in (every_setting, ranges):
        for format, name in (("json-ld", "x.jsonld"), ("ttl", "x.ttl")):
            text = serialize(graph, format)
            assert isomorphic(parse(text, format), graph)
            assert serialize(parse(text, format), format) == text
            found = validate(read_graph_file(Document(f"file:///{name}", 1, text)))
            assert [one.message for one in found if one.severity is Severity.ERROR] == []
        assert '"repetitions": 3' in serialize(every_setting, "json-ld")


def test_the_results_of_a_study_are_a_run_that_used_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(scheduler, "Agent", QuickAgent)
    monkeypatch.chdir(tmp_path)
    write_study(tmp_path)
    assert main(["graph", "x.study", "--results"]) == 2
    assert "the study has no results" in capsys.readouterr().err
    assert main(["study", "run", "x.study"]) == 1
    capsys.readouterr()
    assert main(["graph", "x.study", "--results", "--format", "nt"]) == 0
    graph = Graph().parse(data=capsys.readouterr().out, format="nt")
    used = """SELECT (COUNT(?one) AS ?n) { ?one a rbw:ScenarioRun ;
        rbw:run [ a rbw:Run ; rbw:complete true ; prov:used ?s ] . ?s a rbw:Study }"""
    assert rows(graph, used) == [("40",)]
    failed = """SELECT ?clause (COUNT(?one) AS ?n) { ?one earl:test ?clause ; earl:result/earl:outcome earl:failed .
        ?clause a bdd:FluentClause } GROUP BY ?clause"""
    assert rows(graph, failed) == [("in-tray", "5"), ("on-bench", "5")]
    assert main(["query", "x.study", "SELECT ?n { ?s a rbw:Study ; rbw:name ?n }", "--format", "csv"]) == 0
    assert capsys.readouterr().out.splitlines() == ["n", "fetching"]
    assert main(["graph", "x.study", "--results", "3"]) == 2
    assert main(["graph", "x.study", "--format", "svg"]) == 2
    assert "has no picture" in capsys.readouterr().err
