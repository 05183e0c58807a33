"""Store of numbered run folders in the project, ``.robbdd/runs/<n>/``, with one database of results.

A stored run consists of the run folder (features, manifest, logs, moments, traces) and of rows in ``results.sqlite``,
which is next to the folder ``runs``. The file ``run.json`` in the run folder records the input of the run. A run in a
folder outside of the store has its database inside that folder. When a run ends, ``results.json`` is generated from the
database. Runs of earlier versions have only ``results.json``; they can still be read.
"""

from __future__ import annotations

import errno
import json
import os
import shutil
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, cast

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import full_path, load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.locks import Lock, acquire, is_held
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.run.database import LOG, NAME, DatabaseProblem
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.store_maintenance import make_ready, remove_runs
from robbdd_tools.run.stored_results import FINISHED, INTERRUPTED, RunStatus, read_results, read_status, starts

MARKS = ("pyproject.toml", "robbdd.toml", ".git")
"""Files or folders that mark a project's root."""
FOLDER = Path(".robbdd") / "runs"
RESULTS = "results.json"
RECORD = "run.json"
LOCK = "lock"
"""Lock file of a run folder, held while the run is live, and of the folder of all runs, held while one begins."""
KEPT = 20
"""A store keeps this many complete runs, and as many incomplete ones. Older runs are removed."""
LATEST = "latest"
PATIENCE = 30.0
"""Seconds that a run waits for another one that is beginning."""


class NoSuchRun(RobbddError):
    """The run does not exist or cannot be read. The message lists the existing runs or gives the reason."""


@dataclass(frozen=True, slots=True)
class RunRecord:
    """The subject of a run: the model and a digest of its graph.

    - ``path``: the path of the model relative to the project's root.
    - ``origin``: the path of the model relative to the run folder.
    - ``version``: the version of this package.
    - ``simulator``: the version of the simulator.
    - ``files``: digests of the other files that the run uses, by their paths relative to the run folder.
    - ``user_seed``: the seed given by the user. If it is ``None``, the executions of the model have their own seeds.
    - ``models``: the paths of the models relative to the run folder, unless all of them are in the file ``path``. In
      this case, ``path`` is their common folder.
    - ``log``: the absolute path of the log that was judged; empty for a simulated run.
    """

    path: str
    origin: str
    digest: str
    seed: int
    version: str
    simulator: str = ""
    files: Mapping[str, str] = field(default_factory=dict[str, str])
    user_seed: int | None = None
    models: Sequence[str] = ()
    log: str = ""


