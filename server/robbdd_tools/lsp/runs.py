"""Runs and Gherkin from the editor: progress, cancelling, results as they come."""

from __future__ import annotations

import asyncio
import logging
import shutil
import tempfile
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lsprotocol import types

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.features.clause_results import ClauseResult, JudgedClause, clause_text
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.gherkin.files import FeaturePlan, write_features
from robbdd_tools.graph.model import AcceptanceModel, Iri
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.names.project import Snapshot
from robbdd_tools.run.prepare import RunRequest, prepare
from robbdd_tools.run.protocol import (
    ClauseJudged,
    ClauseSpec,
    ClauseStarted,
    RunFinished,
    RunMessage,
    ScenarioFinished,
    ScenarioStarted,
)
from robbdd_tools.run.report import plain_sentence, values_words, verdict_words
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.scheduler import Scheduler

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer

RUN_MESSAGE = "robbdd/runMessage"
_LOG = logging.getLogger(__name__)
_BADNESS = {Outcome.VIOLATED: 0.0, Outcome.UNKNOWN: 1e6, Outcome.HOLDS: 2e6}


@dataclass
class ActiveRun:
    """A run in progress: the files that its clauses may stand in, and the results so far by clause IRI."""

    uri: str
    token: str
    uris: tuple[str, ...]
    results: RunResults
    scheduler: Scheduler
    found: dict[str, list[ClauseResult]] = field(default_factory=dict[str, list[ClauseResult]])
    texts: dict[str, str] = field(default_factory=dict[str, str])

    def cancel(self) -> None:
        """Stop the agents; the loop that reads their messages then ends by itself."""
        self.scheduler.cancel()


class ModelError(Exception):
    """The model cannot be run as it is; the message says why, for the user."""


async def generate_gherkin(ls: RobbddServer, uri: str) -> list[str]:
    """Write the features of a model, with their line maps, beside it in ``features/``, and return their URIs."""
    path = uri_to_path(uri)
    if path is None:
        _tell(ls, "save the model first: its features are written beside it")
        return []
    try:
        plan = await ls.analyse(lambda snapshot: _plan(snapshot, uri))
        written = await asyncio.to_thread(write_features, plan, path.parent / "features")
    except (ModelError, OSError) as error:
        _tell(ls, str(error))
        return []
    return [path_to_uri(file) for file in written]


async def start_run(ls: RobbddServer, uri: str, variant: str | None) -> None:
    """Run a model's scenarios (one variant's where given) to their end, showing results as they come."""
    if ls.run is not None:
        _tell(ls, "a run is going on: cancel it first")
        return
    folder = Path(tempfile.mkdtemp(prefix="robbdd-"))
    try:
        model = await ls.analyse(lambda snapshot: _sound_model(snapshot, uri))
        request = RunRequest(model, uri, variants=None if variant is None else {Iri(variant)})
        manifest = await asyncio.to_thread(prepare, request, folder)
        uris = await ls.analyse(lambda snapshot: tuple(file.document.uri for file in snapshot.scope(uri).files))
        ls.run = ActiveRun(uri, f"robbdd-run-{folder.name}", uris, RunResults(manifest), Scheduler(folder, manifest))
        await _follow(ls, ls.run)
    except (ModelError, OSError) as error:
        _tell(ls, str(error))
    finally:
        ls.run = None
        await asyncio.to_thread(shutil.rmtree, folder, True)


def cancel_run(ls: RobbddServer) -> None:
    """Cancel the run in progress, if any."""
    if ls.run is not None:
        ls.run.cancel()


async def _follow(ls: RobbddServer, run: ActiveRun) -> None:
    """Hand every message of the run on, keep its results, and report progress."""
    await _begin_progress(ls, run)
    messages = run.scheduler.messages()
    while (message := await asyncio.to_thread(next, messages, None)) is not None:
        await _take(ls, run, message)
    if not run.results.complete:
        for judged in run.results.close(run.scheduler.ending):
            await _take(ls, run, judged)
        ls.protocol.notify(RUN_MESSAGE, _for_client(run, RunFinished(False)))
    holding = run.results.count(Outcome.HOLDS)
    summary = f"{holding} of {len(run.results.scenarios)} scenarios hold"
    ls.work_done_progress.end(run.token, types.WorkDoneProgressEnd(message=summary))
    await ls.publish_results(run.uris)


