"""A project with a stored run that an earlier state of the product wrote is opened, judged, reported and continued.

``earlier-project.zip`` is the example of that time with a run of two scenarios, as its commands left them.
"""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path
from zipfile import ZipFile

import pytest

from fork_kit import ROBBDD
from robbdd_tools.run.json_documents import trace_document
from robbdd_tools.run.store import RunStore

ARCHIVE = Path(__file__).with_name("earlier-project.zip")
VERDICTS = ["✔"] * 5
pytestmark = [pytest.mark.physics, pytest.mark.usefixtures("forks")]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    with ZipFile(ARCHIVE) as archive:
        archive.extractall(tmp_path)
    return tmp_path


def robbdd(project: Path, *arguments: str) -> str:
    done = subprocess.run([*ROBBDD, *arguments], cwd=project, capture_output=True, text=True)
    assert done.returncode == 0, (arguments, done.stdout, done.stderr)
    return done.stdout


def signs(output: str) -> list[str]:
    return re.findall(r"^  ([✔✗?]) ", output, re.MULTILINE)


def test_its_models_have_no_problem(project: Path) -> None:
    assert robbdd(project, "check", ".").strip() == "4 files: 0 errors, 0 other remarks"


def test_its_run_is_listed_and_judged_as_it_was(project: Path) -> None:
    stored = json.loads((project / ".robbdd/runs/1/results.json").read_text(encoding="utf-8"))
    assert [scenario["verdict"] for scenario in stored["scenarios"]] == ["holds", "holds"]
    assert "2 hold, 0 violated, 0 unknown" in robbdd(project, "runs")
    judged = robbdd(project, "judge", "1", "pickplace.bdd")
    assert signs(judged) == VERDICTS * 2
    margins = [
        round(clause["robustness"] * 1000) for clause in stored["scenarios"][0]["clauses"] if clause["unit"] == "m"
    ]
    assert margins
    assert [int(one) for one in re.findall(r"([+−]\d+) mm", judged)[: len(margins)]] == margins


def test_an_edited_clause_is_judged_on_its_trace(project: Path) -> None:
    model = project / "pickplace.bdd"
    text = model.read_text(encoding="utf-8")
    held = "is held by <robot>, after <evt-{}-end>"
    assert held.format("pick") in text
    model.write_text(text.replace(held.format("pick"), held.format("place")), encoding="utf-8")
    done = subprocess.run([*ROBBDD, "judge", "1", "pickplace.bdd"], cwd=project, capture_output=True, text=True)
    assert done.returncode == 1, done.stderr
    assert done.stdout.count("✗ cube0 is held by panda after evt-place-end") == 2


def test_it_is_reported_exported_and_queried(project: Path) -> None:
    robbdd(project, "report", "1", "pickplace.bdd", "-o", "report.html")
    assert "at-goal" in (project / "report.html").read_text(encoding="utf-8")
    robbdd(project, "export", "1", "--ros2", "-o", "bag")
    assert len(list((project / "bag").iterdir())) == 2
    assert "at-goal" in robbdd(project, "query", "pickplace.bdd", "--name", "verdicts", "--results")


def test_its_trace_can_be_replayed_in_an_editor(project: Path) -> None:
    run = RunStore(project / ".robbdd" / "runs").find("1")
    answer = trace_document(run, 0)
    assert answer["duration"] > 5
    assert {clause["name"] for clause in answer["clauses"]} >= {"at-source", "at-goal"}
    assert len(answer["frames"]["bodies"]) > 5


def test_a_new_run_joins_the_old_one_in_its_store(project: Path) -> None:
    robbdd(project, "run", "pickplace.bdd", "--where", "thing=cube0 and goal=left_ws")
    listed = robbdd(project, "runs").splitlines()
    assert [line.split()[0] for line in listed if "pickplace.bdd" in line] in (["1", "2"], ["2", "1"])


def test_a_finished_run_is_not_continued(project: Path) -> None:
    done = subprocess.run(
        [*ROBBDD, "run", "--resume", "1", "pickplace.bdd"], cwd=project, capture_output=True, text=True
    )
    assert (done.returncode, "run 1 is finished" in done.stderr) == (2, True)
