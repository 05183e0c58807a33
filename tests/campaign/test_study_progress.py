"""The progress of a study, and its end by Ctrl-C."""

from __future__ import annotations

import os
import re
import signal
import sys
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from time import monotonic, sleep

import pytest
from rich.console import Console

from campaign.study_agents import QuickAgent
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.campaign.study_progress import StudyProgress
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.cli import main
from robbdd_tools.commands.study_display import StudyDisplay
from robbdd_tools.protocol.messages import RunMessage
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler
from robbdd_tools.run.run_policy import Policy

INTERRUPTED_AT = 6
"""The execution, counted from 1, in which Ctrl-C is pressed: the second batch is in progress after the eighth."""
DRAWN_AT = 20
"""The number of finished executions at which the progress is looked at; some of them are violated."""
SLOW = 5.0
"""Seconds that the interrupted execution takes."""


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Let Ctrl-C reach this process, even if it was started in the background, where shells ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


class InterruptedAgent(QuickAgent):
    """Sends SIGINT to its own process in one execution, ``presses`` times, and finishes that execution later."""

    presses = 1
    seconds = 0.3

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        for message in super().executed(index, spec):
            yield message
            if index == INTERRUPTED_AT - 1 and message.__class__.__name__ == "ScenarioStarted":
                for _ in range(self.presses):
                    os.kill(os.getpid(), signal.SIGINT)
                    sleep(0.1)
                sleep(self.seconds)


def test_without_stored_runs_the_time_is_stated_after_the_first_executions(
    study: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["study", "run", str(study), "--jobs", "3"])
    first, second = capsys.readouterr().err.splitlines()
    assert first.endswith(
        " 40 executions, 5 batches (no stored run has their time: it is stated after the first executions)"
    )
    stated = r"robbdd: (\d+) executions, about \d+ (?:s|min) left, measured on the first (\d+) executions"
    assert re.findall(stated, second) == [("36", "4")]
    main(["study", "run", str(study), "--restart", "--jobs", "7"])
    assert re.findall(stated, capsys.readouterr().err) == [("33", "7")]


@pytest.mark.usefixtures("interruptible")
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for a single process")
def test_the_first_ctrl_c_finishes_the_executions_in_progress(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "run", str(study)]) == 1
    assert main(["study", "export", str(study), "-o", "whole.csv"]) == 0
    with monkeypatch.context() as patched:
        patched.setattr(scheduler, "Agent", InterruptedAgent)
        assert main(["study", "run", str(study), "--restart", "--jobs", "1"]) == 128 + signal.SIGINT
    assert "the study was interrupted: continue with `robbdd study resume x.study`" in capsys.readouterr().err
    assert main(["study", "status", str(study)]) == 0
    assert capsys.readouterr().out.startswith(f"fetching: {INTERRUPTED_AT} of 40 executions, not in progress")
    assert main(["study", "resume", str(study)]) == 1
    assert main(["study", "export", str(study), "-o", "resumed.csv"]) == 0
    assert Path("resumed.csv").read_bytes() == Path("whole.csv").read_bytes()


@pytest.mark.usefixtures("interruptible")
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for a single process")
def test_the_second_ctrl_c_ends_them(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(scheduler, "Agent", InterruptedAgent)
    monkeypatch.setattr(InterruptedAgent, "presses", 2)
    monkeypatch.setattr(InterruptedAgent, "seconds", SLOW)
    began = monotonic()
    assert main(["study", "run", str(study), "--jobs", "1"]) == 128 + signal.SIGINT
    assert monotonic() - began < SLOW
    capsys.readouterr()
    assert main(["study", "status", str(study)]) == 0
    assert capsys.readouterr().out.startswith(f"fetching: {INTERRUPTED_AT - 1} of 40 executions, not in progress")


def drawn(display: StudyDisplay) -> str:
    console = Console(file=StringIO(), width=100, force_terminal=True, color_system=None)
    with console.capture() as captured:
        console.print(display.drawn())
    return captured.get()


def test_a_terminal_shows_counts_rate_verdicts_and_workers(study: Path) -> None:
    with StudyRun(load_study(study), study_folder(study), Policy(1), resumed=False) as run:
        display, shown = StudyDisplay(run), ""
        assert "0 of 40 executions" in drawn(display)
        for progress in run.progress():
            if progress.finished == DRAWN_AT:
                display.update(progress)
                shown = drawn(display)
                display.note("ending")
                assert drawn(display).rstrip().endswith("ending")
                break
        run.cancel("enough")
    counts, rate, worst, *workers = shown.splitlines()
    assert f"{DRAWN_AT} of 40 executions, " in counts
    assert " per second, about " in counts
    assert rate.startswith("all executions: ")
    assert f" of {DRAWN_AT} hold (" in rate
    assert "95 % interval" in rate
    assert worst.startswith("worst clause: on-bench, ")
    assert [one.partition(":")[0].strip() for one in workers] in ([], ["process 1"])


def test_progress_is_counted_within_a_batch(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[tuple[int, int]] = []
    whole = StudyRun.progress

    def progress(self: StudyRun) -> Iterator[StudyProgress]:
        for one in whole(self):
            seen.append((one.finished, one.tally.holding))
            yield one

    monkeypatch.setattr(StudyRun, "progress", progress)
    assert main(["study", "run", str(study), "--jobs", "1"]) == 1
    assert [finished for finished, _ in seen] == list(range(1, 41))
    assert 0 < seen[5][1] <= 6
    assert seen[-1][1] > 20


def _files(folder: Path) -> dict[str, bytes]:
    """Return the contents of the files in a folder but those that SQLite needs to read."""
    files = (path for path in folder.iterdir() if path.is_file() and not path.name.endswith(("-wal", "-shm")))
    return {path.name: path.read_bytes() for path in files}


def test_reading_changes_nothing_in_the_folder(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["study", "run", str(study)])
    folder = study_folder(study)
    (folder / ".gitignore").unlink()
    before = _files(folder)
    for words in (["status"], ["show"], ["export", "-o", "x.csv"], ["outcomes"]):
        assert main(["study", words[0], str(study), *words[1:]]) == 0
    assert _files(folder) == before
    capsys.readouterr()