async def _take(ls: RobbddServer, run: ActiveRun, message: RunMessage) -> None:
    run.results.apply(message)
    ls.protocol.notify(RUN_MESSAGE, _for_client(run, message))
    if isinstance(message, ClauseJudged):
        await _judged(ls, run, message)
    elif isinstance(message, ScenarioFinished):
        done = sum(scenario.finished is not None for scenario in run.results.scenarios)
        total = len(run.results.scenarios)
        report = types.WorkDoneProgressReport(message=f"{done}/{total} scenarios", percentage=100 * done // total)
        ls.work_done_progress.report(run.token, report)


def _for_client(run: ActiveRun, message: RunMessage) -> dict[str, Any]:
    """Return a message with the words that a reader needs beside its numbers."""
    fields: dict[str, Any] = {"type": type(message).__name__, **asdict(message)}
    match message:
        case ScenarioStarted(index):
            spec = run.results.scenarios[index].spec
            fields |= {"name": spec.name, "values": values_words(spec)}
        case ClauseStarted(index, line) | ClauseJudged(index, line):
            clause = _clause(run, index, line)
            if clause is not None:
                fields |= {"clause": clause.iri, "sentence": plain_sentence(clause.sentence)}
        case _:
            pass
    return {"uri": run.uri, "message": fields}


def _clause(run: ActiveRun, index: int, line: int) -> ClauseSpec | None:
    clauses = run.results.scenarios[index].spec.clauses
    return next((clause for clause in clauses if clause.line == line), None)


async def _judged(ls: RobbddServer, run: ActiveRun, message: ClauseJudged) -> None:
    """Put a judgement where its clause stands."""
    clause = _clause(run, message.index, message.line)
    if clause is None:
        return
    spec = run.results.scenarios[message.index].spec
    outcome = Outcome(message.verdict)
    rank = _BADNESS[outcome] + (message.robustness or 0.0)
    label = verdict_words(message).partition(":")[0]
    detail = f"{values_words(spec)}: {verdict_words(message)}"
    run.found.setdefault(clause.iri, []).append(ClauseResult(outcome, label, detail, rank))
    if clause.iri not in run.texts:
        text = await ls.analyse(lambda snapshot: clause_text(snapshot, clause.iri, run.uris))
        run.texts[clause.iri] = text or ""
    ls.judged[clause.iri] = JudgedClause(run.texts[clause.iri], tuple(run.found[clause.iri]))
    await ls.publish_results(run.uris)


async def _begin_progress(ls: RobbddServer, run: ActiveRun) -> None:
    window = ls.client_capabilities.window
    if window is not None and window.work_done_progress:
        # pygls leaves the type of the client's (empty) answer open.
        await ls.work_done_progress.create_async(run.token)  # pyright: ignore[reportUnknownMemberType]
    begin = types.WorkDoneProgressBegin(title="RobBDD run", cancellable=True, percentage=0)
    ls.work_done_progress.begin(run.token, begin)


def _sound_model(snapshot: Snapshot, uri: str) -> AcceptanceModel:
    """Return the acceptance model of a file without errors; raises ``ModelError``."""
    return _plan(snapshot, uri).model


def _plan(snapshot: Snapshot, uri: str) -> FeaturePlan:
    """Return what to write of a file without errors; raises ``ModelError``."""
    from robbdd_tools.gherkin.files import clause_origins, whole_plan
    from robbdd_tools.graph.build import build_graph
    from robbdd_tools.graph.places import placed_model

    errors = [found for found in all_diagnostics(snapshot, uri) if found.severity is Severity.ERROR]
    if errors:
        raise ModelError(f"the model has errors, the first: {errors[0].message}")
    built = build_graph(snapshot, uri)
    model = placed_model(built, snapshot)
    if not any(story.variants for story in model.stories):
        raise ModelError("the model has no scenario to run")
    return whole_plan(model, clause_origins(built, snapshot, model))


def _tell(ls: RobbddServer, message: str) -> None:
    ls.window_show_message(types.ShowMessageParams(type=types.MessageType.Error, message=message))
