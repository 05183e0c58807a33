"""A disk that becomes full during a study: it ends with the reason, and can be resumed without a difference."""

from __future__ import annotations

import platform
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from campaign.dask_kit import dask_processes
from campaign.study_agents import QuickAgent
from campaign.study_exports import exported
from kit import fill_disk, small_disk
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.cli import main
from robbdd_tools.protocol.messages import LogLine, RunMessage
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler
from robbdd_tools.run.parcels import pack_prepared, pack_used
from robbdd_tools.workbench.deciding_versions import versions
from robbdd_tools.workbench.parts import Part, execute_part

AMPLE = 8192
"""KiB that are enough for the study."""


def finished(shown: str) -> int:
    return int(shown.removeprefix("fetching: ").partition(" of ")[0])


@pytest.mark.parametrize(
    ("kib", "place", "least"),
    [
        pytest.param(88, "batches/1/results.sqlite: ", 0, id="database of a batch"),
        pytest.param(100, "batches/1/results.sqlite: disk I/O error: the disk may be full", 0, id="its index"),
        pytest.param(160, "batches/1/", 0, id="files of a batch"),
        pytest.param(244, "results can no longer be stored: ", 1, id="an execution"),
        pytest.param(352, "results can no longer be stored: ", 16, id="a later batch"),
        pytest.param(388, "results can no longer be stored: ", 32, id="the end of the last batch"),
    ],
)
def test_a_study_on_a_full_disk_ends_with_the_reason_and_is_resumed_without_a_difference(
    study: Path, capsys: pytest.CaptureFixture[str], kib: int, place: str, least: int
) -> None:
    assert main(["study", "run", str(study)]) == 1
    shown, expected = capsys.readouterr().out, exported(study)
    store = Path(".robbdd")
    shutil.rmtree(store)
    store.mkdir()
    with small_disk(store, kib):
        assert main(["study", "run", str(study), "--jobs", "1"]) == 2
        reason = capsys.readouterr().err.splitlines()[-1]
        assert place in reason
        assert reason.endswith(f": continue with `robbdd study resume {study}`")
        assert main(["study", "status", str(study)]) == 0
        before = finished(capsys.readouterr().out)
        assert least <= before <= 40
        subprocess.run(["mount", "-o", f"remount,size={AMPLE}k", str(store)], check=True)
        assert main(["study", "resume", str(study)]) == 1
        assert capsys.readouterr().out == shown
        assert exported(study) == expected


def test_a_study_that_finds_no_room_for_its_database_is_not_begun(
    study: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = Path(".robbdd")
    store.mkdir()
    with small_disk(store, 64):
        assert main(["study", "run", str(study)]) == 2
        assert capsys.readouterr().err.endswith("study.sqlite: database or disk is full\n")
        subprocess.run(["mount", "-o", f"remount,size={AMPLE}k", str(store)], check=True)
        # The database exists, and has no study.
        assert main(["study", "resume", str(study)]) == 2
        assert main(["study", "status", str(study)]) == 2
        assert capsys.readouterr().err.endswith("the study has no results: `robbdd study run` begins it\n")
        assert main(["study", "run", str(study)]) == 1


class WarningAgent(QuickAgent):
    """Warns of each execution that its trace is lost."""

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        yield LogLine("warning", f"{spec.seed}: the trace is not kept: No space left on device")
        yield from super().executed(index, spec)


def test_warnings_of_agents_are_printed_but_not_thousands_of_them(
    study: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(scheduler, "Agent", WarningAgent)
    main(["study", "run", str(study)])
    printed = capsys.readouterr().err
    assert printed.count("the trace is not kept: No space left on device\n") == 10
    assert printed.count("robbdd: further warnings are not printed\n") == 1


def test_a_worker_whose_disk_is_full_refuses_a_part_with_the_reason_and_keeps_no_rest_of_it(
    study: Path, tmp_path: Path
) -> None:
    origin, there = tmp_path / "run", tmp_path / "worker"
    manifest = load_study(study).cells[0].plan.prepare(origin)
    used, prepared = pack_used(manifest, origin), pack_prepared(origin)
    part = Part(1, (0, 1), str(origin), versions(), 60.0)
    there.mkdir()
    with small_disk(there, 64):
        fill_disk(there / "filler")
        refused = execute_part(part, used, prepared, there, lambda: True)
        assert refused.refused.startswith("cannot execute the study: ")
        assert refused.refused.endswith("No space left on device")
        assert not refused.lines
        (there / "filler").unlink()
        subprocess.run(["mount", "-o", f"remount,size={AMPLE}k", str(there)], check=True)
        assert execute_part(part, used, prepared, there, lambda: True).lines
        assert [path.name for path in there.iterdir()] == ["files"]


def test_a_full_disk_of_a_worker_ends_the_study_with_its_name_and_costs_nothing(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    there = tmp_path / "dask"
    there.mkdir()
    monkeypatch.setenv("ROBBDD_WARNING", "the trace is not kept")
    with small_disk(there, AMPLE), dask_processes(there, 1) as dask:
        arguments = [str(study), "--scheduler", dask.address]
        assert main(["study", "run", *arguments]) == 1
        expected = exported(study)
        fill_disk(there / "filler")
        assert main(["study", "run", *arguments, "--restart"]) == 2
        printed = capsys.readouterr().err
        assert printed.count("the trace is not kept\n") == 10
        assert f"the worker on {platform.node()} cannot execute the study: {there}" in printed
        assert printed.endswith("No space left on device\n")
        (there / "filler").unlink()
        assert main(["study", "resume", *arguments]) == 1
        assert exported(study) == expected
