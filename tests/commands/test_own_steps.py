"""Users' own steps: their arguments, and that a run keeps the steps it was made with."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from commands.test_gherkin import robbdd
from kit import EXAMPLES

pytestmark = pytest.mark.physics
IN_ITS_BIN = "in-its-bin: holds(<part> is located at <bin>, after <evt-end>)"
LIT = 'lit: holds(pred("light of {where} falls on {what}", what=<part>, where=<bin>), before <evt-end>)'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Holds a model that quantifies over a clause which only its user can judge, and the user's step for it."""
    folder = shutil.copytree(EXAMPLES / "sorting", tmp_path / "sorting")
    model = folder / "sorting.bdd"
    model.write_text(model.read_text(encoding="utf-8").replace(IN_ITS_BIN, LIT), encoding="utf-8")
    own = folder / "steps" / "sorting_steps.py"
    assert robbdd("steps", model, "--undefined", "-o", own, folder=folder).returncode == 0
    skeleton = own.read_text(encoding="utf-8")
    assert skeleton.count("raise NotImplementedError") == 1
    judged = "assert what != 'env:cube1', f'{what} is dark at {where} before {event}'"
    own.write_text(skeleton.replace("raise NotImplementedError", judged), encoding="utf-8")
    return folder


def test_quantified_variables_and_slots_reach_a_step_and_a_replay_takes_the_runs_own_copy(folder: Path) -> None:
    robbdd("run", "sorting.bdd", "--first", "1", "--json", "out.json", folder=folder)
    report: Any = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    told = {
        clause["sentence"]: (clause["verdict"], clause["reason"])
        for clause in report["scenarios"][0]["clauses"]
        if clause["sentence"].startswith("light")
    }
    sentence = 'light of env:cubes_ws falls on {} before event "crit:evt-end"'
    assert told == {
        sentence.format("env:cube0"): ("holds", ""),
        sentence.format("env:cube1"): ("violated", "env:cube1 is dark at env:cubes_ws before crit:evt-end"),
    }
    (folder / "steps" / "sorting_steps.py").write_text("raise SystemExit(3)\n", encoding="utf-8")
    again = robbdd("replay", "latest", folder=folder)
    assert again.stdout.splitlines()[-1] == "1 of 1 traces are the same", again.stderr
