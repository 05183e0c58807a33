"""Resume a run that did not finish. It uses the same seeds and has the same results as an uninterrupted run."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools import __version__
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.locks import acquire
from robbdd_tools.base.step_files import steps_file
from robbdd_tools.run.prepare import FEATURES, MODEL_STEPS
from robbdd_tools.run.recording import Recording, pending
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.store import LATEST, LOCK, NoSuchRun, RunStore, StoredRun, shown_path
from robbdd_tools.run.stored_results import FINISHED, RUNNING, STOPPED, RunStatus, read_status
from robbdd_tools.run.used_files import prepared_digest
from robbdd_tools.run.user_code import refuse_user_code
from robbdd_tools.workbench.run import Run
from robbdd_tools.workbench.unchanged import model_now, refusal

if TYPE_CHECKING:
    from robbdd_tools.workbench.model import Model

LOCK_PATIENCE = 1.0
"""Seconds to wait for a lock, because another process may hold it just to test it."""


class CannotResume(RobbddError):
    """A run cannot be resumed; the message gives the reason."""


def unfinished_run(store: RunStore, word: str = LATEST, path: Path | None = None) -> StoredRun:
    """Return the run to resume. Raises ``NoSuchRun``.

    This is the run that ``word`` names or, if ``word`` is missing, the latest unfinished run. With ``path``, it must be
    a run of the model at this path.
    """
    if word != LATEST:
        place = store.find(word)
        if path is not None and place.record().path != shown_path(path):
            raise NoSuchRun(f"run {word} belongs to {place.record().path}, not to {path}")
        return place
    for place in reversed(store.runs()):
        with suppress(NoSuchRun):
            record, status = place.record(), place.status()
            is_meant = path is None or record.path == shown_path(path)
            if is_meant and not status.is_whole and status.state != RUNNING:
                return place
    what = "" if path is None else f" of {path}"
    raise NoSuchRun(f"there is no unfinished run{what} in {store.folder}")


def resume(place: StoredRun, policy: Callable[[RunStatus], Policy] | None = None) -> Run:
    """Resume a run. Raises ``CannotResume``, ``NoSuchRun`` and ``OSError``.

    ``policy`` returns the new policy, given that of the stored run. By default, the policy stays unchanged.
    """
    lock = acquire(place.folder / LOCK, LOCK_PATIENCE)
    if lock is None:
        raise CannotResume(f"run {_name(place)} is in progress")
    try:
        return _resumed(replace(place, lock=lock), policy or stored_policy)
    except BaseException:
        lock.release()
        raise


def stored_policy(status: RunStatus) -> Policy:
    """Return the policy of a stored run. A run that stopped at its first failure continues after that failure."""
    return Policy(timeout=status.timeout, stop_on_failure=status.stop_on_failure and status.state != STOPPED)


def _resumed(place: StoredRun, policy: Callable[[RunStatus], Policy]) -> Run:
    manifest = place.manifest()
    status = read_status(place.database, place.number)
    if status is None:
        raise CannotResume(f"run {_name(place)} was made by an earlier version, whose runs cannot be resumed")
    if status.state == FINISHED:
        raise CannotResume(f"run {_name(place)} is finished")
    reason = _refusal(place, status)
    if reason:
        raise CannotResume(f"run {_name(place)} cannot be resumed: {reason}")
    refuse_user_code(manifest, place.folder)
    chosen = policy(status)
    recording = Recording(place, manifest)
    try:
        results = recording.resume(chosen)
    except BaseException:
        recording.close()
        raise
    return Run(place, chosen, recording, results, pending(results, stops=chosen.stop_on_failure))


def _refusal(place: StoredRun, status: RunStatus) -> str:
    """Return why the remaining results would differ from those of an uninterrupted run; empty if they are the same."""
    model = model_now(place)
    reason = refusal(place, model)
    if reason or isinstance(model, str):
        return reason
    if _steps_differ(place, model):
        return "the model's steps were changed since it began"
    if status.version != __version__:
        return f"RobBDD {status.version} began it, and this is {__version__}"
    if status.prepared != prepared_digest(place.folder):
        return f"the features or the manifest in {place.folder} were changed since it began"
    return ""


def _steps_differ(place: StoredRun, model: Model) -> bool:
    files = model.runnable
    now = {load_bytes(path) for file in files if (path := steps_file(Path(file.name))).is_file()}
    stem = MODEL_STEPS.partition("_")[0]
    then = {load_bytes(path) for path in (place.folder / FEATURES / "steps").glob(f"{stem}_*steps.py")}
    return not then <= now if len(files) > 1 else then != now


def _name(place: StoredRun) -> str:
    return str(place.number or place.folder)
