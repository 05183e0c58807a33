"""``robbdd mutate`` as people and scripts use it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import jsonschema
import pytest

from commands.test_gherkin import robbdd
from kit import EXAMPLES, ROOT

pytestmark = pytest.mark.physics
SCHEMA = json.loads((ROOT / "docs/schemas/mutation.schema.json").read_text(encoding="utf-8"))


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    return shutil.copytree(EXAMPLES / "pickplace", tmp_path / "bench")


def test_a_survivor_is_named_at_its_template_with_a_clause_that_notices_it(bench: Path) -> None:
    command = ["mutate", "pickplace.bdd", "--first", "1", "--fault", "high-release", "--fault", "no-release"]
    done = robbdd(*command, "--json", "m.json", "--markdown", "m.md", folder=bench)
    assert done.returncode == 1, done.stderr
    missing = "pickplace.bdd:13: template pick-place: nothing notices that places to put down are seen 50 mm too high"
    assert missing in done.stdout
    clause = "does-not-drop: holds(<robot> does not drop <thing>, from <evt-start> until <evt-end>)"
    assert f"    this clause notices it: {clause}\n" in done.stdout
    assert "no-release          1/1      ·          ·              ·        1        ·\n" in done.stdout
    assert done.stdout.rstrip().endswith("1 of 2 faults are noticed in every execution")
    report = (bench / "m.json").read_bytes()
    jsonschema.validate(json.loads(report), SCHEMA)
    assert (bench / "m.md").read_text(encoding="utf-8").startswith("### pick-place\n\n| fault | noticed |")
    robbdd(*command, "--json", "again.json", "--jobs", "1", folder=bench)
    assert (bench / "again.json").read_bytes() == report
    assert not (bench / ".robbdd").exists()

    model = bench / "pickplace.bdd"
    text = model.read_text(encoding="utf-8")
    end = "until <evt-place-end>)\n        )"
    assert end in text
    model.write_text(text.replace(end, f"until <evt-place-end>)\n and\n {clause}\n )"), encoding="utf-8")
    done = robbdd(*command, folder=bench)
    assert (done.returncode, "nothing notices" in done.stdout) == (0, False), done.stdout


def test_a_model_that_fails_without_faults_says_nothing_about_faults(bench: Path) -> None:
    model = bench / "pickplace.bdd"
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace("<robot>, after <evt-pick-end>", "<robot>, after <evt-place-end>"), encoding="utf-8")
    done = robbdd("mutate", "pickplace.bdd", "--first", "1", folder=bench)
    assert done.returncode == 2, done.stdout
    assert "1 execution does not hold without any fault" in done.stdout
    assert "no execution holds without a fault" in done.stderr


def test_faults_are_listed_and_wrong_ones_refused(tmp_path: Path) -> None:
    listed = robbdd("mutate", "--list", folder=tmp_path)
    assert listed.returncode == 0
    assert "offset-pose=10     everything is seen 10 mm away from its place\n" in listed.stdout
    wrong = robbdd("mutate", "x.bdd", "--fault", "weak-grip=3", folder=tmp_path)
    assert (wrong.returncode, "it must be a number from 0.01 to 0.99" in wrong.stderr) == (2, True)
    nothing = robbdd("mutate", folder=tmp_path)
    assert (nothing.returncode, "name a model or a folder" in nothing.stderr) == (2, True)
