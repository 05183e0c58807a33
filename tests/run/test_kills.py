"""Runs killed repeatedly at random instants. ``ROBBDD_KILLS`` is the number of kills (30)."""

from __future__ import annotations

import os
import random
import re
import shutil
import sqlite3
import subprocess
from contextlib import closing
from pathlib import Path
from time import monotonic, sleep

import pytest

from fork_kit import run_module
from robbdd_tools.run.store import FOLDER, NoSuchRun, RunStore, StoredRun
from run.killed import BEGUN, COUNT, JOBS
from run.recorded import rows

KILLS = int(os.environ.get("ROBBDD_KILLS", "30"))
SHOWN = re.compile(r"^e:v -- (\d+)  .*\n", re.MULTILINE)


def start(folder: Path) -> subprocess.Popen[str]:
    command = [*run_module("run.killed"), str(folder)]
    # A file instead of a pipe: all output can be read after the process is gone.
    with (folder / "printed").open("w", encoding="utf-8") as printed:
        return subprocess.Popen(command, stdout=printed, stderr=subprocess.PIPE, text=True)


def ends(process: subprocess.Popen[str], seconds: float | None = None) -> None:
    _, errors = process.communicate(timeout=seconds)
    assert process.returncode == 0, errors


def ends_within(process: subprocess.Popen[str], seconds: float) -> bool:
    """Return whether a process ends in time; else kill it."""
    try:
        ends(process, seconds)
    except subprocess.TimeoutExpired:
        _kill(process)
        return False
    return True


def ends_before(process: subprocess.Popen[str], folder: Path, results: int) -> bool:
    """Return whether a process ends before it has printed so many results; else kill it then."""
    while process.poll() is None:
        if len(printed(folder)) >= results:
            _kill(process)
            return False
        sleep(0.002)
    ends(process)
    return True


def _kill(process: subprocess.Popen[str]) -> None:
    process.kill()
    process.communicate()  # a fork ends a moment after what started it: until then it holds the pipe


def printed(folder: Path) -> set[int]:
    return {int(number) - 1 for number in SHOWN.findall((folder / "printed").read_text(encoding="utf-8"))}


def begun(folder: Path) -> set[int]:
    path = folder / BEGUN
    found = set(map(int, path.read_text(encoding="utf-8").split())) if path.exists() else set[int]()
    path.unlink(missing_ok=True)
    return found


def stored(run: StoredRun) -> set[int]:
    try:
        document = run.results()
    except NoSuchRun:
        return set()
    return {index for index, entry in enumerate(document["scenarios"]) if entry["duration"] is not None}


def check_integrity(database: Path) -> None:
    with closing(sqlite3.connect(database)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert connection.execute("PRAGMA foreign_key_check").fetchall() == []


@pytest.mark.usefixtures("forks")
def test_killed_runs_lose_nothing_and_end_as_if_they_had_not_been(tmp_path: Path) -> None:
    chance = random.Random(4)
    whole = tmp_path / "whole"
    whole.mkdir()
    began = monotonic()
    ends(start(whole))
    longest = monotonic() - began
    assert printed(whole) == set(range(COUNT))
    (run,) = RunStore(whole / FOLDER).runs()
    expected = rows(run.database, run.number)
    kills = in_the_middle = 0
    while kills < KILLS:
        folder = tmp_path / "killed"
        folder.mkdir()
        before: set[int] = set()
        # Starting takes longer than executing: most kills by time alone would be too early.
        by_clock = kills % 2 == 0
        while not (
            ends_within(start(folder), chance.uniform(0.0, longest))
            if by_clock
            else ends_before(start(folder), folder, chance.randrange(1, COUNT))
        ):
            by_clock = not by_clock
            kills += 1
            runs = [run for run in RunStore(folder / FOLDER).runs() if run.began]
            now = set[int]().union(*map(stored, runs))
            assert before | printed(folder) <= now, "a result was lost"
            assert len(begun(folder) - now) <= JOBS, "that many are executed again"
            in_the_middle += before < now < set(range(COUNT))
            before = now
            if runs:
                check_integrity(runs[0].database)
                if runs[0].status().is_whole:
                    break
        (run,) = (run for run in RunStore(folder / FOLDER).runs() if run.began)
        assert rows(run.database, run.number) == expected
        shutil.rmtree(folder)
    assert in_the_middle, "no run was killed while it went on"
    print(f"{kills} kills, {in_the_middle} of them after the first and before the last result of a run")
