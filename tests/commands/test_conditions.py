"""The example with conditions, in physics and on stored traces."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main
from robbdd_tools.monitor.verdict import NEVER_APPLIED

pytestmark = pytest.mark.physics


def clauses(path: Path) -> list[dict[str, Any]]:
    document: Any = json.loads(path.read_text(encoding="utf-8"))
    return [{entry["name"]: entry for entry in scenario["clauses"]} for scenario in document["scenarios"]]


def test_a_condition_limits_what_is_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(shutil.copytree(EXAMPLES / "conditions", tmp_path / "conditions"))
    assert main(["run", "conditions.bdd", "--json", "run.json"]) == 1
    slow, fast = clauses(Path("run.json"))
    assert {name for name, one in slow.items() if one["verdict"] != "holds"} == set()
    assert [name for name, one in fast.items() if one["verdict"] != "holds"] == ["slow-with-part"]
    assert (fast["slow-with-part"]["unit"], fast["slow-with-part"]["robustness"] < 0) == ("m/s", True)
    never = slow["not-in-the-other"]
    assert (never["verdict"], never["robustness"], never["vacuous"]) == ("holds", None, NEVER_APPLIED)
    assert not slow["slow-with-part"]["vacuous"]
    assert main(["judge", "latest", "conditions.bdd", "--json", "judge.json"]) == 1
    again = clauses(Path("judge.json"))
    assert [{name: one["robustness"] for name, one in each.items()} for each in again] == [
        {name: one["robustness"] for name, one in each.items()} for each in (slow, fast)
    ]
