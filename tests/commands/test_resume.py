"""Runs that end early, by a signal, a kill or a closed pipe: shown results are kept, and they can be resumed."""

from __future__ import annotations

import json
import shutil
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Mapping
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES, default_signals, make_endless, schema_errors
from robbdd_tools.run.database import NAME
from robbdd_tools.run.store import FOLDER, RunStore

pytestmark = [pytest.mark.physics, pytest.mark.skipif(sys.platform == "win32", reason="Windows has no POSIX signals")]
INTERPRETER = [sys.executable, "-m", "robbdd_tools.cli"]
"""What signals and closed pipes reach."""
MODEL = "pickplace.bdd"


def robbdd(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([*ROBBDD, *arguments], capture_output=True, encoding="utf-8", cwd=folder)
    assert "Traceback" not in done.stderr
    return done


def start(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    command = [*INTERPRETER, *arguments]
    return subprocess.Popen(command, stdout=pipe, stderr=pipe, encoding="utf-8", cwd=folder, preexec_fn=default_signals)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a model of four scenarios, of which the ball's never end by themselves."""
    for path in (EXAMPLES / "pickplace").iterdir():
        if path.is_file():
            shutil.copy(path, tmp_path)
    make_endless(tmp_path / MODEL)
    return tmp_path


def until_first_line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline()


def stored(folder: Path, number: int = 1) -> Mapping[str, Any]:
    document = RunStore(folder / FOLDER).find(str(number)).results()
    assert schema_errors("run.schema.json", document) == []
    return document


def finished(document: Mapping[str, Any]) -> list[str]:
    return [entry["name"] for entry in document["scenarios"] if entry["duration"] is not None]


def agents_of(folder: Path) -> list[str]:
    """Return the command lines of processes that work on runs in a folder."""
    listed = subprocess.run(["ps", "-eo", "args"], capture_output=True, encoding="utf-8", check=True).stdout
    return [line for line in listed.splitlines() if "robbdd_tools.agent" in line and str(folder) in line]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_a_signal_ends_a_run_and_keeps_what_was_shown(folder: Path, number: signal.Signals) -> None:
    process = start(folder, "run", MODEL, "--jobs", "1", "--junit", "out.xml")
    shown = until_first_line(process)
    process.send_signal(number)
    rest, errors = process.communicate()
    assert process.returncode == 128 + number
    assert "the run is incomplete: the run was interrupted" in rest
    assert "resume it with: robbdd run --resume 1" in errors
    document = stored(folder)
    names = finished(document)
    assert names
    assert names[0] in shown
    assert document["ending"] == "the run was interrupted"
    assert (folder / FOLDER / "1" / "results.json").is_file()
    assert (folder / "out.xml").is_file()
    assert agents_of(folder) == []
    listed = robbdd(folder, "runs").stdout
    assert f"interrupted: {len(names)} of 4 finished" in listed


def test_a_killed_run_keeps_what_was_shown_and_its_agents_end(folder: Path) -> None:
    process = start(folder, "run", MODEL, "--jobs", "2")
    shown = until_first_line(process)
    # The agents are at scenarios that never end.
    process.kill()
    process.wait()
    names = finished(stored(folder))
    assert names[0] in shown
    assert "died: " in robbdd(folder, "runs").stdout
    wait_until_gone = subprocess.run(
        ["sh", "-c", f"while ps -eo args | grep -v grep | grep -q 'robbdd_tools.agent.*{folder}'; do sleep 0.1; done"],
        timeout=60,
        check=False,
    )
    assert wait_until_gone.returncode == 0


def test_a_resumed_run_gives_the_results_of_one_that_was_not_interrupted(folder: Path) -> None:
    process = start(folder, "run", MODEL, "--jobs", "1", "--seed", "3")
    until_first_line(process)
    process.kill()
    process.wait()
    refused = robbdd(folder, "run", "--resume", "--seed", "4")
    assert refused.returncode == 2
    assert "omit --seed" in refused.stderr
    # The steps are part of the run.
    steps = folder / "steps" / "pickplace_steps.py"
    endless = steps.read_text(encoding="utf-8")
    steps.unlink()
    assert "the model's steps were changed since it began" in robbdd(folder, "run", "--resume").stderr
    steps.write_text(endless, encoding="utf-8")

    # Let the ball's scenarios end, both in the run's folder and in the model's.
    sound = "def nothing():\n    pass\n"
    steps.write_text(sound, encoding="utf-8")
    copied = folder / FOLDER / "1" / "features" / "steps" / "model_steps.py"
    copied.write_text(sound, encoding="utf-8")
    done = robbdd(folder, "run", "--resume")
    assert done.returncode == 2
    assert "the features or the manifest" in done.stderr
    with closing(sqlite3.connect(folder / ".robbdd" / NAME)) as connection:
        from robbdd_tools.run.used_files import prepared_digest

        connection.execute("UPDATE run SET prepared = ?", (prepared_digest(folder / FOLDER / "1"),))
        connection.commit()
    before = finished(stored(folder))
    done = robbdd(folder, "run", "--resume", "--json", "resumed.json", "--junit", "resumed.xml")
    assert done.returncode == 0, done.stderr
    assert f"resuming run 1 of {MODEL}; died: {len(before)} of 4 finished" in done.stderr
    assert not any(line.startswith(before[0]) for line in done.stdout.splitlines()), "it was shown before"
    assert "4 scenarios: 4 hold" in done.stdout
    whole = robbdd(folder, "run", MODEL, "--seed", "3", "--json", "whole.json")
    assert whole.returncode == 0
    assert json.loads((folder / "resumed.json").read_text()) == json.loads((folder / "whole.json").read_text())
    traces = [sorted((folder / FOLDER / str(n) / "traces").iterdir()) for n in (1, 2)]
    assert [path.read_bytes() for path in traces[0]] == [path.read_bytes() for path in traces[1]]

    done = robbdd(folder, "run", "--resume")
    assert done.returncode == 2
    assert "there is no unfinished run in" in done.stderr
    assert "run 1 is finished" in robbdd(folder, "run", "--resume", "1").stderr


def test_a_run_of_a_changed_model_is_not_resumed(folder: Path) -> None:
    process = start(folder, "run", MODEL, "--jobs", "1")
    until_first_line(process)
    listed = robbdd(folder, "runs").stdout
    assert "running: " in listed
    assert "run 1 is in progress" in robbdd(folder, "run", "--resume", "1").stderr
    process.send_signal(signal.SIGTERM)
    process.communicate()
    model = folder / MODEL
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace("<goal>, after <evt-place-end>", "<goal>, before <evt-place-end>"), encoding="utf-8")
    done = robbdd(folder, "run", "--resume", MODEL)
    assert done.returncode == 2
    assert f"run 1 cannot be resumed: {MODEL} was changed since the run" in done.stderr
    model.write_text(text, encoding="utf-8")
    with closing(sqlite3.connect(folder / ".robbdd" / NAME)) as connection:
        connection.execute("UPDATE run SET version = '0.0.9'")
        connection.commit()
    assert "RobBDD 0.0.9 began it, and this is " in robbdd(folder, "run", "--resume").stderr
    with closing(sqlite3.connect(folder / ".robbdd" / NAME)) as connection:
        connection.execute("UPDATE run SET version = (SELECT ?), simulator = 'MuJoCo 1'", (version(),))
        connection.commit()
    done = robbdd(folder, "run", "--resume")
    assert done.returncode == 2
    assert "the run was made with MuJoCo 1, and this is MuJoCo" in done.stderr


def version() -> str:
    from robbdd_tools import __version__

    return __version__


def test_a_closed_pipe_costs_the_output_only(tmp_path: Path) -> None:
    for path in (EXAMPLES / "pickplace").iterdir():
        if path.is_file():
            shutil.copy(path, tmp_path)
    command = f"{' '.join(INTERPRETER)} run {MODEL} --json out.json | head -1; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, encoding="utf-8", cwd=tmp_path)
    assert done.returncode == 0
    assert "Traceback" not in done.stderr
    assert len(done.stdout.splitlines()) == 1
    document = stored(tmp_path)
    assert document["complete"]
    assert json.loads((tmp_path / "out.json").read_text(encoding="utf-8")) == document


def test_unfinished_runs_are_judged_replayed_and_queried(folder: Path) -> None:
    process = start(folder, "run", MODEL, "--jobs", "1", "--where", "goal=right_ws")
    until_first_line(process)
    process.kill()
    process.wait()
    said = "robbdd: run 1: died: 1 of 2 finished"
    judged = robbdd(folder, "judge", "1", MODEL, "--json", "judged.json")
    assert said in judged.stderr
    assert judged.returncode == 0, judged.stdout
    assert len(json.loads((folder / "judged.json").read_text(encoding="utf-8"))["scenarios"]) == 1
    replayed = robbdd(folder, "replay", "1")
    assert said in replayed.stderr
    assert "1 of 1 traces are the same" in replayed.stdout
    asked = robbdd(folder, "query", MODEL, "ASK { ?result earl:outcome earl:passed }", "--results")
    assert said in asked.stderr
    assert "true" in asked.stdout
