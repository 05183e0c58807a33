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
    """A run with a folder, either in progress or stored."""

    def __init__(self, place: StoredRun) -> None:
        self.place = place

    @property
    def number(self) -> int:
        """The number of the run in the project's store; 0 for a run in a separate folder."""
        return self.place.number

    @property
    def folder(self) -> Path:
        """The folder with features, manifest, logs and traces."""
        return self.place.folder

    @property
    @abstractmethod
    def results(self) -> tuple[ExecutionResult, ...]:
        """The results of all executions in the order of the manifest."""

    def rows(self) -> list[dict[str, Any]]:
        """Return one flat dictionary for each clause of each execution, for ``pandas.DataFrame(run.rows())``."""
        return rows_of(self.results)

    def trace(self, result: ExecutionResult | int) -> Trace:
        """Return the trace of an execution as arrays: times, positions, orientations and events.

        The execution is given by its result or by its index. Raises ``UnreadableTrace`` if no trace was kept.
        """
        from robbdd_tools.traces.mcap_file import read_trace

        index = result if isinstance(result, int) else result.index
        return read_trace(trace_file(self.folder, index)).trace


class PastRun(Recorded):
    """A stored run, finished or not. Its properties raise ``NoSuchRun`` if its folder is damaged."""

    @property
    def record(self) -> RunRecord:
        """The identity of the run: path of the model, digest of its graph, seed, versions of the tools."""
        return self.place.record()

    @property
    def status(self) -> RunStatus:
        """The progress of the run: state, number of executions, verdicts of the finished ones."""
        return self.place.status()

    @property
    def results(self) -> tuple[ExecutionResult, ...]:
        """The results of all executions in the order of the manifest. Unfinished executions are unknown."""
        return execution_results(self.place.results())


def runs(path: str | os.PathLike[str] = ".", *, store: str | os.PathLike[str] | None = None) -> tuple[PastRun, ...]:
    """Return the stored runs of the project that contains a path, oldest first. ``store`` is another folder of runs."""
    return tuple(map(PastRun, store_at(Path(path), store).runs()))


def find_run(
    word: str = LATEST, path: str | os.PathLike[str] = ".", *, store: str | os.PathLike[str] | None = None
) -> PastRun:
    """Return the stored run that ``word`` names by its number, by ``latest`` or by its folder. Raises ``NoSuchRun``."""
    return PastRun(store_at(Path(path), store).find(word))


def store_at(path: Path, store: str | os.PathLike[str] | None) -> RunStore:
    """Return the store in the folder ``store`` or, without one, the store of the project that contains a path."""
    return store_beside(path) if store is None else RunStore(Path(store))
