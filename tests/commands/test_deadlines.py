"""The example with deadlines: in physics, on stored traces, and in features that a person edits."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

pytestmark = pytest.mark.physics
DEADLINE = "at some time within 12 seconds after"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = shutil.copytree(EXAMPLES / "deadlines", tmp_path / "deadlines")
    monkeypatch.chdir(folder)
    return folder


def judgements(path: Path) -> dict[str, tuple[str, float, str]]:
    document: Any = json.loads(path.read_text(encoding="utf-8"))
    return {
        clause["name"] + str(scenario["values"].get("dl:var-limit", "")): (
            clause["verdict"],
            clause["robustness"],
            clause["reason"],
        )
        for scenario in document["scenarios"]
        for clause in scenario["clauses"]
    }


def test_a_deadline_holds_or_is_missed_with_the_time_that_was_left(project: Path) -> None:
    assert main(["run", "deadlines.bdd", "--where", "part = cube0", "--json", "run.json"]) == 1
    found = judgements(project / "run.json")
    assert {name for name, (verdict, _, _) in found.items() if verdict != "holds"} == {
        "express-delivered5",
        "express-quick5",
    }
    assert found["express-delivered12"][0] == "holds"
    verdict, margin, reason = found["express-quick5"]
    assert (verdict, margin < -1000) == ("violated", True)  # ms
    assert reason.startswith("it took ")
    verdict, margin, reason = found["express-delivered5"]
    assert (verdict, margin < 0) == ("violated", True)
    assert reason.startswith("it held at no time until ")
    assert found["delivered"][1] > 0
    assert " before the window closes" in found["delivered"][2]
    assert main(["judge", "latest", "deadlines.bdd", "--json", "judge.json"]) == 1
    assert judgements(project / "judge.json") == found


def by_behave(project: Path, *edits: tuple[str, str]) -> str:
    """Write the features, edit them, and return what behave prints for the first scenario."""
    assert main(["gherkin", "deadlines.bdd", "-o", "out", "--where", "part = cube0", "--first", "1"]) == 0
    (feature,) = (project / "out" / "features").glob("*.feature")
    text = feature.read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    feature.write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "behave", "--no-color", str(feature)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", cwd=project / "out", check=False)
    return done.stdout + done.stderr


def test_an_edited_deadline_is_judged(project: Path) -> None:
    assert "1 scenario passed" in by_behave(project, (DEADLINE, "at some time within 13 seconds after"))


def test_within_without_at_some_time_is_unknown_and_says_what_to_write(project: Path) -> None:
    printed = by_behave(project, (DEADLINE, "within 12 seconds after"))
    assert "unknown: no step definition" in printed
    assert "write 'for 12 seconds', or 'at some time within 12 seconds'" in printed


def test_within_keeps_its_meaning_in_an_older_feature_with_a_remark(project: Path) -> None:
    printed = by_behave(project, ("# wording: 2\n", "\n"), (DEADLINE, "within 12 seconds after"))
    assert "violated: margin" in printed
    assert "is judged as 'for 12 seconds', because its feature has no line '# wording: 2'" in printed
