"""A disk that becomes full during ``robbdd run``: shown results are kept, and the run can be resumed."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES, fill_disk, small_disk

pytestmark = pytest.mark.physics
MODEL = "pickplace.bdd"
GATE = "ROBBDD_TEST_GATE"
WAITING = f"""import os, time
from behave import when

@when('"{{agent}}" picks "env:ball0" and places it at "{{workspace}}"')
def wait(context, agent, workspace):
    while not os.path.exists(os.environ["{GATE}"]):
        time.sleep(0.01)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The example; its balls are on their way until the file ``open`` exists."""
    shutil.copytree(EXAMPLES / "pickplace", tmp_path / "model")
    (tmp_path / "model" / "steps").mkdir()
    (tmp_path / "model" / "steps" / "pickplace_steps.py").write_text(WAITING, encoding="utf-8")
    return tmp_path / "model"


def start(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    environment = {**os.environ, GATE: str(folder / "open")}
    command = [*ROBBDD, "run", *arguments]
    return subprocess.Popen(command, stdout=pipe, stderr=pipe, encoding="utf-8", cwd=folder, env=environment)


def holding(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("crit:part-to-bin -- ")]


def test_a_run_ends_with_the_reason_keeps_what_it_showed_and_can_be_resumed(folder: Path) -> None:
    store = folder / ".robbdd"
    store.mkdir()
    with small_disk(store, 4096):
        process = start(folder, MODEL, "--jobs", "1", "--seed", "3", "--json", "full.json")
        assert process.stdout is not None
        # The cube's two scenarios are first.
        shown = ""
        while len(holding(shown)) < 2:
            line = process.stdout.readline()
            assert line, "the run has ended"
            shown += line
        fill_disk(store / "filler")
        (folder / "open").touch()
        rest, errors = process.communicate()
        assert process.returncode == 2
        assert holding(rest) == [], "what cannot be kept is not shown as a result"
        full = f"results can no longer be stored: {store / 'results.sqlite'}: database or disk is full"
        assert f"the run is incomplete: {full}" in rest
        assert "4 scenarios: 2 hold, 0 violated, 2 unknown" in rest
        assert "the trace is not kept: No space left on device\n" in rest
        assert errors.splitlines() == ["kept as run 1", "resume it with: robbdd run --resume 1", f"robbdd: {full}"]
        verdicts = [entry["verdict"] for entry in json.loads((folder / "full.json").read_text())["scenarios"]]
        assert verdicts == ["holds", "holds", "unknown", "unknown"]

        (store / "filler").unlink()
        resumed = start(folder, "--resume", "--json", "resumed.json")
        output, errors = resumed.communicate()
        assert "died: 2 of 4 finished" in errors
        assert len(holding(output)) == 2
        assert "4 scenarios: " in output
        whole = start(folder, MODEL, "--seed", "3", "--json", "whole.json", "--output", "elsewhere")
        whole.communicate()
        assert resumed.returncode == whole.returncode
        assert json.loads((folder / "resumed.json").read_text()) == json.loads((folder / "whole.json").read_text())


def test_a_report_that_finds_no_room_costs_no_result(folder: Path) -> None:
    reports = folder / "reports"
    reports.mkdir()
    (folder / "open").touch()
    with small_disk(reports, 64):
        fill_disk(reports / "filler")
        process = start(folder, MODEL, "--jobs", "1", "--json", "reports/out.json")
        output, errors = process.communicate()
    assert process.returncode == 2
    assert len(holding(output)) == 4
    assert errors.splitlines()[0] == "kept as run 1"
    assert "out.json: No space left on device" in errors
    assert "Traceback" not in errors


def test_a_disk_that_is_full_before_a_run_leaves_it_unkept_and_executed(folder: Path) -> None:
    store = folder / ".robbdd"
    store.mkdir()
    (folder / "open").touch()
    with small_disk(store, 64):
        fill_disk(store / "filler")
        process = start(folder, MODEL, "--jobs", "1")
        output, errors = process.communicate()
    assert "this run is not kept: " in errors
    assert len(holding(output)) == 4
    assert "Traceback" not in errors
