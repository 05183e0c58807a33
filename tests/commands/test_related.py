"""Related scenarios: stories linked to nodes of one behaviour tree are judged from one execution of it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES, schema_errors
from robbdd_tools.agent import shared_executions
from robbdd_tools.agent.behaviour_run import BehaviourRun
from robbdd_tools.agent.channel import Channel
from robbdd_tools.agent.session import Session
from robbdd_tools.monitor.verdict import Verdict
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.workbench.model import load

pytestmark = pytest.mark.physics
LOST = "precondition not reached: pick failed: gripper lost env:cube0 at "


def robbdd(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [*ROBBDD, *arguments]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=folder, env=dict(os.environ))
    assert "Traceback" not in done.stderr
    return done


def model(folder: Path, weight: float | None = None) -> Path:
    """Write the example for its cube alone, which weighs so many kg where something is said."""
    shutil.copy(EXAMPLES / "relatedstories" / "bench.scene", folder)
    text = (EXAMPLES / "relatedstories" / "stories.bdd").read_text(encoding="utf-8")
    text = text.replace("{ <cubes.cube0>, <balls.ball0> }", "{ <cubes.cube0> }")
    if weight is not None:
        at_source = "at-source: holds(<thing> is located at <source>, before <evt-pick-start>)"
        heavy = "heavy: holds(<thing> has config mass = <weight>, before <evt-pick-start>)"
        goal = "var <picking.source>: { <places.table_ws> }"
        for old, new in (
            ("    var source\n\n", "    var source\n    var weight\n\n"),
            (at_source, f"( {at_source} and {heavy} )"),
            (goal, f"{goal}\n                var <picking.weight>: {{ {weight} }}"),
        ):
            assert old in text
            text = text.replace(old, new, 1)
    path = folder / "m.bdd"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_summary_counts_an_execution_once(tmp_path: Path) -> None:
    model(tmp_path)
    last = robbdd(tmp_path, "run", "m.bdd").stdout.splitlines()[-1]
    assert last.startswith("3 scenarios: 3 hold, 0 violated, 0 unknown")
    assert "judged from 1 execution" in last
    simulated = float(last.partition("; ")[2].partition(" s simulated")[0])
    assert simulated < 15


def run(folder: Path, *arguments: str) -> list[dict[str, Any]]:
    robbdd(folder, "run", "m.bdd", "--json", "out.json", *arguments)
    document = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    assert schema_errors("run.schema.json", document) == []
    return document["scenarios"]


def verdicts(scenarios: list[dict[str, Any]]) -> dict[str, list[str]]:
    return {
        scenario["name"].split(":")[1].split(" ")[0]: [clause["verdict"] for clause in scenario["clauses"]]
        for scenario in scenarios
    }


def prepared(path: Path, folder: Path) -> Manifest:
    return load(path).scenarios(seed=1).prepare(folder)


def judged(folder: Path, manifest: Manifest, order: list[int]) -> dict[str, Verdict]:
    """Go through scenarios as behave does, in one process."""
    session = Session(folder, manifest, Channel())
    found: dict[str, Verdict] = {}
    for index in order:
        spec = manifest.scenarios[index]
        texts = [(clause.line, clause.role, clause.sentence) for clause in spec.clauses]
        session.start(folder / spec.feature, spec.line, texts)
        for line, role, sentence in texts:
            judge = session.scenario.behaviour if role == "when" else session.scenario.clause
            found[f"{spec.name} {line}"] = judge(line, sentence)
        session.finish()
    return found


def test_three_stories_are_judged_from_one_simulation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    manifest = prepared(model(tmp_path), tmp_path / "run")
    courses: list[BehaviourRun] = []

    def counted(*arguments: Any) -> BehaviourRun:
        courses.append(BehaviourRun(*arguments))
        return courses[-1]

    monkeypatch.setattr(shared_executions, "BehaviourRun", counted)
    one = judged(tmp_path / "run", manifest, [0, 1, 2])
    assert len(manifest.scenarios) == 3
    assert len(courses) == 1
    assert {verdict.outcome for verdict in one.values()} == {"holds"}
    apart = {name: entry for index in (2, 0, 1) for name, entry in judged(tmp_path / "run", manifest, [index]).items()}
    assert len(courses) == 4
    assert apart == one


def test_a_failed_pick_leaves_the_place_story_unknown(tmp_path: Path) -> None:
    model(tmp_path, weight=10)
    scenarios = run(tmp_path, "--junit", "out.xml", "--jobs", "2")
    assert verdicts(scenarios) == {
        "part-taken": ["holds", "holds", "violated", "unknown"],
        "part-put": ["unknown"] * 4,
        "bench-tidied": ["holds", "violated", "unknown"],
    }
    put = next(scenario for scenario in scenarios if "part-put" in scenario["name"])
    assert put["verdict"] == "unknown"
    assert all(clause["reason"].startswith(LOST) for clause in put["clauses"])
    assert len({scenario["shared"]["execution"] for scenario in scenarios}) == 1
    assert len({scenario["seed"] for scenario in scenarios}) == 1
    cases = {case.get("classname"): case for case in ElementTree.parse(tmp_path / "out.xml").iter("testcase")}
    error = cases["part-put"].find("error")
    assert error is not None
    assert LOST.replace("env:", "") in (error.get("message") or "")
    # A single story runs the tree as far as it needs, with the same result.
    assert run(tmp_path, "--scenario", "part-put") == [put]
    (taken,) = run(tmp_path, "--scenario", "part-taken")
    assert verdicts([taken])["part-taken"] == ["holds", "holds", "violated", "unknown"]
    assert taken["seed"] == put["seed"]


def test_plain_behave_gives_the_same_verdicts(tmp_path: Path) -> None:
    for weight in (None, 10):
        folder = tmp_path / str(weight)
        folder.mkdir()
        model(folder, weight)
        scenarios = run(folder)
        assert robbdd(folder, "gherkin", "m.bdd", "-o", "out").returncode == 0
        told = said_by_behave(folder / "out")
        expected = {clause["sentence"]: clause["verdict"] for scenario in scenarios for clause in scenario["clauses"]}
        assert {sentence: verdict for sentence, (verdict, _) in told.items()} == expected
        if weight is not None:
            unreached = [reason for _, reason in told.values() if LOST in reason]
            assert len(unreached) == 4


def said_by_behave(out: Path) -> dict[str, tuple[str, str]]:
    """Plain behave's result for each clause: its verdict and the failure text."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith("BEHAVE")}
    command = [sys.executable, "-m", "behave", "--format", "json", "--outfile", str(out / "report.json")]
    subprocess.run([*command, str(out / "features")], capture_output=True, env=environment)
    found: dict[str, tuple[str, str]] = {}
    for feature in json.loads((out / "report.json").read_text(encoding="utf-8")):
        for element in feature["elements"]:
            for step in element["steps"] if element["type"] == "scenario" else ():
                if '"' in step["name"]:
                    words = str(step["result"].get("error_message", ""))
                    failed = "unknown" if "unknown: " in words else "violated"
                    found[step["name"]] = ("holds" if step["result"]["status"] == "passed" else failed, words)
    return found


