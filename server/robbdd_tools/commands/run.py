"""``robbdd run``: execute the scenarios of a model and print every clause's verdict with its margin."""

from __future__ import annotations

import json
import signal
import sys
import tempfile
import threading
from collections.abc import Generator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.commands import FAILED, FINDINGS, INTERRUPTED, OK
from robbdd_tools.commands.models import sound_model
from robbdd_tools.commands.pictures import NoPictures, render_moments
from robbdd_tools.commands.progress import Display
from robbdd_tools.commands.selection import selection
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.scheduler import Policy, Scheduler

if TYPE_CHECKING:
    from types import FrameType

    from robbdd_tools.gherkin.select import Selected, Wanted
    from robbdd_tools.graph.model import AcceptanceModel, Execution, Iri


@dataclass(frozen=True, slots=True)
class Outputs:
    """Where a run leaves what: its results as JSON, its folder, pictures of violated clauses."""

    report: Path | None = None
    folder: Path | None = None
    record: Path | None = None


def run(
    path: Path,
    wanted: Wanted,
    names: Sequence[str] | None,
    policy: Policy,
    outputs: Outputs,
    seed: int | None = None,
) -> int:
    """Run a model; returns the exit code.

    ``names`` selects executions and scenario variants by name, ``wanted`` the scenarios of these; ``seed`` is the one
    that goes before those of executions.
    """
    report = outputs.report
    if report is not None and not report.absolute().parent.is_dir():
        print(f"robbdd: cannot write {report}: there is no folder {report.parent}", file=sys.stderr)
        return FAILED
    model = _model(path)
    if model is None:
        return FAILED
    chosen = _chosen(model, names)
    if isinstance(chosen, str):
        print(f"robbdd: {chosen}", file=sys.stderr)
        return FAILED
    variants, executions = chosen
    selected = _selected(model, variants, wanted)
    if selected is None:
        return FAILED
    if seed is not None:
        executions = tuple(replace(execution, seed=None) for execution in executions)
    request = RunRequest(model, str(path), wanted.seed, variants, selected.scenarios, executions)
    try:
        with _folder(outputs.folder) as folder:
            results, interrupted = _execute(request, Path(folder), policy)
            if outputs.record is not None:
                _record(Path(folder), outputs.record)
        if report is not None:
            text = json.dumps(results.as_json(), indent=1, ensure_ascii=False)
            report.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        print(f"robbdd: {error.filename or outputs.folder or report}: {error.strerror or error}", file=sys.stderr)
        return FAILED
    if interrupted:
        return INTERRUPTED
    return OK if results.count(Outcome.HOLDS) == len(results.scenarios) else FINDINGS


def _record(folder: Path, target: Path) -> None:
    """Write the pictures; verdicts stand without them."""
    try:
        count = render_moments(folder, target)
    except NoPictures as error:
        print(f"robbdd: no pictures: {error}", file=sys.stderr)
    else:
        print(f"{count} picture{'' if count == 1 else 's'} of violated clauses in {target}", file=sys.stderr)


def _model(path: Path) -> AcceptanceModel | None:
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.read import read_model

    snapshot = sound_model(path)
    if snapshot is None:
        return None
    model = read_model(build_graph(snapshot, path_to_uri(path)).graph)
    if not any(story.variants for story in model.stories):
        print(f"{path}:1:1: error: the model has no scenario to run [no-scenario]", file=sys.stderr)
        return None
    return model


def _chosen(
    model: AcceptanceModel, names: Sequence[str] | None
) -> tuple[frozenset[Iri] | None, tuple[Execution, ...]] | str:
    """Return the variants (all when ``None``) and executions of some names; a sentence for a name that is neither's.

    A model with executions has those variants only that these execute.
    """
    executions = model.executions
    variants = [variant.iri for story in model.stories for variant in story.variants]
    if executions:
        variants = [iri for iri in variants if any(execution.variant == iri for execution in executions)]
    known = {_name(model, iri) for iri in (*variants, *(execution.iri for execution in executions))}
    missing = [name for name in names or () if name not in known]
    if missing:
        return f"there is no scenario '{missing[0]}'; the model has {', '.join(sorted(known))}"
    if names:
        named = [one for one in executions if {_name(model, one.iri), _name(model, one.variant)} & set(names)]
        executions = tuple(named)
        variants = [execution.variant for execution in named] or [iri for iri in variants if _name(model, iri) in names]
    return (frozenset(variants) if names or executions else None), executions


def _name(model: AcceptanceModel, iri: Iri) -> str:
    return model.curie(iri).rsplit(":", 1)[-1]


def _selected(model: AcceptanceModel, variants: frozenset[Iri] | None, wanted: Wanted) -> Selected | None:
    every = (variant for story in model.stories for variant in story.variants)
    return selection(model, [one for one in every if variants is None or one.iri in variants], wanted)


def _folder(output: Path | None) -> AbstractContextManager[str | Path]:
    return tempfile.TemporaryDirectory(prefix="robbdd-") if output is None else nullcontext(output)


@contextmanager
def _ctrl_c_cancels(scheduler: Scheduler) -> Generator[threading.Event]:
    """Let Ctrl-C cancel a run instead of breaking off whatever is being done; yields whether it was pressed."""
    pressed = threading.Event()

    def cancel(_signal: int, _frame: FrameType | None) -> None:
        pressed.set()
        scheduler.cancel()

    before = signal.signal(signal.SIGINT, cancel)
    try:
        yield pressed
    finally:
        signal.signal(signal.SIGINT, before)


def _execute(request: RunRequest, folder: Path, policy: Policy) -> tuple[RunResults, bool]:
    """Run a prepared folder; Ctrl-C ends it and keeps what is finished."""
    results = RunResults(prepare(request, folder))
    with Display(results) as display:
        scheduler = Scheduler(folder, results.manifest, policy, display.watch)
        with _ctrl_c_cancels(scheduler) as interrupted:
            for message in scheduler.messages():
                results.apply(message)
                display.show(message)
        if not results.complete:
            reason = "the run was interrupted" if interrupted.is_set() else scheduler.ending
            results.close(reason)
            display.broken(reason)
        display.summary()
    return results, interrupted.is_set()
