"""Stored runs: their results as data, their traces as arrays."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.protocol.run_folder import trace_file
from robbdd_tools.run.store import FOLDER, LATEST, NoSuchRun, RunStore, StoredRun, store_beside
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
    """Return the stored runs of the project that contains a path, oldest first. ``store`` is another folder of runs.

    If the project has none, they are those of the only folder in ``path`` that has runs; raises ``NoSuchRun`` if
    several have.
    """
    return tuple(map(PastRun, kept_store(Path(path), store).runs()))


def find_run(
    word: str = LATEST, path: str | os.PathLike[str] = ".", *, store: str | os.PathLike[str] | None = None
) -> PastRun:
    """Return the stored run that ``word`` names by its number, by ``latest`` or by its folder.

    It is searched for where ``runs`` finds some. Raises ``NoSuchRun``.
    """
    return PastRun(kept_store(Path(path), store).find(word))


def store_at(path: Path, store: str | os.PathLike[str] | None) -> RunStore:
    """Return the store in the folder ``store`` or, without one, the store of the project that contains a path."""
    return store_beside(path) if store is None else RunStore(Path(store))


def kept_store(path: Path, store: str | os.PathLike[str] | None = None) -> RunStore:
    """Return the store whose runs are read from a path: as ``store_at`` or, if there is none, that of a folder in it.

    A model without a project keeps its runs in its own folder, while commands are often given in the folder above.
    Raises ``NoSuchRun`` if several folders have a store.
    """
    own = store_at(path, store)
    if store is not None or own.folder.is_dir():
        return own
    inner = sorted(folder for folder in path.glob(f"*/{FOLDER}") if folder.is_dir())
    if len(inner) > 1:
        places = ", ".join(folder.relative_to(path).parts[0] for folder in inner)
        raise NoSuchRun(f"there are no runs in {own.folder}, but in several folders: {places}; name one of them")
    return RunStore(inner[0]) if inner else own
