"""The example with a handover: two arms, and an event that the template defines, in physics and on stored traces."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

pytestmark = pytest.mark.physics


def clauses(path: Path) -> list[dict[str, Any]]:
    document: Any = json.loads(path.read_text(encoding="utf-8"))
    return [{entry["name"]: entry for entry in scenario["clauses"]} for scenario in document["scenarios"]]


def test_the_second_arm_takes_the_part_when_it_lies_still(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(shutil.copytree(EXAMPLES / "handover", tmp_path / "handover"))
    assert main(["run", "handover.bdd", "--json", "run.json"]) == 1
    fast, slow = clauses(Path("run.json"))
    assert {name for name, one in fast.items() if one["verdict"] != "holds"} == set()
    assert [name for name, one in slow.items() if one["verdict"] != "holds"] == ["in-time"]
    assert slow["in-time"]["robustness"] < 0 <= fast["in-time"]["robustness"]
    # The definition of the event is edited: the stored trace shows when it would have occurred.
    text = Path("handover.bdd").read_text(encoding="utf-8")
    Path("handover.bdd").write_text(text.replace("at rest for 0.25", "at rest for 0.5"), encoding="utf-8")
    assert main(["judge", "latest", "handover.bdd", "--json", "judge.json"]) == 1
    ready = "when-evt-hand-over.when2.0"
    later, _ = clauses(Path("judge.json"))
    assert later[ready]["at"] > fast[ready]["at"] + 0.24
