"""Remove everything but the results from a study's folder: traces, runs of replayed executions, leftover batches."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

from robbdd_tools.base.locks import acquire
from robbdd_tools.campaign.study_place import BATCHES, RUNS, StudyProblem, has_results, open_results
from robbdd_tools.campaign.study_traces import remove_traces, traces_in
from robbdd_tools.run.store import LOCK


@dataclass(frozen=True, slots=True)
class Cleaned:
    """The number of removed traces and runs, and the freed size in bytes."""

    traces: int
    runs: int
    size: int


def clean(folder: Path, *, failures_stay: bool = False, everything: bool = False) -> Cleaned:
    """Remove traces and runs of a study, and folders of batches whose results are already in its store.

    With ``failures_stay``, the traces of failures and the runs are kept. With ``everything``, the results are removed,
    too. Raises ``StudyProblem`` if there are no results or a process executes the study, ``DatabaseProblem`` and
    ``OSError``.
    """
    if not has_results(folder):
        raise StudyProblem("the study has no results: there is nothing to remove")
    lock = acquire(folder / LOCK)
    if lock is None:
        raise StudyProblem("another process executes this study: wait for it, or end it first")
    try:
        before = _size(folder)
        runs = sum(one.is_dir() for one in (folder / RUNS).glob("*"))
        count = len(traces_in(folder))
        if everything:
            for part in folder.iterdir():
                if part.name != LOCK:
                    shutil.rmtree(part) if part.is_dir() else part.unlink()
            return Cleaned(count, runs, before - _size(folder))
        with open_results(folder) as store:
            traces = traces_in(folder)
            removed = [*traces.keys() - store.failing(traces)] if failures_stay else [*traces]
            done = store.batches()
        remove_traces(folder, removed)
        if not failures_stay:
            shutil.rmtree(folder / RUNS, ignore_errors=True)
        for number in done:
            shutil.rmtree(folder / BATCHES / str(number), ignore_errors=True)
        return Cleaned(len(removed), 0 if failures_stay else runs, before - _size(folder))
    finally:
        lock.release()


def kept_sizes(folder: Path) -> tuple[int, int]:
    """Return the number of traces of a study, and their size in bytes."""
    found = traces_in(folder)
    return len(found), sum(found.values())


def _size(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
