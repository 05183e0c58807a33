"""``robbdd run``: execute the scenarios of a model and print every clause's verdict with its margin."""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import path_to_uri
from robbdd_tools.commands import FAILED, FINDINGS, INTERRUPTED, OK
from robbdd_tools.commands.models import sound_model
from robbdd_tools.commands.pictures import NoPictures, render_moments
from robbdd_tools.commands.progress import Display
from robbdd_tools.commands.selection import selection
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.run.launch import Agent
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.results import RunResults

if TYPE_CHECKING:
    from robbdd_tools.gherkin.select import Selected, Wanted
    from robbdd_tools.graph.model import AcceptanceModel, Iri


@dataclass(frozen=True, slots=True)
class Outputs:
    """Where a run leaves what: its results as JSON, its folder, pictures of violated clauses."""

    report: Path | None = None
    folder: Path | None = None
    record: Path | None = None


def run(path: Path, wanted: Wanted, names: Sequence[str] | None, outputs: Outputs) -> int:
    """Run a model; returns the exit code. ``names`` selects scenario variants by name, ``wanted`` their scenarios."""
    report = outputs.report
    if report is not None and not report.absolute().parent.is_dir():
        print(f"robbdd: cannot write {report}: there is no folder {report.parent}", file=sys.stderr)
        return FAILED
    model = _model(path)
    if model is None:
        return FAILED
    variants = _variants(model, names)
    if isinstance(variants, str):
        print(f"robbdd: {variants}", file=sys.stderr)
        return FAILED
    selected = _selected(model, variants, wanted)
    if selected is None:
        return FAILED
    request = RunRequest(model, str(path), wanted.seed, variants, selected.scenarios)
    try:
        with _folder(outputs.folder) as folder:
            results, interrupted = _execute(request, Path(folder))
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


def _variants(model: AcceptanceModel, names: Sequence[str] | None) -> frozenset[Iri] | str | None:
    """Return the variants of some names; a sentence when a name is not among them."""
    if not names:
        return None
    known = {model.curie(variant.iri).rsplit(":", 1)[-1]: variant.iri for s in model.stories for variant in s.variants}
    missing = [name for name in names if name not in known]
    if missing:
        return f"there is no scenario '{missing[0]}'; the model has {', '.join(known)}"
    return frozenset(known[name] for name in names)


def _selected(model: AcceptanceModel, variants: frozenset[Iri] | None, wanted: Wanted) -> Selected | None:
    every = (variant for story in model.stories for variant in story.variants)
    return selection(model, [one for one in every if variants is None or one.iri in variants], wanted)


def _folder(output: Path | None) -> AbstractContextManager[str | Path]:
    return tempfile.TemporaryDirectory(prefix="robbdd-") if output is None else nullcontext(output)


def _execute(request: RunRequest, folder: Path) -> tuple[RunResults, bool]:
    """Run the agent on a prepared folder; Ctrl-C ends it and keeps what is finished."""
    results = RunResults(prepare(request, folder))
    agent = Agent(folder)
    interrupted = False
    with Display(results) as display:
        try:
            for message in agent.messages():
                results.apply(message)
                display.show(message)
        except KeyboardInterrupt:
            interrupted = True
        finally:
            agent.cancel()
        if not results.complete:
            reason = "the run was interrupted" if interrupted else agent.ending()
            results.close(reason)
            display.broken(reason)
        display.summary()
    return results, interrupted
