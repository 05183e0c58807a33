"""The example with observation policies, in physics and on its stored traces."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

pytestmark = pytest.mark.physics


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = shutil.copytree(EXAMPLES / "pickplace", tmp_path / "pickplace")
    monkeypatch.chdir(folder)
    return folder


def judgements(path: Path) -> list[tuple[str, str, float | None]]:
    document: Any = json.loads(path.read_text(encoding="utf-8"))
    return [
        (clause["name"], clause["verdict"], clause["robustness"])
        for scenario in document["scenarios"]
        for clause in scenario["clauses"]
    ]


def test_policies_judge_their_clauses_the_same_in_physics_and_on_stored_traces(project: Path) -> None:
    assert main(["run", "pickplace.bddx", "--where", "thing = cube0", "--json", "run.json"]) == 0
    found = judgements(project / "run.json")
    assert {verdict for _, verdict, _ in found} == {"holds"}
    # The built-in evaluator would return the distance to a wall of the bin, which is less.
    assert all(margin is not None and margin > 0.1 for name, _, margin in found if name in ("at-source", "at-goal"))
    assert main(["judge", "latest", "pickplace.bddx", "--json", "judge.json"]) == 0
    assert judgements(project / "judge.json") == found


def test_a_policy_that_asks_for_more_is_violated(project: Path) -> None:
    path = project / "pickplace.bddx"
    text = path.read_text(encoding="utf-8")
    assert "less-than: 0.2 m" in text
    path.write_text(text.replace("less-than: 0.2 m", "less-than: 0.001 m"), encoding="utf-8")
    assert main(["run", "pickplace.bddx", "--where", "thing = cube0", "--first", "1", "--json", "run.json"]) == 1
    violated = [(name, margin) for name, verdict, margin in judgements(project / "run.json") if verdict == "violated"]
    assert [name for name, _ in violated] == ["at-goal"]
    assert all(margin is not None and -0.199 < margin < 0 for _, margin in violated)


def test_a_policy_judges_a_text_for_which_there_is_no_step(project: Path) -> None:
    model, execution = project / "pickplace.bdd", project / "pickplace.bddx"
    text = model.read_text(encoding="utf-8")
    clause = "at-goal: holds(<thing> is located at <goal>,"
    assert clause in text
    near = "at-goal: holds(pred('{thing} is near {goal}', thing=<thing>, goal=<goal>),"
    model.write_text(text.replace(clause, near), encoding="utf-8")
    assert main(["run", execution.name, "--where", "thing = cube0", "--json", "run.json"]) == 0
    found = [entry for entry in judgements(project / "run.json") if entry[0] == "at-goal"]
    assert found
    assert all(verdict == "holds" and margin is not None for _, verdict, margin in found)
