"""``robbdd run``: selection, repetitions, stored runs, reports."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES, schema_errors
from robbdd_tools.commands import FAILED

pytestmark = pytest.mark.physics


def robbdd(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([*ROBBDD, *arguments], capture_output=True, encoding="utf-8", cwd=folder)
    assert "Traceback" not in done.stderr
    return done


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a model of two scenarios, of which the second fails: its bin is not the judged one."""
    text = (EXAMPLES / "pickplace" / "pickplace.bdd").read_text(encoding="utf-8")
    text = text.replace("<goal>, after <evt-place-end>", "<judged>, after <evt-place-end>")
    text = text.replace("var goal", "var goal\n    var judged")
    text = text.replace(
        "var <pick-place.goal>", "var <pick-place.judged>: { <places.left_ws> }\n    var <pick-place.goal>"
    )
    text = text.replace("<cubes.cube0>, <balls.ball0>", "<cubes.cube0>")
    (tmp_path / "pickplace.bdd").write_text(text, encoding="utf-8")
    shutil.copy(EXAMPLES / "pickplace" / "bench.scene", tmp_path)
    return tmp_path


def results(path: Path) -> dict[str, Any]:
    document = json.loads(path.read_text(encoding="utf-8"))
    assert schema_errors("run.schema.json", document) == []
    return document


def seeds(document: dict[str, Any]) -> dict[tuple[int, int], int]:
    return {(entry["variation"], entry["repetition"]): entry["seed"] for entry in document["scenarios"]}


def test_a_run_is_kept_and_its_failures_are_run_again(folder: Path) -> None:
    assert robbdd(folder, "run", "pickplace.bdd", "--rerun-failed").returncode == 2
    first = robbdd(folder, "run", "pickplace.bdd", "--seed", "5", "--repeat", "2", "--junit", "junit.xml")
    assert first.returncode == 1
    assert "kept as run 1" in first.stderr
    stored = results(folder / ".robbdd" / "runs" / "1" / "results.json")
    assert [entry["verdict"] for entry in stored["scenarios"]] == ["holds", "holds", "violated", "violated"]
    assert [entry["name"] for entry in stored["scenarios"]][:2] == [
        "crit:part-to-bin -- 1 (repetition 1)",
        "crit:part-to-bin -- 1 (repetition 2)",
    ]
    assert len(set(seeds(stored).values())) == 4
    suite = ElementTree.parse(folder / "junit.xml").getroot()[0]
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("4", "2", "0")

    again = robbdd(folder, "run", "pickplace.bdd", "--rerun-failed", "--jobs", "1", "--json", "again.json")
    assert again.returncode == 1
    repeated = results(folder / "again.json")
    assert repeated["scenarios"] == stored["scenarios"][2:]

    listed = robbdd(folder, "runs")
    assert listed.stdout.splitlines() == [
        "   1  pickplace.bdd  2 hold, 2 violated, 0 unknown  (seed 5)",
        "   2  pickplace.bdd  0 hold, 2 violated, 0 unknown  (seed 5)",
    ]


def test_clauses_that_policies_judge_are_named(tmp_path: Path) -> None:
    shutil.copytree(EXAMPLES / "pickplace", tmp_path, dirs_exist_ok=True)
    by_policy = robbdd(
        tmp_path, "run", "pickplace.bddx", "--no-store", "--where", "thing=cube0 and goal=left_ws"
    ).stdout
    assert "\nat-goal is judged by the policy near-goal, not by its predicate\n" in by_policy
    plain = robbdd(tmp_path, "run", "pickplace.bdd", "--no-store", "--where", "thing=cube0 and goal=left_ws").stdout
    assert "policy" not in plain


def test_folders_with_runs_are_named_if_there_are_several(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name / ".robbdd" / "runs").mkdir(parents=True)
    done = robbdd(tmp_path, "runs")
    assert done.returncode == FAILED
    assert done.stderr.endswith("but in several folders: one, two; name one of them\n")


def test_a_scenario_has_its_seed_whatever_else_is_selected(folder: Path) -> None:
    robbdd(folder, "run", "pickplace.bdd", "--no-store", "--where", "goal=right_ws", "--json", "one.json")
    robbdd(folder, "run", "pickplace.bdd", "--no-store", "--repeat", "2", "--first", "2", "--json", "all.json")
    alone, among = seeds(results(folder / "one.json")), seeds(results(folder / "all.json"))
    assert alone == {(2, 1): among[2, 1]}
    assert not (folder / ".robbdd").exists()


def test_a_folder_of_models_is_run_at_once_each_scenario_once(folder: Path) -> None:
    inner = folder / "inner"
    inner.mkdir()
    other = (folder / "pickplace.bdd").read_text(encoding="utf-8").replace("robbdd/criteria/", "robbdd/other/")
    (inner / "other.bdd").write_text(other.replace("bench.scene", "../bench.scene"), encoding="utf-8")
    (folder / "same.bdd").write_text('import "pickplace.bdd"\n', encoding="utf-8")
    done = robbdd(folder, "run", ".", "--where", "goal=left_ws", "--json", "out.json")
    assert done.returncode == 0, done.stdout + done.stderr
    document = results(folder / "out.json")
    assert [entry["model"] for entry in document["scenarios"]] == ["inner/other.bdd", "pickplace.bdd"]


def test_a_store_that_cannot_be_written_is_remarked(folder: Path) -> None:
    (folder / ".robbdd").write_text("in the way")
    done = robbdd(folder, "run", "pickplace.bdd", "--first", "1")
    assert done.returncode == 0
    assert "this run is not kept" in done.stderr
