"""``robbdd run --world kinematic``: marked results, also when they are judged or executed again."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from kit import EXAMPLES, schema_errors
from robbdd_tools.cli import main
from robbdd_tools.protocol.specs import NO_PHYSICS
from robbdd_tools.workbench.execution_rows import execution_results

pytestmark = pytest.mark.physics


@pytest.fixture
def model(tmp_path: Path) -> Path:
    for name in ("pickplace.bdd", "bench.scene"):
        shutil.copy(EXAMPLES / "pickplace" / name, tmp_path)
    return tmp_path / "pickplace.bdd"


def test_a_run_without_physics_is_marked_and_holds_nothing(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = model.parent / "out.json"
    assert main(["run", str(model), "--world", "kinematic", "--first", "1", "--json", str(out)]) == 1
    assert NO_PHYSICS in capsys.readouterr().out
    document = json.loads(out.read_text(encoding="utf-8"))
    assert schema_errors("run.schema.json", document) == []
    (found,) = execution_results(document)
    assert (found.world, found.choices, str(found.verdict)) == ("kinematic", (NO_PHYSICS,), "unknown")
    verdicts = {clause.name: str(clause.verdict) for clause in found.clauses}
    assert verdicts["at-goal"] == "holds"
    assert verdicts["in-hand"] == "unknown"
    assert main(["judge", "latest", str(model), "--no-store"]) == 1
    assert NO_PHYSICS in capsys.readouterr().out
    assert main(["run", str(model), "--rerun-failed", "--no-store"]) == 1
    assert NO_PHYSICS in capsys.readouterr().out


def test_physics_is_not_mentioned(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = model.parent / "out.json"
    assert main(["run", str(model), "--world", "physics", "--first", "1", "--no-store", "--json", str(out)]) == 0
    assert "physics" not in capsys.readouterr().out
    assert "world" not in json.loads(out.read_text(encoding="utf-8"))["scenarios"][0]
