"""Studies on a Dask cluster of worker processes: results, refusals, kills and restarts."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from time import monotonic, sleep

import pytest

from campaign.dask_kit import dask_processes
from campaign.study_agents import STUDY, QuickAgent, write_study
from campaign.study_exports import exported
from robbdd_tools.base.isolation import NO_USER_CODE, WORKER_USER_CODE
from robbdd_tools.campaign import cluster
from robbdd_tools.campaign.cluster_study import FIRST, Pace
from robbdd_tools.campaign.study_file import load_study
from robbdd_tools.cli import main
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import ClauseJudged, RunMessage, ScenarioFinished, decode
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler
from robbdd_tools.run.parcels import Moved, Parcel, pack_prepared, pack_used, unpack
from robbdd_tools.workbench.deciding_versions import differences, versions
from robbdd_tools.workbench.parts import Part, execute_part

EXAMPLES = Path(__file__).parents[2] / "examples"
DRIVER = Path(__file__).with_name("study_agents.py")
LONG = STUDY.replace("repeat: 10", "repeat: 60").replace("batch: 8", "batch: 24")
"""240 executions in ten batches."""
PATIENCE = 600.0
"""Seconds that a test waits for a process, far more than a busy machine needs."""


def test_a_cluster_gives_the_results_of_one_machine_and_refuses_other_versions(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "run", str(study)]) == 1
    shown, expected = capsys.readouterr().out, exported(study)
    with dask_processes(tmp_path / "dask", 2) as dask:
        arguments = [str(study), "--scheduler", dask.address]
        with monkeypatch.context() as patched:
            patched.setattr(cluster, "versions", lambda: {**versions(), "mujoco": "0.1"})
            assert main(["study", "run", *arguments, "--restart"]) == 2
        assert f"has mujoco {versions()['mujoco']} instead of 0.1" in capsys.readouterr().err
        assert main(["study", "resume", *arguments]) == 1
        assert capsys.readouterr().out == shown
        assert exported(study) == expected
    assert main(["study", "run", *arguments, "--restart"]) == 2
    assert "there is no scheduler at" in capsys.readouterr().err


def test_versions_that_differ_are_named() -> None:
    assert list(differences(versions(), versions())) == []
    there = {**versions(), "numpy": "1.0", "Python": "2.7", "words-of-others": "3"}
    words = list(differences(versions(), there))
    assert words[0].startswith("Python 2.7 instead of 3.")
    assert words[1].startswith("numpy 1.0 instead of ")
    assert words[2] == "words-of-others 3 instead of none"


def prepared_part(folder: Path, example: str, origin: Path) -> tuple[Part, Parcel, Parcel]:
    """Prepare the first scenario of a copy of an example as a part, and remove the copy."""
    copy = folder / "mine"
    shutil.copytree(EXAMPLES / example, copy)
    (copy / "x.study").write_text('import "tidy.bddx"\nStudy s { first: 1 }\n', encoding="utf-8")
    plan = load_study(copy / "x.study").cells[0].plan
    manifest = plan.prepare(origin, repeat=1)
    used, prepared = pack_used(manifest, origin), pack_prepared(origin)
    shutil.rmtree(copy)
    return Part(1, (0,), str(origin), versions(), 60.0), used, prepared


@pytest.mark.physics
def test_a_worker_needs_nothing_but_the_package_and_runs_users_code_only_with_its_owners_consent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part, used, prepared = prepared_part(tmp_path, "external", tmp_path / "run")
    refused = execute_part(part, used, prepared, tmp_path / "worker", lambda: True)
    assert "a behaviour is the process 'python policy.py': its owner allows users' code by starting it with" in (
        refused.refused
    )
    assert str(tmp_path / "mine" / "tidy.bddx") in refused.refused
    assert str(tmp_path / "worker") not in refused.refused
    assert not refused.lines
    monkeypatch.setenv(NO_USER_CODE, "")
    monkeypatch.setenv(WORKER_USER_CODE, "allow")
    result = execute_part(part, used, prepared, tmp_path / "worker", lambda: True)
    messages = [decode(line) for line in result.lines]
    assert [one.verdict for one in messages if isinstance(one, ClauseJudged)] == ["holds"] * 4
    assert isinstance(messages[-1], ScenarioFinished)
    assert [path.name for path in (tmp_path / "worker").iterdir()] == ["files"]


def test_a_part_is_neither_executed_with_other_versions_nor_after_it_was_cancelled(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    origin = tmp_path / "run"
    manifest = load_study(study).cells[0].plan.prepare(origin)
    used, prepared = pack_used(manifest, origin), pack_prepared(origin)
    part = Part(1, (0, 1), str(origin), {**versions(), "mujoco": "0.1"}, 60.0)
    refused = execute_part(part, used, prepared, tmp_path / "worker", lambda: True)
    assert refused.refused == f"has mujoco {versions()['mujoco']} instead of 0.1"

    class Endless(QuickAgent):
        def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
            del spec
            sleep(0.2)
            self.execute(index)
            yield from ()

    monkeypatch.setattr(scheduler, "Agent", Endless)
    part = Part(1, (0, 1), str(origin), versions(), 60.0)
    ended = execute_part(part, used, prepared, tmp_path / "worker", lambda: False)
    assert ended.ending == "the run was cancelled"


def test_files_are_packed_with_equal_bytes_and_found_through_links_and_in_uris(tmp_path: Path) -> None:
    shutil.copytree(EXAMPLES / "ownrobot", tmp_path / "real place")
    (tmp_path / "link").symlink_to(tmp_path / "real place")
    weights, path = tmp_path / "link" / "weights.bin", tmp_path / "link" / "x.study"
    path.write_text('import "tidy.bddx"\nStudy s { first: 1 }\n', encoding="utf-8")
    folder = tmp_path / "run"
    manifest = load_study(path).cells[0].plan.prepare(folder)
    weights.write_bytes(b"\0\1")
    used = pack_used(manifest, folder, [weights])
    assert used == pack_used(manifest, folder, [weights])
    assert used.digest != pack_used(manifest, folder).digest
    root = unpack(used, tmp_path / "elsewhere")
    assert root == unpack(used, tmp_path / "elsewhere")
    found = root / tmp_path.relative_to(tmp_path.anchor)
    for place in ("link", "real place"):
        assert {"five.xml", "carrying.py", "weights.bin"} <= {path.name for path in (found / place).iterdir()}
    moved = Moved(unpack(pack_prepared(folder), tmp_path / "part"), root, str(folder), used.roots)
    moved.move_manifest()
    spec = read_manifest(moved.folder).scenarios[0]
    assert spec.execution is not None
    assert spec.execution.implementation.origin is not None
    file = Path(spec.execution.implementation.origin.file)
    assert file.is_relative_to(root)
    assert moved.restored(f"{file}: {moved.folder}/a") == f"{tmp_path}/link/tidy.bddx: {folder}/a"


def started(path: Path, command: str, address: str) -> subprocess.Popen[bytes]:
    environment = {**os.environ, "PYTHONPATH": str(DRIVER.parents[1])}
    arguments = [sys.executable, str(DRIVER), "study", command, path.name, "--scheduler", address]
    quiet = subprocess.DEVNULL
    return subprocess.Popen(arguments, cwd=path.parent, env=environment, stdout=quiet, stderr=quiet)


def until(condition: Callable[[], bool], seconds: float = PATIENCE) -> None:
    limit = monotonic() + seconds
    while not condition():
        assert monotonic() < limit
        sleep(0.05)


def finished(path: Path, capsys: pytest.CaptureFixture[str]) -> int:
    capsys.readouterr()
    if main(["study", "status", str(path)]) != 0:
        return 0
    return int(capsys.readouterr().out.split(":")[1].split()[0].replace(",", ""))


@pytest.mark.nightly
def test_killed_workers_and_schedulers_and_clients_cost_only_what_they_were_doing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole, hurt = write_study(tmp_path / "whole", LONG), write_study(tmp_path / "hurt", LONG)
    with dask_processes(tmp_path / "dask", 3, pause=0.05) as dask:
        assert started(whole, "run", dask.address).wait(PATIENCE) == 1
        study = started(hurt, "run", dask.address)
        until(lambda: finished(hurt, capsys) > 20)
        random.Random(1).choice(dask.workers).kill()
        until(lambda: finished(hurt, capsys) > 60)
        dask.scheduler.kill()
        dask.scheduler.wait()
        dask.scheduler = dask.start_scheduler()
        before = finished(hurt, capsys)
        assert before < 240
        # Workers end with their scheduler; whatever supervises them starts them again.
        for _ in range(2):
            dask.start_worker()
        until(lambda: finished(hurt, capsys) > before + 20)
        study.send_signal(signal.SIGKILL)
        study.wait()
        kept = finished(hurt, capsys)
        assert before + 20 < kept < 240
        assert started(hurt, "resume", dask.address).wait(PATIENCE) == 1
    assert exported(hurt) == exported(whole)


def test_parts_shrink_at_the_end_and_never_exceed_half_a_minute() -> None:
    pace = Pace()
    assert pace.size(1000, 4) == FIRST
    pace.add(20.0, 10)
    assert [pace.size(unsent, 4) for unsent in (10_000, 80, 8, 1)] == [15, 10, 5, 5]
    for _ in range(20):
        pace.add(0.1, 10)
    assert [pace.size(unsent, 4) for unsent in (100_000, 80)] == [3000, 1000]
