"""The duration of a run is estimated from stored executions of the same variants."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.run.database import NAME, open_database, transaction
from robbdd_tools.run.execution_times import NEWEST, Duration, usual_durations
from robbdd_tools.run.store import project_root
from robbdd_tools.workbench.model import load
from robbdd_tools.workbench.time_estimate import TimeEstimate, estimate_from

VARIANT = "https://example.org/robbdd/criteria/part-to-bin"


Store = Callable[[list[tuple[str, float]]], Path]
_RUN = "INSERT INTO run VALUES (1, 'finished', '', 0, '', '', '', 1, '', '', 0, 0, 1, '', '2026-01-01', NULL)"
_EXECUTION = """INSERT INTO execution
    (run, idx, key, story, variant, variation, repetition, seed, verdict, simulated, resampled, wall, stepping, host,
        ended)
    VALUES (1, ?, '', '', ?, 1, 1, 1, '', 0, 0, ?, 0, '', '')"""


@pytest.fixture
def store(tmp_path: Path) -> Store:
    """Stores executions, given by their variants and wall times in s; returns the database."""

    def write(executions: list[tuple[str, float]]) -> Path:
        rows = [(index, variant, wall) for index, (variant, wall) in enumerate(executions)]
        path = tmp_path / ".robbdd" / NAME
        path.parent.mkdir()
        with closing(open_database(path)) as database, transaction(database):
            database.execute(_RUN)
            database.executemany(_EXECUTION, rows)
        return path

    return write


def test_the_newest_executions_count_by_their_median(store: Store) -> None:
    old = [("v", 100.0)] * NEWEST
    new = [("v", 1.0), ("w", 5.0), ("v", 2.0), ("v", 9.0)] * NEWEST
    assert usual_durations(store(old + new), ["v", "w", "x"]) == {
        "v": Duration(2.0, NEWEST),
        "w": Duration(5.0, NEWEST),
    }


def test_without_a_database_nothing_is_known(tmp_path: Path) -> None:
    assert usual_durations(tmp_path / NAME, ["v"]) == {}


def test_processes_share_the_work_and_new_variants_take_the_average() -> None:
    known = {"v": Duration(2.0, 3), "w": Duration(4.0, 5)}
    assert estimate_from({"v": 10, "w": 10}, known, 2) == TimeEstimate(20, 30.0, 8)
    assert estimate_from({"v": 10, "w": 10, "x": 20}, known, 2) == TimeEstimate(40, 60.0, 8)
    assert estimate_from({"v": 1}, {"v": Duration(2.0, 3)}, 8) == TimeEstimate(1, 2.0, 3), (
        "one execution uses one process"
    )
    assert estimate_from({"x": 5}, {}, 2) == TimeEstimate(5, None, 0)


@pytest.mark.parametrize(
    ("seconds", "words", "large"),
    [
        (None, "1,680 executions", False),
        (0.2, "1,680 executions, about 1 s", False),
        (59.0, "1,680 executions, about 59 s", False),
        (60.0, "1,680 executions, about 1 min", True),
        (5900.0, "1,680 executions, about 98 min", True),
        (6000.0, "1,680 executions, about 2 h", True),
    ],
)
def test_an_estimate_reads_as_a_rounded_time(seconds: float | None, words: str, *, large: bool) -> None:
    found = TimeEstimate(1680, seconds, 1)
    assert (str(found), found.is_large) == (words, large)
    assert found.basis == "estimated from 1 stored execution"


def test_a_plan_reads_the_store_of_its_project(tmp_path: Path, store: Store) -> None:
    store([(VARIANT, 30.0)])
    for name in ("pickplace.bdd", "bench.scene"):
        (tmp_path / name).write_bytes((EXAMPLES / "pickplace" / name).read_bytes())
    (tmp_path / "robbdd.toml").touch()
    assert project_root(tmp_path / "pickplace.bdd") == tmp_path
    plan = load(tmp_path / "pickplace.bdd").scenarios()
    assert plan.estimate(jobs=2, repeat=3) == TimeEstimate(12, 180.0, 1)
