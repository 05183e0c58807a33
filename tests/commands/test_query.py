"""``robbdd query`` as scripts use it."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil
from pathlib import Path

from commands.test_graph_models import PICKPLACE, robbdd
from kit import EXAMPLES, ROOT
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
    assert done.stderr == "robbdd: r.json holds no results of a run: the document is not an object\n"
