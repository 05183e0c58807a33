"""Traces that a study keeps: which ones, up to which size, after which interruptions, and their removal."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from campaign.study_agents import STUDY, QuickAgent, write_study
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.campaign.study_place import study_folder
from robbdd_tools.campaign.study_run import StudyRun
from robbdd_tools.cli import main
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import RunMessage
from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler
from robbdd_tools.run.parcels import pack_prepared, pack_used
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.workbench.deciding_versions import versions
from robbdd_tools.workbench.parts import Part, execute_part

SIZE = 300_000
"""Bytes of a trace: three of them fit into 1 MB."""


class RecordingAgent(QuickAgent):
    """An agent that writes a trace of its seed, if traces are wanted."""

    def __init__(self, folder: Path, number: int, **options: Any) -> None:
        super().__init__(folder, number, **options)
        self._folder = folder
        self._traces = read_manifest(folder).traces

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        if self._traces:
            path = trace_file(self._folder, index)
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content(spec.seed))
        yield from super().executed(index, spec)


def content(seed: int) -> bytes:
    return str(seed).encode().ljust(SIZE)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(scheduler, "Agent", RecordingAgent)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def study(folder: Path, traces: str) -> Path:
    text = STUDY.replace("seed: 3", f"seed: 3 {traces}")
    return write_study(folder, text).relative_to(folder)


def kept(path: Path) -> dict[int, bytes]:
    return {int(one.stem): one.read_bytes() for one in (study_folder(path) / "traces").glob("*.mcap")}


def executions(path: Path) -> dict[int, tuple[str, int]]:
    """Return verdict and seed of each execution by its number."""
    assert main(["study", "export", str(path), "-o", "x.csv"]) == 0
    rows = csv.DictReader(Path("x.csv").read_text(encoding="utf-8").splitlines())
    return {int(row["number"]): (row["scenario_verdict"], int(row["seed"])) for row in rows}


def test_traces_of_failures_are_kept_and_removed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = study(folder, "traces: failures 100 MB")
    assert main(["study", "run", str(path)]) == 1
    failed = {number: seed for number, (verdict, seed) in executions(path).items() if verdict != "holds"}
    assert len(failed) > 3
    assert kept(path) == {number: content(seed) for number, seed in failed.items()}
    capsys.readouterr()
    main(["study", "status", str(path)])
    assert f"{len(failed)} traces: {len(failed) * SIZE / 1e6:.1f} MB" in capsys.readouterr().out
    assert main(["study", "replay", str(path), str(min(failed))]) == 0
    assert main(["study", "clean", str(path), "--passed"]) == 0
    assert kept(path).keys() == failed.keys()
    capsys.readouterr()
    assert main(["study", "clean", str(path)]) == 0
    assert capsys.readouterr().out.startswith(f"removed {len(failed)} traces and 1 run: ")
    assert not kept(path)
    assert len(executions(path)) == 40
    assert main(["study", "clean", str(path), "--all"]) == 0
    assert main(["study", "status", str(path)]) == 2
    assert main(["study", "run", str(path)]) == 1


def test_a_limit_keeps_failures_first_however_often_the_study_is_interrupted(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = study(folder, "traces: all 2 MB")
    assert main(["study", "run", str(path), "--jobs", "1"]) == 1
    known, whole = executions(path), kept(path)
    failed = [number for number, (verdict, _) in known.items() if verdict != "holds"]
    held = [number for number, (verdict, _) in known.items() if verdict == "holds"]
    assert sorted(whole) == sorted([*failed, *held][: 2_000_000 // SIZE])
    progress = StudyRun.progress
    with monkeypatch.context() as patched:

        def interrupted(self: StudyRun) -> Iterator[Any]:
            for one in progress(self):
                if one.finished in (5, 19):
                    self.cancel("the study was interrupted")
                yield one

        patched.setattr(StudyRun, "progress", interrupted)
        assert main(["study", "run", str(path), "--restart", "--jobs", "1"]) == 2
        assert main(["study", "resume", str(path), "--jobs", "1"]) == 2
    assert main(["study", "resume", str(path), "--jobs", "1"]) == 1
    assert kept(path) == whole


def test_traces_survive_an_end_between_results_and_traces(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = study(folder, "traces: failures 100 MB")
    assert main(["study", "run", str(path), "--jobs", "1"]) == 1
    whole = kept(path)

    def end(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched, suppress(KeyboardInterrupt):
        patched.setattr("robbdd_tools.campaign.study_run.keep_traces", end)
        main(["study", "run", str(path), "--restart", "--jobs", "1"])
    assert main(["study", "resume", str(path), "--jobs", "1"]) == 1
    assert kept(path) == whole


def test_without_the_setting_nothing_is_recorded(folder: Path) -> None:
    path = study(folder, "traces: failures 100 MB")
    assert main(["study", "run", str(path)]) == 1
    assert kept(path)
    path = study(folder, "")
    assert main(["study", "run", str(path), "--restart"]) == 1
    assert not kept(path)


def test_a_worker_returns_wanted_traces(folder: Path) -> None:
    path = study(folder, "traces: failures 100 MB")
    path.write_text(path.read_text(encoding="utf-8").replace("batch: 8", "batch: 40"), encoding="utf-8")
    loaded = load_study(path)
    with StudyRun(loaded, study_folder(path), Policy(1), resumed=False) as run:
        prepared = run.batches[0].plan().prepare(folder / "prepared", repeat=loaded.repeat, traces=True)
    parcels = pack_used(prepared, folder / "prepared"), pack_prepared(folder / "prepared")
    for traces in ("", "failures", "all"):
        part = Part(1, tuple(range(40)), str(folder / "prepared"), versions(), 0.0, traces)
        found = execute_part(part, *parcels, folder / "worker", lambda: True).traces
        failing = {one for one in range(40) if prepared.scenarios[one].seed % 1000 <= 200}
        expected: set[int] = {"": set[int](), "failures": failing, "all": set(range(40))}[traces]
        assert 0 < len(failing) < 40
        assert found == {one: content(prepared.scenarios[one].seed) for one in expected}
