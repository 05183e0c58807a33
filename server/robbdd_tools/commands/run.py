"""``robbdd run``: execute scenarios and print every clause's verdict with its margin."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools import __version__
from robbdd_tools.base.isolation import NO_USER_CODE
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.commands import FAILED, FINDINGS, INTERRUPTED, OK
from robbdd_tools.commands.execute import execute
from robbdd_tools.commands.output import fail, print_line, print_note
from robbdd_tools.commands.requests import Choice, digest, load_models, requests
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.pictures import NoPictures, no_display, render_moments, render_videos
from robbdd_tools.run.prepare import prepare_all
from robbdd_tools.run.protocol import VIEWER
from robbdd_tools.run.store import NoSuchRun, RunRecord, RunStore, StoredRun, origin, shown_path, store_beside
from robbdd_tools.run.used_files import digests
from robbdd_tools.run.user_code import refusal

if TYPE_CHECKING:
    from robbdd_tools.run.prepare import RunRequest
    from robbdd_tools.run.protocol import ScenarioSpec
    from robbdd_tools.run.results import RunResults
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
    for report in (outputs.report, outputs.junit):
        if report is not None and not report.absolute().parent.is_dir():
            return fail(f"cannot write {report}: there is no folder {report.parent}")
    if options.viewer:
        problem = no_display()
        if problem:
            return fail(problem)
        os.environ[VIEWER] = "1"
        options = replace(options, policy=replace(options.policy, jobs=1))
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


def _run(options: RunOptions, found: list[RunRequest], record: RunRecord, place: StoredRun) -> int:
    outputs = options.outputs
    manifest = prepare_all(found, str(options.path), record.seed, place.folder, place.kept)
    if not manifest.scenarios:
        return fail("no scenario fits the selection")
    record = replace(record, files=digests(manifest, place.folder))
    place.write_record(record)
    results, simulator, interrupted = execute(place.folder, manifest, options.policy)
    place.write_record(replace(record, simulator=simulator))
    place.write_results(results.as_json())
    if outputs.record is not None:
        _record(place.folder, outputs.record)
    _report(results, outputs)
    if place.number:
        print_note(f"kept as run {place.number}")
    if interrupted:
        return INTERRUPTED
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
        outputs.folder.mkdir(parents=True, exist_ok=True)
        yield StoredRun(0, outputs.folder)
        return
    if outputs.keep:
        try:
            place = store.begin()
        except OSError as error:
            reason = error.strerror or str(error)
            print_note(f"robbdd: this run is not kept: {store.folder} cannot be written: {reason}")
        else:
            yield place
            return
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        yield StoredRun(0, Path(folder), kept=False)


def _last_results(store: RunStore, path: Path) -> Mapping[str, Any]:
    """Return the results of the last run of a model; raises ``NoSuchRun``."""
    last = next((run for run in reversed(store.runs()) if _is_of(run, path)), None)
    if last is None:
        raise NoSuchRun(f"there is no stored run of {path} in {store.folder}")
    return last.results()


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
        return run.record().path == shown_path(path) and bool(run.results())
    except NoSuchRun:
        return False


def _key(entry: Mapping[str, Any]) -> tuple[object, ...]:
    return entry["variant"], entry["variation"], entry["execution"], entry["repetition"]


def _is_among(failed: set[tuple[object, ...]]) -> Callable[[ScenarioSpec], bool]:
    def chosen(spec: ScenarioSpec) -> bool:
        execution = None if spec.execution is None else spec.execution.name
        return (spec.variant, spec.variation, execution, spec.repetition) in failed

    return chosen
