"""``robbdd replay`` and ``robbdd judge``: stored traces proved and judged again."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES, schema_errors
from robbdd_tools.traces.codec import Evidence
from robbdd_tools.traces.mcap_file import read_trace, write_trace

pytestmark = pytest.mark.physics
AT_GOAL = "at-goal: holds(<thing> is located at <goal>, after <evt-place-end>)"


def robbdd(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [*ROBBDD, *arguments]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=folder, env={**os.environ, **environment})
    assert "Traceback" not in done.stderr
    return done


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a model of two scenarios and a run of them."""
    folder = tmp_path_factory.mktemp("model")
    text = (EXAMPLES / "pickplace" / "pickplace.bdd").read_text(encoding="utf-8")
    (folder / "m.bdd").write_text(text.replace("<cubes.cube0>, <balls.ball0>", "<cubes.cube0>"), encoding="utf-8")
    shutil.copy(EXAMPLES / "pickplace" / "bench.scene", folder)
    assert robbdd(folder, "run", "m.bdd").returncode == 0
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    return shutil.copytree(made, tmp_path / "copy")


def edit(folder: Path, old: str, new: str) -> None:
    text = (folder / "m.bdd").read_text(encoding="utf-8")
    assert old in text
    (folder / "m.bdd").write_text(text.replace(old, new), encoding="utf-8")


def test_a_replay_gives_the_same_bits(folder: Path) -> None:
    done = robbdd(folder, "replay", "latest")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-3:] == [
        "crit:part-to-bin -- 1: the same to the last bit",
        "crit:part-to-bin -- 2: the same to the last bit",
        "2 of 2 traces are the same",
    ]


def test_a_trace_that_is_not_what_physics_gives_is_found_out(folder: Path) -> None:
    path = folder / ".robbdd" / "runs" / "1" / "traces" / "000001.mcap"
    evidence = read_trace(path)
    positions = evidence.trace.positions.copy()
    column = evidence.trace.column("env:cube0")
    positions[100, column, 0] += 1e-12
    write_trace(path, Evidence(replace(evidence.trace, positions=positions), evidence.regions), ())
    done = robbdd(folder, "replay", "1", "--scenario", "part-to-bin -- 2")
    assert done.returncode == 1
    assert "crit:part-to-bin -- 2: step 100 (1.600 s): position of env:cube0 x was " in done.stdout
    assert "0 of 1 traces are the same" in done.stdout


def test_a_changed_model_is_refused_but_not_a_reformatted_one(folder: Path) -> None:
    edit(folder, AT_GOAL, AT_GOAL + " // the same\n")
    assert robbdd(folder, "replay", "1", "--scenario", "part-to-bin -- 1").returncode == 0
    edit(folder, "<goal>, after <evt-place-end>", "<goal>, before <evt-place-end>")
    done = robbdd(folder, "replay", "1")
    assert done.returncode == 2
    assert "m.bdd was changed since the run" in done.stderr


def test_what_is_not_there_is_explained(folder: Path) -> None:
    assert "there is no run '9' in " in robbdd(folder, "replay", "9").stderr
    assert "keeps no trace of nothing" in robbdd(folder, "replay", "1", "--scenario", "nothing").stderr
    (folder / ".robbdd" / "runs" / "1" / "traces" / "000000.mcap").unlink()
    shown = robbdd(folder, "replay", "1").stdout.splitlines()
    assert "crit:part-to-bin -- 1: the run kept no trace of it" in shown
    assert shown[-1] == "1 of 1 traces are the same"
    (folder / "m.bdd").unlink()
    assert robbdd(folder, "replay", "1").stderr == "robbdd: the model of the run, m.bdd, is gone\n"


def judged(folder: Path, returncode: int) -> list[Mapping[str, Any]]:
    """Judge run 1 where the physics engine cannot be imported; returns the clauses of the first scenario by name."""
    broken = folder / "broken"
    broken.mkdir(exist_ok=True)
    (broken / "mujoco.py").write_text("raise ImportError('judging needs no simulator')")
    done = robbdd(folder, "judge", "1", "m.bdd", "--json", "out.json", PYTHONPATH=str(broken))
    assert done.returncode == returncode, done.stdout + done.stderr
    document = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    assert schema_errors("run.schema.json", document) == []
    return document["scenarios"][0]["clauses"]


def clause(clauses: list[Mapping[str, Any]], words: str) -> Mapping[str, Any]:
    (found,) = (one for one in clauses if words in one["sentence"])
    return found


def test_unchanged_clauses_keep_their_verdicts(folder: Path) -> None:
    stored = json.loads((folder / ".robbdd" / "runs" / "1" / "results.json").read_text(encoding="utf-8"))
    assert judged(folder, 0) == stored["scenarios"][0]["clauses"]


def test_tightened_and_loosened_clauses_are_judged_on_the_old_trace(folder: Path) -> None:
    edit(folder, "<goal>, after <evt-place-end>", "<goal>, from <evt-pick-end> until <evt-place-end>")
    found = clause(judged(folder, 1), 'from "crit:evt-pick-end"')
    assert (found["verdict"], found["unit"]) == ("violated", "m")
    assert found["robustness"] < -0.1
    edit(folder, "<goal>, from <evt-pick-end> until <evt-place-end>", "<goal>, before <evt-place-end>")
    assert clause(judged(folder, 0), 'before event "crit:evt-place-end"')["verdict"] == "holds"


def test_what_the_trace_does_not_tell_is_unknown(folder: Path) -> None:
    edit(folder, "<goal>, after <evt-place-end>", "<goal>, 60 seconds after <evt-place-end>")
    found = clause(judged(folder, 1), "for 60")
    assert (found["verdict"], found["robustness"]) == ("unknown", None)
    assert re.fullmatch(
        r"the stored trace ends at \d+\.\d\d s, before \d+\.\d\d s when the window closes: execute a new run",
        found["reason"],
    )
    edit(folder, "60 seconds after <evt-place-end>", "60 seconds before <evt-place-end>")
    found = clause(judged(folder, 1), "for 60")
    assert re.fullmatch(
        r"the stored trace begins \d+\.\d\d s before event crit:evt-place-end, not 60 s: execute a new run",
        found["reason"],
    )
    edit(folder, "60 seconds before <evt-place-end>", "60 seconds after <evt-place-end>")
    edit(folder, "60 seconds after <evt-place-end>", "after <evt-end>")
    found = clause(judged(folder, 1), 'after event "crit:evt-end"')
    assert re.fullmatch(
        r"the stored trace ends at \d+\.\d\d s, before event crit:evt-end: execute a new run", found["reason"]
    )
    edit(folder, "<goal>, after <evt-end>", "<goal>, after <evt-place-start>")
    edit(folder, "Event (ns=crit) evt-end", "Event (ns=crit) evt-end\nEvent (ns=crit) evt-place-start")
    found = clause(judged(folder, 1), "place-start")
    assert found["reason"] == "the stored trace has no record of event crit:evt-place-start: execute a new run"


def test_a_changed_scene_needs_a_new_run(folder: Path) -> None:
    edit(folder, "<thing> is located at <source>", "<thing> is located at <goal>")
    reasons = {one["reason"] for one in judged(folder, 1)}
    assert reasons == {"the scene changed since the run: execute a new run"}
