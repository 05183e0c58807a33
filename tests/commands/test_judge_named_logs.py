"""``robbdd judge X.bddx``: the executions name their logs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from logs.drives import clauses, robbdd, verdicts
from logs.named_drive import EXECUTION, HEAD, WHERE, cell, named

pytestmark = pytest.mark.physics
FRAMES = 'frames: { "object_7" to obj <cubes.cube0> }'


def test_the_log_that_an_execution_names_is_judged(tmp_path: Path) -> None:
    path, out = cell(tmp_path, named(FRAMES), cube="object_7"), tmp_path / "out.json"
    done = robbdd(path.parent, "judge", "real.bddx", "--no-store", "--json", str(out))
    assert done.returncode == 0, done.stderr
    assert f"real: {path.with_name('drive')}" in done.stderr
    assert set(verdicts(clauses(out)).values()) <= {"holds", "unknown"}
    assert verdicts(clauses(out))["at-goal"] == "holds"
    (scenario,) = json.loads(out.read_text(encoding="utf-8"))["scenarios"]
    values = {name.rpartition("-")[2]: value for name, value in scenario["values"].items()}
    assert (values["thing"], values["goal"]) == ("env:cube0", "env:left_ws")


def test_the_names_also_apply_to_another_log_and_the_user_can_replace_them(tmp_path: Path) -> None:
    path, out = cell(tmp_path, named(FRAMES), cube="object_7"), tmp_path / "out.json"
    other = path.with_name("drive").rename(path.with_name("tuesday"))
    chosen = ("--where", "thing=cube0 and goal=left_ws", "--no-store", "--json", str(out))
    assert robbdd(path.parent, "judge", str(other), "real.bddx", *chosen).returncode == 0
    assert verdicts(clauses(out))["at-goal"] == "holds"
    robbdd(path.parent, "judge", str(other), "real.bddx", *chosen, "--frame", "cube0=bin_right")
    assert verdicts(clauses(out))["at-goal"] == "violated"


def test_an_uncertainty_in_the_model_makes_a_margin_within_it_unknown(tmp_path: Path) -> None:
    path, out = cell(tmp_path, named("uncertainty: { 10 cm }")), tmp_path / "out.json"
    robbdd(path.parent, "judge", "real.bddx", "--no-store", "--json", str(out))
    (goal,) = (one for one in clauses(out) if one["name"].endswith("at-goal"))
    assert goal["verdict"] == "unknown"
    assert "is within the uncertainty of the measurements, ±0.2 m" in goal["reason"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (named(path="sunday"), "there is no log at"),
        (HEAD + EXECUTION.replace("log: <monday>", ""), "no selected execution of real.bddx names a log"),
        (named(where=WHERE.replace("cubes.cube0", "cubes.cube1")), "no scenario fits the selection"),
        (named(where=""), "is the log of one execution, but 4 scenarios fit"),
    ],
)
def test_a_log_that_cannot_be_judged_is_refused_with_what_to_write(text: str, words: str, tmp_path: Path) -> None:
    done = robbdd(cell(tmp_path, text).parent, "judge", "real.bddx", "--no-store")
    assert done.returncode == 2
    assert words in done.stderr


def test_every_execution_with_a_log_is_judged_and_the_worst_decides(tmp_path: Path) -> None:
    second = named().partition("robot log")[2]
    text = named(FRAMES) + "robot log" + second.replace("monday", "tuesday").replace("exec) real", "exec) again")
    path = cell(tmp_path, text, cube="object_7")
    done = robbdd(path.parent, "judge", "real.bddx", "--no-store")
    assert done.returncode == 1, done.stderr
    assert [line for line in done.stderr.splitlines() if line.endswith("models/drive")] == [
        f"real: {path.with_name('drive')}",
        f"again: {path.with_name('drive')}",
    ]
    refused = robbdd(path.parent, "judge", "real.bddx", "--no-store", "--json", "out.json")
    assert (refused.returncode, "choose with --scenario, of real, again" in refused.stderr) == (2, True)
    assert robbdd(path.parent, "judge", "real.bddx", "--no-store", "--scenario", "real").returncode == 0
