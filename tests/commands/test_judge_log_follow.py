"""``robbdd judge --follow``: clauses of a log that is still recorded are judged when their windows have closed."""

from __future__ import annotations

import os
import shutil
import subprocess
import threading
import time
from pathlib import Path

import pytest

from fork_kit import ROBBDD
from kit import EXAMPLES
from logs.bags import write
from logs.drives import ONE, clauses, drive, robbdd, verdicts
from logs.test_growing_mcap import in_chunks
from robbdd_tools.agent.judge_log import verdict_on
from robbdd_tools.agent.log_evidence import evidence_of
from robbdd_tools.agent.log_following import is_decided
from robbdd_tools.logs.growing_mcap import GrowingMcap
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.log_request import LogRequest
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.workbench.model import load_all
from robbdd_tools.workbench.plan import Plan, Selection

pytestmark = pytest.mark.physics
CHUNK = 4000


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shutil.copytree(EXAMPLES / "pickplace", tmp_path_factory.mktemp("follow") / "models")


@pytest.fixture(scope="module")
def spec(models: Path) -> ScenarioSpec:
    plan = Plan.of(load_all([models / "pickplace.bdd"]), Selection((), ONE[1]))
    (found,) = plan.scenarios
    return found


def recorded(folder: Path, **options: object) -> Path:
    """Write a drive as an MCAP file of small chunks."""
    messages = sorted(drive(**options), key=lambda one: one.received)  # pyright: ignore[reportArgumentType]
    (path,) = write(folder / "drive", messages, "mcap").glob("*.mcap")
    return in_chunks(path, folder, CHUNK)


@pytest.mark.parametrize("options", [{}, {"end": (0.55, 0.0, 0.825)}, {"lost": (7.0, 9.0)}])
def test_a_verdict_that_is_decided_early_is_that_of_the_whole_log(
    options: dict[str, object], spec: ScenarioSpec, tmp_path: Path
) -> None:
    whole = recorded(tmp_path, **options)
    request = LogRequest(str(whole))
    evidence = evidence_of(spec, read_log(whole), request).evidence
    final = {clause.line: verdict_on(clause, evidence, spec) for clause in spec.clauses}
    data, path = whole.read_bytes(), tmp_path / "growing.mcap"
    first: dict[int, float] = {}
    for share in range(1, 21):
        path.write_bytes(data[: len(data) * share // 20])
        log = GrowingMcap(path, {}, ())
        log.read()
        if log.empty:
            continue
        partial = evidence_of(spec, log.contents(), request).evidence
        for clause in spec.clauses:
            if is_decided(clause, spec, partial.trace):
                assert verdict_on(clause, partial, spec) == final[clause.line], (share, clause.sentence)
                first.setdefault(clause.line, partial.trace.end)
    by_name = {clause.name.rpartition(".")[2]: first.get(clause.line) for clause in spec.clauses}
    assert by_name["at-source"] is not None
    assert by_name["in-hand"] is not None
    assert by_name["at-goal"] is not None
    # The events are at 1 s, 3 s and 8 s, and messages may arrive up to a second late.
    assert 2.0 <= by_name["at-source"] < 4.0 <= by_name["in-hand"] < 9.0 <= by_name["at-goal"]
    if options.get("end"):
        assert Outcome.VIOLATED in {one.outcome for one in final.values()}


def grow(data: bytes, path: Path, stop: threading.Event) -> None:
    for part in range(20):
        with path.open("ab") as file:
            file.write(data[len(data) * part // 20 : len(data) * (part + 1) // 20])
        if stop.wait(0.1):
            return


def followed(models: Path, path: Path, data: bytes, *more: str) -> tuple[int, str, str]:
    path.write_bytes(b"")
    command = [*ROBBDD, "judge", str(path), "pickplace.bdd", "--no-store", *ONE, "--follow", "20", *more]
    stop = threading.Event()
    writer = threading.Thread(target=grow, args=(data, path, stop))
    writer.start()
    try:
        done = subprocess.run(command, capture_output=True, encoding="utf-8", cwd=models, env=os.environ)
    finally:
        stop.set()
        writer.join()
    return done.returncode, done.stdout, done.stderr


def test_a_log_is_judged_while_it_is_recorded(models: Path, tmp_path: Path) -> None:
    data = recorded(tmp_path).read_bytes()
    out = tmp_path / "log.json"
    code, shown, remarks = followed(models, tmp_path / "now.mcap", data, "--json", str(out))
    assert code == 0, remarks
    assert set(verdicts(clauses(out)).values()) == {"holds"}
    early, _, block = shown.partition("crit:part-to-bin")
    assert "✔ +25 mm: cube0 is located at table_ws before evt-pick-start" in early
    assert "cube0 is located at left_ws after evt-place-end" in block


def test_a_recording_that_stops_is_judged_after_a_silence(models: Path, tmp_path: Path) -> None:
    path = tmp_path / "now.mcap"
    path.write_bytes(recorded(tmp_path).read_bytes()[:-2000])
    begun = time.monotonic()
    done = robbdd(models, "judge", str(path), "pickplace.bdd", "--no-store", *ONE, "--follow", "1")
    assert time.monotonic() - begun >= 1.0
    assert "nothing was recorded for 1 s: the log is judged as far as it was written" in done.stderr
    assert (
        "the log does not report crit:evt-end, and its recording did not end: when it was is not known" in done.stderr
    )


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("table.csv", "cannot be followed: name the folder of a rosbag2, or an MCAP file"),
        ("empty.mcap", "has no message yet: start the recorder first, or wait longer (--follow SECONDS)"),
    ],
)
def test_what_cannot_be_followed_is_refused(name: str, words: str, models: Path, tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("time,event\n1,pick-start\n", encoding="utf-8")
    (tmp_path / "empty.mcap").write_bytes(b"")
    done = robbdd(models, "judge", str(tmp_path / name), "pickplace.bdd", "--no-store", *ONE, "--follow", "0.5")
    assert done.returncode == 2
    assert words in done.stderr
