"""The folder of a study's results."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.locks import is_held
from robbdd_tools.campaign.study_progress import Tally
from robbdd_tools.campaign.study_traces import TRACES
from robbdd_tools.run.database import DatabaseProblem
from robbdd_tools.run.store import LOCK, NoSuchRun, project_root, run_in, shown_path
from robbdd_tools.run.study_reader import read_study_store
from robbdd_tools.run.study_schema import NAME

if TYPE_CHECKING:
    from robbdd_tools.run.study_reader import StudyReader

FOLDER = Path(".robbdd") / "studies"
RUNS = "runs"
"""Folder of the runs in which executions of a study were replayed."""
NEVER_BEGUN = "the study has no results: `robbdd study run` begins it"
BATCHES = "batches"
"""Folder of the batches in progress."""


class StudyProblem(RobbddError):
    """A study cannot be executed or continued; the message gives the reason."""


def study_folder(path: Path, store: Path | None = None) -> Path:
    """Return the folder of a study's results: ``.robbdd/studies/`` in its project, or ``store``."""
    root = project_root(path) / FOLDER if store is None else store
    return root / shown_path(path)


def has_results(folder: Path) -> bool:
    """Return whether a study has been begun."""
    return (folder / NAME).is_file()


def remove_results(folder: Path) -> None:
    """Remove the results of a study. Raises ``StudyProblem`` while it is executed, and ``OSError``."""
    if not folder.exists():
        return
    if is_held(folder / LOCK):
        raise StudyProblem("another process executes this study: wait for it, or end it first")
    for end in ("", "-wal", "-shm"):
        (folder / f"{NAME}{end}").unlink(missing_ok=True)
    for name in (BATCHES, RUNS, TRACES):
        shutil.rmtree(folder / name, ignore_errors=True)


def open_results(folder: Path) -> StudyReader:
    """Open the results of a study to read. Raises ``StudyProblem`` if there are none, and ``DatabaseProblem``."""
    if not has_results(folder):
        raise StudyProblem(NEVER_BEGUN)
    store = read_study_store(folder)
    if store.fact("digest") is None:
        # A full disk or a kill has ended it while the database was made.
        store.close()
        raise StudyProblem(NEVER_BEGUN)
    return store


def is_executed(folder: Path) -> bool:
    """Return whether a process executes a study now."""
    return is_held(folder / LOCK)


def tally_so_far(folder: Path, store: StudyReader) -> Tally:
    """Count the verdicts of the stored batches, and of those in progress. Raises ``DatabaseProblem``."""
    found, done = Tally.of(store), store.batches()
    places: Iterable[Path] = (folder / BATCHES).iterdir() if (folder / BATCHES).is_dir() else ()
    for path in places:
        if path.name.isdecimal() and int(path.name) not in done:
            with suppress(NoSuchRun, DatabaseProblem):
                results = run_in(path, kept=False).read_results()
                found.add_finished([] if results is None else results.scenarios)
    return found
