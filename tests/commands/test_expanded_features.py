"""Features with definitions in place of phrases have the verdicts and margins of those with phrases."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES

pytestmark = pytest.mark.physics
EDITS = (("for 0.5 seconds after", "for 0.6 seconds after"), ("within 1 seconds after", "within 2 seconds after"))
"""Edits by hand: these sentences are read, and not taken from the manifest."""


def judged(project: Path, *, expand: bool, edit: bool) -> list[tuple[str, list[str]]]:
    """Return the status and the verdict of each step of a project's features in plain behave."""
    out = project / f"{expand}-{edit}"
    command = [*ROBBDD, "gherkin", "namedpredicates.bdd", "-o", str(out), *(["--expand"] if expand else [])]
    subprocess.run(command, cwd=project, check=True, capture_output=True)
    (feature,) = (out / "features").glob("*.feature")
    text = feature.read_text(encoding="utf-8")
    assert ("is-stored in" in text) is not expand
    assert ('and not ( "env:cube" is held by "env:panda" )' in text) is expand or not expand
    for old, new in EDITS if edit else ():
        assert old in text
        text = text.replace(old, new)
    feature.write_text(text, encoding="utf-8")
    report = out / "report.json"
    behave = [sys.executable, "-m", "behave", "--format", "json", "--outfile", str(report), str(feature)]
    subprocess.run(behave, cwd=project, capture_output=True, check=False)
    features: Any = json.loads(report.read_text(encoding="utf-8"))
    results = [
        step["result"] for element in features[0]["elements"] for step in element["steps"] if step["keyword"] == "Then"
    ]
    return [(result["status"], result.get("error_message", [])) for result in results]


@pytest.mark.parametrize("edit", [False, True])
def test_behave_judges_definitions_as_phrases(edit: bool, tmp_path: Path) -> None:
    project = shutil.copytree(EXAMPLES / "namedpredicates", tmp_path / "model")
    plain, expanded = (judged(project, expand=expand, edit=edit) for expand in (False, True))
    assert [status for status, _ in plain] == ["passed", "passed", "failed", "failed"]
    assert expanded == plain
    assert all("margin" in str(message) for status, message in plain if status == "failed")