@dataclass(frozen=True, slots=True)
class StoredRun:
    """A run folder.

    - ``number``: the number of the run in ``database``; 0 for a folder outside a store.
    - ``kept``: true if the run is never removed automatically.
    - ``lock``: set while this process executes the run.
    - ``remark``: a note for the user about the store of the run.
    """

    number: int
    folder: Path
    database: Path
    kept: bool = True
    lock: Lock | None = field(default=None, compare=False, repr=False)
    remark: str = field(default="", compare=False, repr=False)

    @property
    def is_live(self) -> bool:
        """Whether a process is executing the run."""
        return is_held(self.folder / LOCK)

    @property
    def began(self) -> bool:
        """Whether the record of the run has been written."""
        return (self.folder / RECORD).is_file()

    def record(self) -> RunRecord:
        """Return the record of the run. Raises ``NoSuchRun``."""
        fields = self._json(RECORD)
        try:
            found = RunRecord(**fields)
            return replace(found, models=tuple(found.models))
        except TypeError:
            raise NoSuchRun(f"{self.folder / RECORD} is not the record of a run") from None

    def status(self) -> RunStatus:
        """Return the progress of the run. Raises ``NoSuchRun``."""
        # Check the lock first: a run that ends in between has its final state in the database.
        live = self.is_live
        try:
            found = read_status(self.database, self.number, live=live)
        except DatabaseProblem as error:
            return self._kept_status(str(error))
        return self._kept_status() if found is None else found

    def results(self) -> Mapping[str, Any]:
        """Return the results as a document that follows ``docs/schemas/run.schema.json``. Raises ``NoSuchRun``."""
        try:
            found = self.read_results()
        except DatabaseProblem as error:
            return self._kept_results(str(error))
        return self._kept_results() if found is None else found.as_json()

    def read_results(self) -> RunResults | None:
        """Return the results of the run, or ``None`` if the database has none.

        Raises ``NoSuchRun`` and ``DatabaseProblem``.
        """
        live = self.is_live
        if read_status(self.database, self.number, live=live) is None:
            return None
        return read_results(self.database, self.number, self.manifest(), live=live)

    def manifest(self) -> Manifest:
        """Return the manifest that the agent reads. Raises ``NoSuchRun``."""
        try:
            return read_manifest(self.folder)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise NoSuchRun(f"{self.folder} holds no run: {error}") from error

    def model(self) -> Path:
        """Return the path of the file or folder that was run; it may no longer exist. Raises ``NoSuchRun``."""
        return (self.folder / self.record().origin).resolve()

    def models(self) -> list[Path]:
        """Return the paths of the files and folders that were run; they may no longer exist. Raises ``NoSuchRun``."""
        return [(self.folder / model).resolve() for model in self.record().models] or [self.model()]

    def write_record(self, record: RunRecord) -> None:
        """Write the record; raises ``OSError``."""
        replace_file(self.folder / RECORD, printable_json(asdict(record), indent=1) + "\n")

    def write_results(self, results: Mapping[str, Any]) -> None:
        """Write the results; raises ``OSError``."""
        replace_file(self.folder / RESULTS, printable_json(results, indent=1) + "\n")

    def discard(self) -> None:
        """Remove the folder of a run that never began."""
        if self.lock is not None:
            self.lock.release()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _kept_status(self, problem: str = "") -> RunStatus:
        """Return the status of the run according to ``results.json`` alone."""
        results = self._kept_results(problem)
        scenarios: list[Mapping[str, Any]] = results.get("scenarios", [])
        counts = Counter(entry["verdict"] for entry in scenarios if entry.get("duration") is not None)
        state = FINISHED if results.get("complete") else INTERRUPTED
        return RunStatus(state, results.get("ending", ""), len(scenarios), counts)

    def _kept_results(self, problem: str = "") -> Mapping[str, Any]:
        """Return the document in ``results.json``.

        If the file cannot be read, raises ``NoSuchRun`` with the message ``problem``. Without a ``problem``, the
        message names the missing part.
        """
        try:
            return self._json(RESULTS)
        except NoSuchRun as error:
            if problem:
                raise NoSuchRun(problem) from error
            if self.database.exists() and (self.folder / RECORD).exists():
                lacks = f"{self.database} has no record of run {self.number}, and its folder no {RESULTS}"
                raise NoSuchRun(f"{lacks}: copy its write-ahead log {NAME}{LOG}, too") from error
            raise

    def _json(self, name: str) -> dict[str, Any]:
        path = self.folder / name
        try:
            found: object = json.loads(load_text(path, RESULT_SIZE))
        except FileNotFoundError:
            if not self.folder.exists():
                raise NoSuchRun(f"the folder of the run, {self.folder}, is gone") from None
            raise NoSuchRun(f"{self.folder} holds no finished run: there is no {name}") from None
        except (OSError, ValueError) as error:
            raise NoSuchRun(f"{path} cannot be read: {error}") from error
        if not isinstance(found, dict):
            raise NoSuchRun(f"{path} is not an object")
        return cast(dict[str, Any], found)


def run_in(folder: Path, *, kept: bool = True) -> StoredRun:
    """Return the run in a folder outside a store."""
    return StoredRun(0, folder, folder / NAME, kept)


def begin_in(folder: Path, *, kept: bool = True) -> StoredRun:
    """Create a folder for a single run, and remove the contents of an earlier run in it. Raises ``OSError``."""
    folder.mkdir(parents=True, exist_ok=True)
    run = run_in(folder, kept=kept)
    lock = acquire(folder / LOCK)
    if lock is None:
        raise OSError(errno.EBUSY, "another run is writing to it", str(folder))
    for name in ("traces", "margins", "moments", "features"):
        shutil.rmtree(folder / name, ignore_errors=True)
    (folder / RESULTS).unlink(missing_ok=True)
    return replace(run, lock=lock, remark=make_ready(run.database, ()))