def test_replay_and_judge_know_the_shared_execution(tmp_path: Path) -> None:
    model(tmp_path, weight=10)
    first = run(tmp_path)
    again = robbdd(tmp_path, "replay", "latest")
    assert again.stdout.splitlines()[-1] == "3 of 3 traces are the same", again.stdout + again.stderr
    robbdd(tmp_path, "judge", "latest", "m.bdd", "--json", "judged.json")
    document = json.loads((tmp_path / "judged.json").read_text(encoding="utf-8"))
    assert verdicts(document["scenarios"]) == verdicts(first)
    put = next(scenario for scenario in document["scenarios"] if "part-put" in scenario["name"])
    assert all(clause["reason"].startswith(LOST) for clause in put["clauses"])
    text = (tmp_path / "m.bdd").read_text(encoding="utf-8")
    (tmp_path / "m.bdd").write_text(text.replace("        node place\n", "        node place\n        node pick2\n"))
    robbdd(tmp_path, "judge", "latest", "m.bdd", "--json", "judged.json")
    document = json.loads((tmp_path / "judged.json").read_text(encoding="utf-8"))
    reasons = {clause["reason"] for scenario in document["scenarios"] for clause in scenario["clauses"]}
    assert reasons == {"the behaviour tree changed since the run: execute a new run"}


def test_results_tell_in_the_graph_what_was_judged_from_one_execution(tmp_path: Path) -> None:
    model(tmp_path, weight=10)
    run(tmp_path)
    query = """SELECT (COUNT(DISTINCT ?execution) AS ?executions) (COUNT(DISTINCT ?scenario) AS ?scenarios) WHERE {
        ?scenario rbw:judged-from ?execution ; prov:wasInformedBy ?execution ; rbw:of-node ?node .
        ?execution a prov:Activity ; rbw:of-tree ?tree .
        ?tree bt:root ?root . ?node rbw:node-of ?tree .
        ?behaviour rbw:coordination-node ?node .
    }"""
    done = robbdd(tmp_path, "query", "m.bdd", query, "--results", "out.json")
    assert done.stdout.split()[-2:] == ["1", "3"], done.stdout + done.stderr


REPEATED = """import py_trees

def create(leaf):
    both = py_trees.composites.Sequence("pick-place", True, [leaf("pick"), leaf("place")])
    return py_trees.decorators.Repeat("again", both, 2)
"""


def test_clauses_on_a_repeated_node_mean_its_first_and_last_execution_for_run_replay_and_judge(tmp_path: Path) -> None:
    path = model(tmp_path)
    text = path.read_text(encoding="utf-8")
    begin, end = text.index("Behaviour Tree"), text.index("const set")
    source = "py { module: trees, attr: create }"
    tree = f"Behaviour Tree (ns=crit) handling {{ {source} node pick-place node pick node place }}\n"
    path.write_text(text[:begin] + tree + text[end:], encoding="utf-8")
    (tmp_path / "trees.py").write_text(REPEATED, encoding="utf-8")
    scenarios = run(tmp_path)
    assert {verdict for found in verdicts(scenarios).values() for verdict in found} == {"holds"}
    instants = {clause["name"]: clause["worst_at"] for scenario in scenarios for clause in scenario["clauses"]}
    middle = scenarios[-1]["duration"] / 2
    assert all(instants[name] < middle for name in ("at-source", "still-in-hand", "on-bench"))
    assert all(instants[name] > middle for name in ("in-hand", "in-bin"))
    assert robbdd(tmp_path, "replay", "latest").stdout.endswith("3 of 3 traces are the same\n")
    robbdd(tmp_path, "judge", "latest", "m.bdd", "--json", "judged.json")
    judged_again = json.loads((tmp_path / "judged.json").read_text(encoding="utf-8"))["scenarios"]
    assert [one["clauses"] for one in judged_again] == [one["clauses"] for one in scenarios]
    alone = run(tmp_path, "--scenario", "part-taken")
    assert alone[0]["clauses"] == scenarios[0]["clauses"]
