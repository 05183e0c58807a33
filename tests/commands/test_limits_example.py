"""The example with quantities, in physics and in its features."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.cli import main

pytestmark = pytest.mark.physics


def test_limits_are_kept_or_exceeded_in_their_units(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(shutil.copytree(EXAMPLES / "limits", tmp_path / "limits"))
    assert main(["run", "limits.bdd", "--json", "run.json"]) == 1
    printed = capsys.readouterr().out
    assert "limit = 0.6 m/s" in printed
    assert "moves slower than 0.2 m/s whenever panda is nearer than 30 cm to left_ws" in printed
    document: Any = json.loads(Path("run.json").read_text(encoding="utf-8"))
    wide, narrow = ({one["name"]: one for one in scenario["clauses"]} for scenario in document["scenarios"])
    assert {one["verdict"] for one in wide.values()} == {"holds"}
    assert {name for name, one in narrow.items() if one["verdict"] != "holds"} == {
        "slow-near-bin",
        "gentle",
        "straight",
    }
    assert [wide[name]["unit"] for name in ("slow-near-bin", "far-from-other", "level")] == ["m/s", "m", "deg"]
    assert 0 < wide["level"]["robustness"] < 15
    assert (wide["gentle"]["unit"], wide["lands"]["unit"], wide["rests"]["unit"]) == ("N", "N", "m/s")
    assert [wide[name]["unit"] for name in ("clear", "straight", "easy-joints")] == ["cm", "cm", "%"]
    assert 0 < wide["easy-joints"]["robustness"] < 50
    assert narrow["gentle"]["robustness"] < -10
    assert main(["gherkin", "limits.bdd", "-o", "out"]) == 0
    (feature,) = Path("out", "features").glob("*.feature")
    assert 'moves slower than "0.2 m/s" whenever "env:panda" is nearer than "30 cm"' in feature.read_text("utf-8")
