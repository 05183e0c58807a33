"""Results for Allure Report: one per execution, with clauses as steps, times of the run and equal bytes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from robbdd_tools.cli import main
from robbdd_tools.run.store import RunStore
from run.recorded import CLAUSES, record_run


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    record_run(RunStore(tmp_path / ".robbdd" / "runs"), [0.3, -0.1, None], clauses=CLAUSES)
    return tmp_path


def results(folder: Path) -> list[dict[str, Any]]:
    found = [json.loads(path.read_text(encoding="utf-8")) for path in folder.glob("*-result.json")]
    return sorted(found, key=lambda one: one["name"])


def test_executions_are_results_and_clauses_are_steps(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "latest", "--allure", "-o", "allure"]) == 0
    assert capsys.readouterr().out == "3 results in allure\n"
    held, violated, unknown = results(folder / "allure")
    assert [one["status"] for one in (held, violated, unknown)] == ["passed", "failed", "broken"]
    assert "statusDetails" not in held
    assert violated["statusDetails"]["message"] == "c5 is violated by −100 mm: -0.1"
    assert unknown["statusDetails"]["message"] == "c5 is unknown: None"
    assert [step["status"] for step in violated["steps"]] == ["failed", "failed"]
    assert violated["steps"][0]["name"] == "Then a 5"
    assert {"name": "margin", "value": "−100 mm"} in violated["steps"][0]["parameters"]
    assert {"name": "x", "value": "1"} in violated["parameters"]
    # The wall time of the recorded executions is 1.5 s.
    assert violated["stop"] - violated["start"] == 1500
    assert violated["uuid"] in {path.name.removesuffix("-result.json") for path in (folder / "allure").iterdir()}
    assert "digest\\ of\\ its\\ graph=abc" in (folder / "allure" / "environment.properties").read_text(encoding="utf-8")


def test_the_same_run_gives_the_same_files_and_another_run_the_same_tests(folder: Path) -> None:
    for name in ("one", "other"):
        assert main(["export", "1", "--allure", "-o", name]) == 0
    for path in (folder / "one").iterdir():
        assert (folder / "other" / path.name).read_bytes() == path.read_bytes()
    record_run(RunStore(folder / ".robbdd" / "runs"), [0.3, 0.1, 0.1], clauses=CLAUSES)
    assert main(["export", "2", "--allure", "-o", "later"]) == 0
    before, after = (results(folder / name) for name in ("one", "later"))
    assert [one["historyId"] for one in before] == [one["historyId"] for one in after]
    assert {one["uuid"] for one in before}.isdisjoint(one["uuid"] for one in after)


def test_scenarios_can_be_chosen_and_wrong_arguments_are_explained(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", "1", "--allure", "-o", "some", "--scenario", "e:v -- 2"]) == 0
    assert [one["name"] for one in results(folder / "some")] == ["e:v -- 2"]
    assert main(["export", "1", "--allure", "-o", "none", "--scenario", "w"]) == 2
    assert main(["export", "1", "--allure", "--mcap", "-o", "none"]) == 2
    assert main(["export", "9", "--allure", "-o", "none"]) == 2
    said = capsys.readouterr().err
    assert "the run has no scenario w" in said
    assert "--mcap is a format of bags" in said
    assert "there is no run '9'" in said
    assert not (folder / "none").exists()
