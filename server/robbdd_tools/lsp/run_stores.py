"""Store the runs of the editor in their projects or, if that fails, in a temporary folder of the server."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from threading import Lock

from robbdd_tools.base.files import file_state, path_to_uri, uri_to_path
from robbdd_tools.run.clause_history import ClauseRun, clause_history
from robbdd_tools.run.database import LOG
from robbdd_tools.run.execution_times import Duration, usual_durations
from robbdd_tools.run.json_documents import traced_variants
from robbdd_tools.run.store import NoSuchRun, RunStore, StoredRun, project_root, store_beside
from robbdd_tools.workbench.time_estimate import TimeEstimate, estimate_from

MAX_HISTORIES = 200
"""Number of clauses whose history is kept in memory."""


class Stores:
    """The stores of runs in the projects of one server."""

    def __init__(self) -> None:
        self._own: dict[Path | None, RunStore] = {}
        self._folder: Path | None = None
        self._lock = Lock()
        self._histories: dict[tuple[Path, str], tuple[object, list[ClauseRun]]] = {}
        self._durations: dict[Path, tuple[object, dict[str, Duration | None]]] = {}
        self._traced: dict[Path, tuple[tuple[str, int], frozenset[str]]] = {}

    def of(self, uri: str) -> RunStore:
        """Return the store of a document's project."""
        path = uri_to_path(uri)
        own = self._own.get(None if path is None else project_root(path))
        if own is not None:
            return own
        return self._made(None) if path is None else store_beside(path)

    def keeps_elsewhere(self, project: Path) -> bool:
        """Return whether the runs of a project are in a temporary folder, because its own store cannot be written."""
        return project in self._own

    def replayable(self, uri: str) -> frozenset[str]:
        """Return the IRIs of the variants that have a replayable run in the store of a document.

        A run is read again only if its results have changed.
        """
        return frozenset[str]().union(*map(self._traced_in, self.of(uri).runs()))

    def history(self, uri: str, clause: str) -> list[ClauseRun]:
        """Return the runs in the store of a document that judged a clause, oldest first. Raises ``DatabaseProblem``.

        The database is read again only if it has changed.
        """
        database = self.of(uri).database
        now = _state(database)
        known = self._histories.get((database, clause))
        if known is None or known[0] != now:
            if len(self._histories) >= MAX_HISTORIES:
                self._histories.clear()
            known = self._histories[database, clause] = (now, clause_history(database, clause))
        return known[1]

    def estimate(self, uri: str, counts: Mapping[str, int]) -> TimeEstimate:
        """Estimate how long a number of executions of each variant takes on all cores. Raises ``DatabaseProblem``.

        The database is read again only if it has changed.
        """
        database = self.of(uri).database
        now = _state(database)
        if database not in self._durations or self._durations[database][0] != now:
            self._durations[database] = (now, {})
        durations = self._durations[database][1]
        missing = [variant for variant in counts if variant not in durations]
        if missing:
            found = usual_durations(database, missing)
            durations.update((variant, found.get(variant)) for variant in missing)
        return estimate_from(counts, {iri: known for iri in counts if (known := durations[iri])})

    def _traced_in(self, run: StoredRun) -> frozenset[str]:
        try:
            status = run.status()
        except NoSuchRun:
            return frozenset()
        if not run.folder.is_dir():
            return frozenset()
        now = (status.state, status.finished)
        known = self._traced.get(run.folder)
        if known is None or known[0] != now:
            known = self._traced[run.folder] = (now, traced_variants(run))
        return known[1]

    def begin(self, uri: str) -> tuple[StoredRun, str]:
        """Create the folder of a new run, and return it with a note for the user.

        If the store cannot be written, a temporary folder is used, and the note says that the run is lost when the
        server ends. Raises ``OSError`` if the temporary folder cannot be written either.
        """
        path = uri_to_path(uri)
        store = self.of(uri)
        if path is None:
            return store.begin(), ""
        try:
            run = store.begin()
            return run, run.remark
        except OSError as error:
            own = self._made(project_root(path))
            why = f"{store.folder} cannot be written ({error.strerror or error})"
            return own.begin(), f"this run is kept in {own.folder} until the server ends: {why}"

    def close(self) -> None:
        """Remove the temporary folder of the server."""
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)

    def _made(self, root: Path | None) -> RunStore:
        with self._lock:
            if root not in self._own:
                self._folder = self._folder or Path(tempfile.mkdtemp(prefix="robbdd-"))
                self._own[root] = RunStore(self._folder / str(len(self._own) + 1))
            return self._own[root]


def _state(database: Path) -> object:
    """Return a value that changes whenever the database changes."""
    files = (database, database.with_name(database.name + LOG))
    return tuple(file_state(path_to_uri(file)) for file in files)