class RunStore:
    """The numbered runs in one folder, which need not exist."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.database = _database_of(full_path(folder))

    def runs(self) -> list[StoredRun]:
        """Return the runs, oldest first."""
        found = self._folders()
        # If the database cannot be read, each run reports it.
        with suppress(DatabaseProblem):
            found |= dict.fromkeys(starts(self.database))
        return [self._run(number) for number in sorted(found)]

    def begin(self) -> StoredRun:
        """Create the folder of a new run. Raises ``OSError``.

        If the store has more than ``KEPT`` runs, the oldest ones are removed.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        ignore = self.database.parent / ".gitignore"
        if not ignore.exists():
            replace_file(ignore, "*\n")
        guard = acquire(self.folder / LOCK, PATIENCE)
        if guard is None:
            raise OSError(errno.EBUSY, "another run is beginning", str(self.folder))
        try:
            remark = make_ready(self.database, {run.number for run in self.runs() if run.is_live})
            runs = self.runs()
            run = self._run(runs[-1].number + 1 if runs else 1)
            run.folder.mkdir()
            run = replace(run, lock=acquire(run.folder / LOCK), remark=remark)
            self._prune(runs)
            return run
        finally:
            guard.release()

    def find(self, word: str) -> StoredRun:
        """Return the run that ``word`` names by its number, by ``latest`` or by its folder. Raises ``NoSuchRun``."""
        runs = self.runs()
        if word == LATEST and runs:
            return runs[-1]
        found = [run for run in runs if str(run.number) == word]
        if found:
            return found[0]
        folder = Path(word)
        if (folder / RECORD).is_file():
            own = run_in(folder)
            numbered = folder.name.isdecimal() and not own.database.is_file()
            return RunStore(folder.parent)._run(int(folder.name)) if numbered else own
        known = f"it has {', '.join(str(run.number) for run in runs)}" if runs else "it has none"
        raise NoSuchRun(f"there is no run '{word}' in {self.folder}; {known}")

    def _run(self, number: int) -> StoredRun:
        return StoredRun(number, self.folder / str(number), self.database)

    def _folders(self) -> dict[int, None]:
        try:
            entries = list(self.folder.iterdir())
        except OSError:
            return {}
        return {int(entry.name): None for entry in entries if entry.name.isdecimal() and entry.is_dir()}

    def _prune(self, runs: Iterable[StoredRun]) -> None:
        """Remove the oldest runs, so that ``KEPT`` complete and ``KEPT`` incomplete runs remain.

        Live runs always remain.
        """
        whole: list[StoredRun] = []
        others: list[StoredRun] = []
        for run in runs:
            if not run.is_live:
                (whole if _is_whole(run) else others).append(run)
        old = [*whole[:-KEPT], *others[:-KEPT]]
        if old:
            for run in old:
                shutil.rmtree(run.folder, ignore_errors=True)
            remove_runs(self.database, (run.number for run in old))


def _database_of(folder: Path) -> Path:
    """Return the path of the database of a run in some folder of runs.

    The database of a project's store (or of a copy of it) is next to the folder; any other database is inside it.
    """
    beside = folder.with_name(NAME)
    in_project = folder.parts[-len(FOLDER.parts) :] == FOLDER.parts
    return beside if in_project or (folder.name == FOLDER.name and beside.is_file()) else folder / NAME


def _is_whole(run: StoredRun) -> bool:
    try:
        return run.status().is_whole
    except NoSuchRun:
        return False


def project_root(path: Path) -> Path:
    """Return the root of the project that contains a model; a model without a project has its own folder as root."""
    here = full_path(path) if path.is_dir() else full_path(path).parent
    return next((folder for folder in (here, *here.parents) if any((folder / mark).exists() for mark in MARKS)), here)


def relative_model_path(model: Path, folder: Path) -> str:
    """Return the path of a model relative to its run folder, so that both can be moved together."""
    return Path(os.path.relpath(model, folder)).as_posix()


def store_beside(path: Path) -> RunStore:
    """Return the store of a model's project."""
    return RunStore(project_root(path) / FOLDER)


def shown_path(path: Path) -> str:
    """Return a model's path relative to its project's root."""
    return full_path(path).relative_to(project_root(path)).as_posix()
