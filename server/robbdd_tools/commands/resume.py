"""``robbdd run --resume``: go on with a run that did not come to its end, as if it had never been interrupted."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools import __version__
from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.locks import hold
from robbdd_tools.base.step_files import steps_file
from robbdd_tools.commands.execute import record as record_run
from robbdd_tools.commands.output import fail, print_note
from robbdd_tools.commands.requests import digest, load_models
from robbdd_tools.commands.run import Outputs, conclude, seen, unusable
from robbdd_tools.commands.runs import store_at
from robbdd_tools.run import user_code
from robbdd_tools.run.pictures import no_display
from robbdd_tools.run.prepare import FEATURES, MODEL_STEPS
from robbdd_tools.run.recording import Recording, pending
from robbdd_tools.run.scheduler import Policy
from robbdd_tools.run.store import LATEST, LOCK, NoSuchRun, StoredRun, shown_path
from robbdd_tools.run.stored_results import FINISHED, RUNNING, STOPPED, read_status
from robbdd_tools.run.used_files import changed, prepared_digest

if TYPE_CHECKING:
    from robbdd_tools.commands.requests import Loaded
    from robbdd_tools.run.store import RunStore
    from robbdd_tools.run.stored_results import RunStatus

PATIENCE = 1.0
"""Seconds that a run may look locked because somebody is just asking whether it is."""


@dataclass(frozen=True, slots=True)
class ResumeOptions:
    """The run (a number, ``latest`` or a folder) and the model, if they are named, and how to go on.

    ``jobs``, ``timeout`` (s) and ``stop_on_failure`` are the run's own where they are not given.
    """

    run: str
    path: Path | None
    outputs: Outputs
    jobs: int | None = None
    timeout: float | None = None
    stop_on_failure: bool = False
    viewer: bool = False


def resume(options: ResumeOptions) -> int:
    """Execute what a run has left open; returns the exit code as ``robbdd run``."""
    problem = unusable(options.outputs) or (no_display() if options.viewer else "")
    if problem:
        return fail(problem)
    try:
        place = _found(store_at(options.path or Path(), options.outputs.store), options)
        lock = hold(place.folder / LOCK, PATIENCE)
        if lock is None:
            return fail(f"run {_name(place)} is going on")
        place = replace(place, lock=lock)
        try:
            return _resume(place, options)
        finally:
            lock.release()
    except NoSuchRun as error:
        return fail(str(error))
    except OSError as error:
        return fail(f"{error.filename}: {error.strerror or error}")


def _found(store: RunStore, options: ResumeOptions) -> StoredRun:
    """Return the run to go on with; raises ``NoSuchRun``."""
    if options.run != LATEST:
        place = store.find(options.run)
        if options.path is not None and place.record().path != shown_path(options.path):
            raise NoSuchRun(f"run {options.run} is one of {place.record().path}, not of {options.path}")
        return place
    for place in reversed(store.runs()):
        try:
            record, status = place.record(), place.status()
        except NoSuchRun:
            continue
        is_meant = options.path is None or record.path == shown_path(options.path)
        if is_meant and not status.is_whole and status.state != RUNNING:
            return place
    what = "" if options.path is None else f" of {options.path}"
    raise NoSuchRun(f"there is no unfinished run{what} in {store.folder}")


def _resume(place: StoredRun, options: ResumeOptions) -> int:
    record, manifest = place.record(), place.manifest()
    status = read_status(place.database, place.number)
    if status is not None and status.state == FINISHED:
        return fail(f"run {_name(place)} is finished: there is nothing to go on with")
    if status is None:
        return fail(f"run {_name(place)} was made by an earlier version, which kept nothing to go on with")
    models = load_models(place.model()) if place.model().exists() else None
    problem = _refusal(place, status, models) or user_code.refusal(manifest, place.folder)
    if problem:
        return fail(f"run {_name(place)} cannot go on: {problem}")
    # A run that was stopped at its first failure and is to go on all the same leaves nothing out any more.
    stops = options.stop_on_failure or (status.stop_on_failure and status.state != STOPPED)
    timeout = status.timeout if options.timeout is None else options.timeout
    policy = Policy(timeout=timeout, stop_on_failure=stops)
    policy = seen(policy if options.jobs is None else replace(policy, jobs=options.jobs), viewer=options.viewer)
    print_note(f"robbdd: run {_name(place)} of {record.path} goes on; {status.words()}")
    with closing(Recording(place, manifest)) as recording:
        results = recording.resume(policy)
        indices = pending(results, stops=stops)
        executed = record_run(place.folder, manifest, policy, recording, results, indices)
    return conclude(executed, options.outputs, place)


def _refusal(place: StoredRun, status: RunStatus, models: Sequence[Loaded] | None) -> str:
    """Say why the rest of a run would not be what it would have been; nothing when it would."""
    record = place.record()
    if models is None:
        return f"its model, {record.path}, {'cannot be run as it is now' if place.model().exists() else 'is gone'}"
    others = [os.path.relpath(path) for path in changed(record.files, place.folder)]
    if others:
        return f"{', '.join(others)} {'was' if len(others) == 1 else 'were'} changed since it began"
    if digest(models) != record.digest:
        return f"{record.path} was changed since it began: what a new run is for"
    if _steps_differ(place, models):
        return "the model's steps were changed since it began"
    if status.version != __version__:
        return f"RobBDD {status.version} began it, and this is {__version__}"
    if status.prepared != prepared_digest(place.folder):
        return f"the features or the manifest in {place.folder} were changed since it began"
    return ""


def _steps_differ(place: StoredRun, models: Sequence[Loaded]) -> bool:
    now = {load_bytes(path) for model in models if (path := steps_file(model.path)).is_file()}
    stem = MODEL_STEPS.partition("_")[0]
    then = {load_bytes(path) for path in (place.folder / FEATURES / "steps").glob(f"{stem}_*steps.py")}
    return not then <= now if len(models) > 1 else then != now


def _name(place: StoredRun) -> str:
    return str(place.number or place.folder)
