"""Studies that are executed, killed, continued: results, refusals, exit codes."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from time import sleep

import duckdb
import pytest

from campaign.study_agents import QuickAgent, write_study
from campaign.study_exports import exported
from robbdd_tools import __version__
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.campaign.study_progress import StudyProgress
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.cli import main
from robbdd_tools.protocol.messages import RunMessage, ScenarioStarted
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler
from robbdd_tools.run.study_schema import NAME

DRIVER = Path(__file__).with_name("study_agents.py")
COUNT = 40
"""Executions of ``STUDY``."""


def stop_after(monkeypatch: pytest.MonkeyPatch, executions: int) -> None:
    """Cancel the next study after some executions, as Ctrl-C does."""
    whole = StudyRun.progress

    def progress(self: StudyRun) -> Iterator[StudyProgress]:
        for one in whole(self):
            if one.finished >= executions:
                self.cancel("the study was interrupted")
            yield one

    monkeypatch.setattr(StudyRun, "progress", progress)


def test_a_study_executes_everything_and_prints_rates(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "run", str(study)]) == 1
    printed = capsys.readouterr()
    assert printed.err.startswith("robbdd: fetching: 40 executions, 5 batches")
    rows = list(csv.DictReader(exported(study).decode().splitlines()))
    seeds = {row["seed"]: row["scenario_verdict"] for row in rows}
    assert len(seeds) == COUNT
    expected = Counter("holds" if int(seed) % 1000 > 200 else "violated" for seed in seeds)
    assert Counter(seeds.values()) == expected
    first, *others = printed.out.splitlines()
    assert first.startswith(f"all executions: {expected['holds']} of 40 hold (")
    assert sum(line.startswith(("  part = ", "  goal = ")) for line in others) == 4
    assert f"in-tray: {expected['holds']} of 40 hold, {expected['violated']} violated, 0 unknown" in printed.out
    assert not list((study_folder(study) / "batches").iterdir())


def test_parquet_and_duckdb_have_the_rows_of_the_csv_with_types(study: Path) -> None:
    main(["study", "run", str(study)])
    expected = list(csv.DictReader(exported(study).decode().splitlines()))
    for name in ("x.parquet", "again.parquet", "x.duckdb"):
        assert main(["study", "export", str(study), "-o", name]) == 0
    assert Path("x.parquet").read_bytes() == Path("again.parquet").read_bytes()
    with duckdb.connect("x.duckdb", read_only=True) as database:
        found = database.execute("SELECT * FROM clauses").fetchall()
        assert found == database.execute("SELECT * FROM 'x.parquet'").fetchall()
        names = [column[0] for column in database.description or ()]
        facts = dict(database.execute("SELECT name, content FROM facts").fetchall())
    rows = [dict(zip(names, row, strict=True)) for row in found]
    assert facts["version"] == __version__
    assert [row["seed"] for row in rows] == [int(row["seed"]) for row in expected]
    assert [row["margin"] for row in rows] == [float(row["margin"]) for row in expected]
    assert [row["reason"] for row in rows] == [row["reason"] for row in expected]
    assert {"", "it moved"} == {row["reason"] for row in rows}


def test_an_interrupted_study_is_resumed_with_the_same_bytes(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["study", "run", str(study)])
    expected = exported(study)
    assert len(expected.splitlines()) > COUNT
    with monkeypatch.context() as patched:
        stop_after(patched, 19)
        assert main(["study", "run", str(study), "--restart", "--jobs", "1"]) == 2
    assert "continue with `robbdd study resume x.study`" in capsys.readouterr().err
    main(["study", "status", str(study)])
    status, *others = capsys.readouterr().out.splitlines()
    finished = int(status.split()[1])
    assert 19 <= finished < COUNT
    assert status == f"fetching: {finished} of 40 executions, not in progress"
    stored, worst = others
    rows = csv.DictReader(expected.decode().splitlines())
    violated = sum(row["scenario_verdict"] == "violated" for row in [*rows][: finished * 3 : 3])
    assert violated
    assert stored.startswith(f"all executions: {finished - violated} of {finished} hold (")
    assert worst == f"worst clause: on-bench, {violated} violated and 0 unknown of {finished}"
    assert main(["study", "resume", str(study)]) == 1
    assert exported(study) == expected


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_killed_study_loses_only_what_it_was_executing(tmp_path: Path) -> None:
    whole, killed = write_study(tmp_path / "whole"), write_study(tmp_path / "killed")
    begun = tmp_path / "begun"

    def start(path: Path, command: str) -> subprocess.Popen[bytes]:
        environment = {**os.environ, "PYTHONPATH": str(DRIVER.parents[1]), "ROBBDD_BEGUN": str(begun)}
        arguments = [sys.executable, str(DRIVER), "study", command, path.name, "--jobs", "2"]
        quiet = subprocess.DEVNULL
        return subprocess.Popen(arguments, cwd=path.parent, env=environment, stdout=quiet, stderr=quiet)

    def begun_seeds() -> Counter[str]:
        return Counter(begun.read_text(encoding="utf-8").split()) if begun.exists() else Counter()

    assert start(whole, "run").wait() == 1
    assert begun_seeds().total() == COUNT
    begun.unlink()
    for number, command in enumerate(("run", "resume"), start=1):
        process = start(killed, command)
        while begun_seeds().total() < 13 * number and process.poll() is None:
            sleep(0.005)
        process.kill()
        process.wait()
    assert start(killed, "resume").wait() == 1
    again = begun_seeds()
    assert len(again) == COUNT
    assert again.total() - COUNT <= 2 * 2, "more was executed again than both agents were executing at each kill"
    assert exported(killed) == exported(whole)


def test_a_study_is_neither_begun_twice_nor_resumed_before_it_began(
    study: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "resume", str(study)]) == 2
    assert "never begun: `robbdd study run` begins it" in capsys.readouterr().err
    assert main(["study", "run", str(study)]) == 1
    assert main(["study", "run", str(study)]) == 2
    assert "has 40 of 40 executions: continue it with `robbdd study resume`" in capsys.readouterr().err
    assert main(["study", "resume", str(study)]) == 1


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [("x.study", "seed: 3", "seed: 4"), ("m.bdd", "0.5 seconds after", "0.6 seconds after")],
)
def test_a_changed_study_is_not_continued(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str, old: str, new: str
) -> None:
    with monkeypatch.context() as patched:
        stop_after(patched, 20)
        main(["study", "run", str(study)])
    text = Path(name).read_text(encoding="utf-8")
    assert old in text
    Path(name).write_text(text.replace(old, new), encoding="utf-8")
    assert main(["study", "resume", str(study)]) == 2
    assert "was changed since it began: undo that, or start it again with --restart" in capsys.readouterr().err
    Path(name).write_text(text, encoding="utf-8")
    assert main(["study", "resume", str(study)]) == 1


def test_changed_steps_and_another_simulator_are_not_mixed_with_earlier_results(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with monkeypatch.context() as patched:
        stop_after(patched, 9)
        main(["study", "run", str(study), "--jobs", "1"])
    (batch,) = (study_folder(study) / "batches").iterdir()
    steps = Path("steps/m_steps.py")
    steps.parent.mkdir()
    for path in sorted(batch.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    steps.write_text("# another one\n", encoding="utf-8")
    assert main(["study", "resume", str(study)]) == 2
    assert "model_steps.py changed since the study began" in capsys.readouterr().err
    steps.unlink()
    monkeypatch.setattr(QuickAgent, "simulator", "another")
    assert main(["study", "resume", str(study)]) == 2
    assert "another" in capsys.readouterr().err


def test_a_damaged_open_batch_is_executed_again(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    main(["study", "run", str(study)])
    expected = exported(study)
    with monkeypatch.context() as patched:
        stop_after(patched, 20)
        main(["study", "run", str(study), "--restart", "--jobs", "1"])
    (batch,) = (study_folder(study) / "batches").iterdir()
    (batch / "run.json").unlink()
    assert main(["study", "resume", str(study)]) == 1
    assert exported(study) == expected


def test_two_processes_do_not_execute_one_study(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from robbdd_tools.campaign.study_file import load_study
    from robbdd_tools.run.run_policy import Policy

    with StudyRun(load_study(study), study_folder(study), Policy(1), resumed=False):
        assert main(["study", "resume", str(study)]) == 2
        assert main(["study", "run", str(study), "--restart"]) == 2
        assert main(["study", "status", str(study)]) == 0
    shown = capsys.readouterr()
    assert shown.err.count("another process executes this study") == 2
    assert shown.out == "fetching: 0 of 40 executions, in progress\n"


def test_a_study_without_results_has_nothing_to_show(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (["status", str(study)], ["show", str(study)], ["export", str(study), "-o", "x.csv"]):
        assert main(["study", *arguments]) == 2
    assert capsys.readouterr().err.count("the study has no results") == 3
    assert not study_folder(study).joinpath(NAME).exists()


class DyingAgent(QuickAgent):
    """An agent whose process ends at the executions whose seed is divisible by 7."""

    @property
    def crash(self) -> DyingAgent:
        return self

    def fault(self, *_: object) -> None:
        """Return no error in users' code."""

    def ending(self) -> str:
        return "the agent crashed"

    def exit(self) -> str:
        return "code 7"

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        if spec.seed % 7 == 0:
            yield ScenarioStarted(index)
            raise EOFError
        yield from super().executed(index, spec)

    def messages(self) -> Iterator[RunMessage]:
        with suppress(EOFError):
            yield from super().messages()


def test_an_execution_that_ends_its_process_is_lost_alone(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduler, "Agent", DyingAgent)
    assert main(["study", "run", str(study)]) == 1
    rows = list(csv.DictReader(exported(study).decode().splitlines()))
    unknown = {row["seed"] for row in rows if row["scenario_verdict"] == "unknown"}
    assert unknown == {row["seed"] for row in rows if int(row["seed"]) % 7 == 0} != set()
    assert {"the agent crashed" in row["reason"] for row in rows if row["seed"] in unknown} == {True}
    assert len({row["seed"] for row in rows}) == COUNT
