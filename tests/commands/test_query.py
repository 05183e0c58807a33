"""``robbdd query`` as scripts use it."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil
from pathlib import Path

from rdflib import Graph
from rdflib.compare import isomorphic

from commands.test_graph_models import PICKPLACE, robbdd
from kit import EXAMPLES, ROOT, SCENE
from robbdd_tools.run.store import FOLDER, RunStore


def test_a_table_has_short_names() -> None:
    done = robbdd("query", PICKPLACE, "SELECT ?story ?role { ?story a bdd:UserStory ; rbw:role ?role }")
    assert (done.returncode, done.stdout) == (
        0,
        "story            role\n---------------  -------------\ncrit:tidy-bench  line operator\n",
    )


def test_csv_and_json_have_whole_names() -> None:
    ask = "SELECT ?event { ?event a time:Event }"
    rows = list(csv.reader(io.StringIO(robbdd("query", PICKPLACE, ask, "--format", "csv").stdout)))
    assert rows[0] == ["event"]
    assert rows[1] == ["https://example.org/robbdd/criteria/evt-end"]
    document = json.loads(robbdd("query", PICKPLACE, ask, "--format", "json").stdout)
    assert document["head"] == {"vars": ["event"]}
    assert document["results"]["bindings"][0] == {
        "event": {"type": "uri", "value": "https://example.org/robbdd/criteria/evt-end"}
    }


def test_queries_come_from_files_and_by_name(tmp_path: Path) -> None:
    (tmp_path / "q.rq").write_text("ASK { ?x a bdd:UserStory }", encoding="utf-8")
    assert robbdd("query", PICKPLACE, "-f", tmp_path / "q.rq").stdout == "answer\n------\ntrue\n"
    assert "env:cube1" in robbdd("query", PICKPLACE, "--name", "idle-elements").stdout


def test_a_bad_query_is_refused_with_its_place(tmp_path: Path) -> None:
    (tmp_path / "q.rq").write_text("SELECT ?x\nWHERE { ?x a nope:Thing }", encoding="utf-8")
    done = robbdd("query", PICKPLACE, "-f", "q.rq", folder=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("q.rq:2:14: error: the prefix 'nope' is not declared")


def test_without_a_query_the_ready_ones_are_listed() -> None:
    done = robbdd("query", PICKPLACE)
    assert done.returncode == 2
    assert "  idle-events " in done.stderr
    assert robbdd("query", PICKPLACE, "--name", "nope").returncode == 2
    assert robbdd("query", PICKPLACE, "ASK {}", "--name", "variants").returncode == 2


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    done = robbdd("query", PICKPLACE, "-f", tmp_path / "none.rq")
    assert (done.returncode, done.stdout) == (2, "")
    assert "there is no file 'none.rq'" in done.stderr


HEIGHTS = EXAMPLES / "tworobots" / "heights.bdd"
RESULTS = ROOT / "tests" / "graph" / "heights.results.json"


def test_results_of_a_run_are_asked_together_with_the_model() -> None:
    done = robbdd("query", HEIGHTS, "--name", "fails-only-with", "--results", RESULTS)
    assert done.returncode == 0
    assert re.search(r"^crit:at-goal +crit:var-scale +1\.1 +1$", done.stdout, re.MULTILINE)
    printed = robbdd("graph", HEIGHTS, "--results", RESULTS, "--format", "ttl").stdout
    assert "earl:outcome earl:failed" in printed


def test_without_a_file_the_newest_stored_run_counts(tmp_path: Path) -> None:
    for path in HEIGHTS.parent.iterdir():
        shutil.copy(path, tmp_path)
    model = tmp_path / HEIGHTS.name
    ask = "ASK { ?result earl:outcome earl:failed }"
    none = robbdd("query", model, ask, "--results")
    assert none.returncode == 2
    assert "there is no run 'latest'" in none.stderr
    run = RunStore(tmp_path / FOLDER).begin()
    run.write_results(json.loads(RESULTS.read_text(encoding="utf-8")))
    (tmp_path / "robbdd.toml").touch()
    assert "true" in robbdd("query", model, ask, "--results").stdout
    assert "true" in robbdd("query", model, "--results", ask).stdout


def test_what_holds_no_results_is_refused_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "r.json").write_text("[]", encoding="utf-8")
    done = robbdd("query", HEIGHTS, "ASK { }", "--results", "r.json", folder=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "robbdd: r.json contains no results of a run: the document is not an object\n"


PAPER = """import "lab.scene"
ns bdd = 'https://example.org/mine/'
Event before
Event end
Scenario Template carry {
    var part
    var place
    var robot
    Given: <part> is located at <place> before <before>
    When: <robot> picks <part> and places it at <place>
    Then: ( not <part> is located at <place> after <end> )
}
"""
ASKED = """CONSTRUCT {
  ?scenario bdd:has-clause ?fluentClause .
  ?fluentClause bdd:holds-at ?timeConstraint .
}
WHERE {
  ?scenarioTmpl bdd:of-scenario ?scenario ; bdd:has-clause ?fluentClause .
  ?fluentClause a ?fluentType ; bdd:holds-at ?timeConstraint .
}
"""


def paper(tmp_path: Path) -> Path:
    (tmp_path / "lab.scene").write_text(SCENE, encoding="utf-8")
    path = tmp_path / "paper.bdd"
    path.write_text(PAPER, encoding="utf-8")
    return path


def test_the_query_of_the_paper_has_its_rows(tmp_path: Path) -> None:
    path = paper(tmp_path)
    graph = robbdd("graph", path).stdout
    done = robbdd("query", path, ASKED, "--format", "csv")
    namespace = "https://example.org/mine/"
    bdd = "https://secorolab.github.io/metamodels/acceptance-criteria/bdd#"
    clauses = [f"{namespace}carry-given-1", f"{namespace}carry-then-1"]
    assert list(csv.reader(io.StringIO(done.stdout)))[1:] == [
        [clauses[0], f"{bdd}holds-at", clauses[0]],
        [f"{namespace}carry-scenario", f"{bdd}has-clause", clauses[0]],
        [f"{namespace}carry-scenario", f"{bdd}has-clause", clauses[1]],
        [clauses[1], f"{bdd}holds-at", clauses[1]],
    ]
    assert f"'bdd:' means the vocabulary's <{bdd}>; this model's <{namespace}> is 'bdd-2:'" in done.stderr
    assert "holds-at" not in graph
    assert robbdd("graph", path).stdout == graph


def test_what_a_query_constructs_is_saved_as_a_graph(tmp_path: Path) -> None:
    path = paper(tmp_path)
    turtle = robbdd("query", path, ASKED, "--format", "ttl").stdout
    made = Graph().parse(data=turtle, format="turtle")
    assert len(made) == 4
    json_ld = robbdd("query", path, ASKED, "--format", "json-ld").stdout
    assert isomorphic(Graph().parse(data=json_ld, format="json-ld"), made)
    refused = robbdd("query", path, "ASK { ?x a time:Event }", "--format", "ttl")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "--format ttl is for CONSTRUCT and DESCRIBE" in refused.stderr


def test_a_prefix_of_the_model_keeps_its_meaning_for_terms_of_the_model(tmp_path: Path) -> None:
    done = robbdd("query", paper(tmp_path), "ASK { bdd:end a time:Event }")
    assert (done.stdout, done.stderr) == ("answer\n------\ntrue\n", "")


def test_a_term_that_no_triple_has_is_reported_with_the_nearest() -> None:
    done = robbdd("query", PICKPLACE, "SELECT ?x {\n?x a/bdd:of-templat crit:pick-plac\n}")
    assert done.stdout == "x\n-\n"
    assert done.stderr.splitlines() == [
        "query: note: line 2: 'bdd:of-templat' occurs in no triple; did you mean 'bdd:of-template'?",
        "query: note: line 2: 'crit:pick-plac' occurs in no triple; did you mean 'crit:pick-place'?",
    ]
