"""``robbdd run``: execute scenarios and print every clause's verdict with its margin."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Generator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools import __version__
from robbdd_tools.base.isolation import NO_USER_CODE
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, FINDINGS, OK, signal_code
from robbdd_tools.commands.execute import record as record_run
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.commands.requests import Choice, digest, load_models, requests
from robbdd_tools.commands.runs import say_unfinished
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.pictures import NoPictures, no_display, render_moments, render_videos
from robbdd_tools.run.prepare import prepare_all
from robbdd_tools.run.protocol import VIEWER
from robbdd_tools.run.recording import Recording
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.scheduler import STOPPED
from robbdd_tools.run.store import (
    NoSuchRun,
    RunRecord,
    RunStore,
    StoredRun,
    begin_in,
    origin,
    shown_path,
    store_beside,
)
from robbdd_tools.run.stored_results import RUNNING
from robbdd_tools.run.used_files import digests, prepared_digest
from robbdd_tools.run.user_code import refusal

if TYPE_CHECKING:
    from robbdd_tools.commands.execute import Executed
    from robbdd_tools.run.prepare import RunRequest
    from robbdd_tools.run.protocol import ScenarioSpec
    from robbdd_tools.run.scheduler import Policy


@dataclass(frozen=True, slots=True)
class Outputs:
    """Where a run leaves what: its results as JSON and JUnit XML, its folder, pictures of violated clauses, its store.

    Without ``folder`` it is kept in ``store`` (that of the model's project when ``None``), unless ``keep`` is false.
    """

    report: Path | None = None
    junit: Path | None = None
    folder: Path | None = None
    record: Path | None = None
    store: Path | None = None
    keep: bool = True


@dataclass(frozen=True, slots=True)
class RunOptions:
    """What to run (a model, or a folder of them) and how.

    ``rerun_failed`` is about the last stored run of it; ``viewer`` opens a window on each scenario, one after another.
    """

    path: Path
    choice: Choice
    policy: Policy
    outputs: Outputs
    rerun_failed: bool = False
    viewer: bool = False


def run(options: RunOptions) -> int:
    """Run models; returns the exit code."""
    outputs = options.outputs
    problem = unusable(outputs) or (no_display() if options.viewer else "")
    if problem:
        return fail(problem)
    options = replace(options, policy=seen(options.policy, viewer=options.viewer))
    models = load_models(options.path)
    if models is None:
        return FAILED
    choice = options.choice
    store = store_beside(options.path) if outputs.store is None else RunStore(outputs.store)
    if options.rerun_failed:
        try:
            last = _last_results(store, options.path)
        except NoSuchRun as error:
            return fail(str(error))
        failed = {_key(entry) for entry in last["scenarios"] if entry["verdict"] != Outcome.HOLDS}
        if not failed:
            print_line("nothing failed in the last run")
            return OK
        choice = _failed_ones(choice, last, failed)
    found = requests(models, choice)
    if isinstance(found, str):
        return fail(found)
    problem = _user_code(found, options)
    if problem:
        return fail(problem)
    try:
        with _place(store, outputs) as place:
            start = origin(options.path, place.folder)
            record = RunRecord(shown_path(options.path), start, digest(models), choice.wanted.seed, __version__)
            return _run(options, found, record, place)
    except OSError as error:
        return fail(f"{error.filename or outputs.folder or outputs.report}: {error.strerror or error}")


def _user_code(found: list[RunRequest], options: RunOptions) -> str:
    """Say why ``--no-user-code`` refuses a run, before anything of it is kept."""
    if not os.environ.get(NO_USER_CODE):
        return ""
    with tempfile.TemporaryDirectory(prefix="robbdd-") as name:
        return refusal(prepare_all(found, str(options.path), options.choice.wanted.seed, Path(name)), Path(name))


def unusable(outputs: Outputs) -> str:
    """Return why reports cannot be written where they are wanted; nothing when they can."""
    for report in (outputs.report, outputs.junit):
        if report is not None and not report.absolute().parent.is_dir():
            return f"cannot write {report}: there is no folder {report.parent}"
    return ""


def seen(policy: Policy, *, viewer: bool) -> Policy:
    """Return the policy of a run that is followed in windows, one scenario after another, if ``viewer``."""
    if not viewer:
        return policy
    os.environ[VIEWER] = "1"
    return replace(policy, jobs=1)


def _run(options: RunOptions, found: list[RunRequest], record: RunRecord, place: StoredRun) -> int:
    manifest = prepare_all(found, str(options.path), record.seed, place.folder, place.kept)
    if not manifest.scenarios:
        return fail("no scenario fits the selection")
    record = replace(record, files=digests(manifest, place.folder))
    with closing(Recording(place, manifest)) as recording:
        recording.begin(record, options.policy, prepared_digest(place.folder))
        place.write_record(record)
        executed = record_run(place.folder, manifest, options.policy, recording, RunResults(manifest))
    return conclude(executed, options.outputs, place)


def conclude(executed: Executed, outputs: Outputs, place: StoredRun) -> int:
    """Write the reports of a run, say where it is kept, and return the exit code. Raises ``OSError``."""
    results = executed.results
    if outputs.record is not None:
        _record(place.folder, outputs.record)
    _report(results, outputs)
    if place.kept:
        name = f"run {place.number}" if place.number else str(place.folder)
        print_note(f"kept as {name}")
        if not results.complete and results.ending != STOPPED:
            print_note(f"go on with it by: robbdd run --resume {place.number or place.folder}")
    if executed.problem:
        return fail(executed.problem)
    if executed.signal:
        return signal_code(executed.signal)
    return OK if results.count(Outcome.HOLDS) == len(results.scenarios) else FINDINGS


def _report(results: RunResults, outputs: Outputs) -> None:
    from robbdd_tools.run.junit import junit

    if outputs.report is not None:
        replace_file(outputs.report, printable_json(results.as_json(), indent=1) + "\n")
    if outputs.junit is not None:
        replace_file(outputs.junit, junit(results))


def _record(folder: Path, target: Path) -> None:
    """Write the pictures; verdicts stand without them."""
    for render, what, of in (
        (render_moments, "picture", "violated clauses"),
        (render_videos, "moving picture", "scenarios"),
    ):
        try:
            count = render(folder, target)
        except NoPictures as error:
            print_note(f"robbdd: no {what}s: {error}")
        else:
            print_note(f"{count} {what}{'' if count == 1 else 's'} of {of} in {target}")


@contextmanager
def _place(store: RunStore, outputs: Outputs) -> Generator[StoredRun]:
    """Yield the folder of a run: the wanted one, a new one in the store, else one that is gone afterwards."""
    if outputs.folder is not None:
        place = begin_in(outputs.folder)
        _remark(place)
        yield place
        return
    if outputs.keep:
        try:
            place = store.begin()
        except OSError as error:
            reason = error.strerror or str(error)
            print_note(f"robbdd: this run is not kept: {store.folder} cannot be written: {reason}")
        else:
            _remark(place)
            try:
                yield place
            finally:
                if not place.began:
                    place.discard()
            return
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        yield begin_in(Path(folder), kept=False)


def _remark(place: StoredRun) -> None:
    if place.remark:
        print_note(f"robbdd: {place.remark}")


def _last_results(store: RunStore, path: Path) -> Mapping[str, Any]:
    """Return the results of the last run of a model that has ended; raises ``NoSuchRun``."""
    for run in reversed(store.runs()):
        if _is_of(run, path):
            results = run.results()
            say_unfinished(run, run.status())
            return results
    raise NoSuchRun(f"there is no stored run of {path} in {store.folder}")


def _failed_ones(choice: Choice, last: Mapping[str, Any], failed: set[tuple[object, ...]]) -> Choice:
    """Choose what did not hold in a run, with its seed."""
    seed = last["seed"] if choice.seed is None else choice.seed
    repeated = max(entry["repetition"] for entry in last["scenarios"])
    return replace(
        choice,
        wanted=replace(choice.wanted, seed=seed),
        repeat=choice.repeat or (repeated if repeated > 1 else None),
        only=_is_among(failed),
    )


def _is_of(run: StoredRun, path: Path) -> bool:
    try:
        return run.record().path == shown_path(path) and run.status().state != RUNNING
    except NoSuchRun:
        return False


def _key(entry: Mapping[str, Any]) -> tuple[object, ...]:
    return entry["variant"], entry["variation"], entry["execution"], entry["repetition"]


def _is_among(failed: set[tuple[object, ...]]) -> Callable[[ScenarioSpec], bool]:
    def chosen(spec: ScenarioSpec) -> bool:
        execution = None if spec.execution is None else spec.execution.name
        return (spec.variant, spec.variation, execution, spec.repetition) in failed

    return chosen
