"""Stored runs: their results as data, their traces as arrays."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.store import LATEST, RunStore, StoredRun, store_beside
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_results, rows_of

if TYPE_CHECKING:
    from robbdd_tools.monitor.trace import Trace
    from robbdd_tools.run.store import RunRecord
    from robbdd_tools.run.stored_results import RunStatus


class Recorded(ABC):
    """A run with a folder: one in progress or a stored one."""

    def __init__(self, place: StoredRun) -> None:
        self.place = place

    @property
    def number(self) -> int:
        """The number in the project's store, 0 for a run in a separate folder."""
        return self.place.number

    @property
    def folder(self) -> Path:
        """The folder with features, manifest, logs and traces."""
        return self.place.folder

    @property
    @abstractmethod
    def results(self) -> tuple[ExecutionResult, ...]:
        """The results of all executions in the manifest's order."""

    def rows(self) -> list[dict[str, Any]]:
        """Return one flat dictionary per clause of each execution: ``pandas.DataFrame(run.rows())``."""
        return rows_of(self.results)

    def trace(self, result: ExecutionResult | int) -> Trace:
        """Return the trace of an execution (its result or index): times, positions, orientations and events as arrays.

        Raises ``UnreadableTrace`` if none was kept.
        """
        from robbdd_tools.traces.mcap_file import read_trace

        index = result if isinstance(result, int) else result.index
        return read_trace(trace_file(self.folder, index)).trace


class PastRun(Recorded):
    """A stored run, finished or not. Its properties raise ``NoSuchRun`` if its folder is damaged."""

    @property
    def record(self) -> RunRecord:
        """The record of the run: path, digest of the graph, seed, versions."""
        return self.place.record()

    @property
    def status(self) -> RunStatus:
        """The progress of the run: state, number of executions, verdicts of the finished ones."""
        return self.place.status()

    @property
    def results(self) -> tuple[ExecutionResult, ...]:
        """The results of all executions in the manifest's order; unfinished ones are unknown."""
        return execution_results(self.place.results())


def runs(path: str | os.PathLike[str] = ".", *, store: str | os.PathLike[str] | None = None) -> tuple[PastRun, ...]:
    """Return the stored runs of a path's project, oldest first; ``store`` is another folder of runs."""
    return tuple(map(PastRun, store_at(Path(path), store).runs()))


def find_run(
    word: str = LATEST, path: str | os.PathLike[str] = ".", *, store: str | os.PathLike[str] | None = None
) -> PastRun:
    """Return a stored run by number, ``latest`` or folder; raises ``NoSuchRun``."""
    return PastRun(store_at(Path(path), store).find(word))


def store_at(path: Path, store: str | os.PathLike[str] | None) -> RunStore:
    """Return the store of a path's project, or the one in the folder ``store``."""
    return store_beside(path) if store is None else RunStore(Path(store))
