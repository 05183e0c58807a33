"""``robbdd run`` of executions: whose arm, whose code, which seed."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main
from robbdd_tools.commands import FAILED, FINDINGS, OK

pytestmark = pytest.mark.physics


def run(model: Path, *arguments: str) -> tuple[int, list[dict[str, Any]]]:
    report = model.parent / "report.json"
    code = main(["run", str(model), "--json", str(report), *arguments])
    return code, json.loads(report.read_text(encoding="utf-8"))["scenarios"] if report.is_file() else []


def example(folder: Path, name: str) -> Path:
    return Path(shutil.copytree(EXAMPLES / name, folder / name))


def test_an_arm_and_a_behaviour_of_ones_own_do_what_the_catalogs_do(tmp_path: Path) -> None:
    code, scenarios = run(example(tmp_path, "ownrobot") / "tidy.bddx")
    assert code == OK
    assert [scenario["verdict"] for scenario in scenarios] == ["holds"] * 4


def test_the_executable_scene_of_the_first_example_runs(tmp_path: Path) -> None:
    code, scenarios = run(example(tmp_path, "pickplace") / "pickplace.bddx", "--first", "1")
    assert (code, len(scenarios)) == (OK, 1)


def test_an_execution_is_chosen_by_its_name(tmp_path: Path) -> None:
    model = example(tmp_path, "ownrobot") / "tidy.bddx"
    assert len(run(model, "--scenario", "by-catalog", "--first", "1")[1]) == 1
    assert main(["run", str(model), "--scenario", "by-nobody"]) == FAILED


def test_a_mistake_in_users_code_leaves_its_clauses_unknown_and_the_others_judged(tmp_path: Path) -> None:
    folder = example(tmp_path, "ownrobot")
    text = (folder / "carrying.py").read_text(encoding="utf-8")
    line = text[: text.index('world.emit("pick-end")')].count("\n") + 1
    (folder / "carrying.py").write_text(text.replace('world.emit("pick-end")', "world.emits()"), encoding="utf-8")
    code, scenarios = run(folder / "tidy.bddx")
    assert code == FINDINGS
    assert [scenario["verdict"] for scenario in scenarios] == ["holds", "holds", "unknown", "unknown"]
    told = {clause["name"]: clause for clause in scenarios[2]["clauses"]}
    assert told["at-source"]["verdict"] == "holds"
    assert told["at-goal"]["verdict"] == "unknown"
    assert f"carrying.py:{line})" in told["at-goal"]["reason"]


def test_a_missing_model_file_is_the_reason_of_the_scenario(tmp_path: Path) -> None:
    folder = example(tmp_path, "ownrobot")
    (folder / "five.xml").unlink()
    code, scenarios = run(folder / "tidy.bddx", "--scenario", "by-catalog", "--first", "1")
    assert code == FINDINGS
    assert all("cell.scenex:67:15: there is no model file" in clause["reason"] for clause in scenarios[0]["clauses"])


def test_the_timeout_of_an_execution_bounds_its_simulated_time(tmp_path: Path) -> None:
    model = example(tmp_path, "ownrobot") / "tidy.bddx"
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace("seed: 1", "seed: 1 timeout: 2 seconds", 1), encoding="utf-8")
    code, scenarios = run(model, "--first", "1")
    assert code == FINDINGS
    bounded, other = scenarios
    told = {clause["name"]: clause for clause in bounded["clauses"]}
    assert told["at-source"]["verdict"] == "holds"
    assert told["at-goal"]["verdict"] == bounded["verdict"] == "unknown"
    assert "the execution was stopped after 2 s of simulated time" in told["at-goal"]["reason"]
    assert other["verdict"] == "holds"


def test_the_last_line_names_the_seeds_that_executions_state(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = example(tmp_path, "ownrobot") / "tidy.bddx"
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace("seed: 1", "seed: 77"), encoding="utf-8")
    run(model, "--first", "1")
    assert "(seed 77;" in capsys.readouterr().out
    run(model, "--first", "1", "--seed", "5")
    assert "(seed 5;" in capsys.readouterr().out
