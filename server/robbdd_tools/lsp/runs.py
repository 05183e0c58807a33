"""Runs from the editor: progress, cancelling, results as they come."""

from __future__ import annotations

import asyncio
import logging
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robbdd_tools import __version__
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.features.run_verdicts import JudgedScenario, Judgement
from robbdd_tools.lsp.kept_results import save_results
from robbdd_tools.lsp.refresh import LENSES
from robbdd_tools.lsp.result_hover import picture_violations
from robbdd_tools.lsp.run_messages import RUN_MESSAGE, clause_at, for_client
from robbdd_tools.lsp.run_plan import ModelError, NothingFailed, RunOptions, RunPlan, plan_run
from robbdd_tools.lsp.run_progress import RunProgress
from robbdd_tools.lsp.trust import refuse_run
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import (
    NO_STEP,
    ClauseJudged,
    RunFinished,
    RunMessage,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
)
from robbdd_tools.run.pictures import NoPictures, render_moments
from robbdd_tools.run.prepare import prepare_all
from robbdd_tools.run.recording import Recording, why
from robbdd_tools.run.report import margin, values_words, verdict_words
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.scheduler import CANCELLED, Policy, Scheduler
from robbdd_tools.run.store import RunRecord, origin, shown_path
from robbdd_tools.run.used_files import digests, prepared_digest

if TYPE_CHECKING:
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.protocol.specs import Manifest
    from robbdd_tools.run.store import StoredRun

PICTURES = "pictures"
_LOG = logging.getLogger(__name__)
_BADNESS = {Outcome.VIOLATED: 0.0, Outcome.UNKNOWN: 1e6, Outcome.HOLDS: 2e6}


@dataclass
class ActiveRun:
    """A run from the moment it is asked for; ``judged`` are its scenarios by their number in the manifest.

    ``progress`` is the token of its progress, which no other run has.
    """

    options: RunOptions
    progress: str
    scheduler: Scheduler | None = None
    cancelled: bool = False
    judged: dict[int, JudgedScenario] = field(default_factory=dict[int, JudgedScenario])

    @property
    def id(self) -> str:
        """What its messages call it."""
        return self.options.token or self.progress

    def cancel(self) -> None:
        """Stop the agents, or what prepares the run; what waits for it then ends by itself."""
        self.cancelled = True
        if self.scheduler is not None:
            self.scheduler.cancel()


async def start_run(ls: RobbddServer, argument: dict[str, Any], **more: object) -> dict[str, Any]:
    """Run scenarios to their end, showing results as they come; returns how it went, or why nothing was run."""
    if not ls.trusted:
        return _refused(ls, await refuse_run(ls, {**argument, **more}))
    if ls.run is not None:
        return _refused(ls, "a run is going on: cancel it first", momentary=True)
    try:
        options = RunOptions.of({**argument, **more})
        ls.run = run = ActiveRun(options, f"robbdd-run-{next(ls.run_numbers)}")
        failed = {(one.variant, one.variation, one.execution) for one in ls.results if one.outcome != "holds"}
        plan = await ls.in_background(lambda snapshot: plan_run(snapshot, ls.convert, options, failed), options.uri)
        place, excuse = await asyncio.to_thread(ls.stores.begin, options.uri)
        if excuse:
            ls.tell(excuse)
        policy = Policy()
        recording, manifest = await asyncio.to_thread(_begin_recording, place, plan, policy)
        try:
            follower = _Follower(ls, run, plan, RunResults(manifest), place, recording)
            run.scheduler = Scheduler(place.folder, manifest, policy, follower.hear)
            if run.cancelled:
                run.scheduler.cancel()
            await follower.follow()
        finally:
            recording.close()
        pictures = await _record(ls, place) if options.record else []
        if ls.shows_pictures:
            await asyncio.to_thread(picture_violations, place, list(run.judged.values()))
        stored = {"run": place.number, "folder": path_to_uri(place.folder)}
        return {**follower.summary(), "stored": stored, "pictures": pictures}
    except (ModelError, OSError) as error:
        return _refused(ls, str(error), momentary=isinstance(error, NothingFailed))
    finally:
        ls.run = None


def _refused(ls: RobbddServer, problem: str, *, momentary: bool = False) -> dict[str, Any]:
    """Tell why nothing was run; a ``momentary`` reason says nothing of the scenarios."""
    ls.tell(problem)
    return {"problem": problem, "momentary": True} if momentary else {"problem": problem}


def cancel_run(ls: RobbddServer) -> None:
    """Cancel the run in progress, if any."""
    if ls.run is not None:
        ls.run.cancel()


class _Follower:
    """Takes what the agents of one run say, at once and in the event loop, whichever of them says it."""

    def __init__(
        self,
        ls: RobbddServer,
        run: ActiveRun,
        plan: RunPlan,
        results: RunResults,
        place: StoredRun,
        recording: Recording,
    ) -> None:
        self._ls = ls
        self._place = place
        self._recording = recording
        self._ending = ""
        self._run = run
        self._progress = RunProgress(ls, run.progress)
        self._plan = plan
        self._results = results
        self._loop = asyncio.get_running_loop()
        self._shared_fault = ""
        self._begun: dict[str, set[tuple[int, str]]] = {}

    def hear(self, message: RunMessage) -> None:
        """Take a message from a thread of the scheduler; it is kept before anybody sees it. Raises ``OSError``."""
        self._recording.take(message)
        self._loop.call_soon_threadsafe(self._take, message)

    async def follow(self) -> None:
        """Follow the run to its end."""
        await self._progress.begin()
        try:
            await self._follow()
        finally:
            self._progress.end(self._told())
        self._ls.show_results(self._plan.uris)
        await self._ls.show_changed()
        await asyncio.to_thread(self._keep, list(self._ls.results))
        # From now on it can be replayed.
        self._ls.refreshes.want(LENSES)

    async def _follow(self) -> None:
        scheduler = self._run.scheduler
        assert scheduler is not None

        def listen() -> str:
            try:
                for _ in scheduler.messages():
                    # Each has been heard when it came.
                    pass
            except OSError as error:
                self._ls.tell(problem := why(error))
                return problem
            return scheduler.ending

        self._ending = ending = await asyncio.to_thread(listen)
        for judged in self._results.close(ending):
            self._take(judged)
        if self._run.options.is_whole and not ending:
            for variant, begun in self._begun.items():
                self._ls.results.drop_others(variant, {number for number, _ in begun})
        self._drop_unjudged()
        request = self._plan.request
        known = {variant.iri for story in request.model.stories for variant in story.variants}
        self._ls.results.drop_deleted(request.name, known, {one.iri for one in request.model.executions})
        for scenario in self._run.judged.values():
            scenario.mark_vacuous(self._results.vacuous())
        self._take(RunFinished(not ending))

    def _keep(self, results: list[JudgedScenario]) -> None:
        """Keep the run, and what is known of all scenarios now."""
        try:
            self._recording.end(self._ending, interrupted=self._run.cancelled)
        finally:
            save_results(self._ls.folders(), results)

    def summary(self) -> dict[str, Any]:
        """Return how the run went, for the client that asked for it."""
        outcomes = Counter(str(scenario.verdict) for scenario in self._results.scenarios)
        counts = {outcome: outcomes[outcome] for outcome in ("holds", "violated", "unknown")}
        return {"run": self._run.id, "total": len(self._results.scenarios), "cancelled": self._run.cancelled, **counts}

    def _take(self, message: RunMessage) -> None:
        self._results.apply(message)
        match message:
            case ScenarioStarted(index):
                self._scenario(index)
            case ClauseJudged():
                self._judge(message)
            case UserCodeFailed(index, fault):
                self._fault(index, fault)
            case ScenarioFinished(index):
                self._scenario(index).finished = True
                self._report_progress()
            case _:
                pass
        self._ls.protocol.notify(RUN_MESSAGE, for_client(self._run.id, self._plan, self._results, message))

    def _scenario(self, index: int) -> JudgedScenario:
        found = self._run.judged.get(index)
        if found is None:
            spec, digests = self._results.scenarios[index].spec, self._plan.digests
            execution = "" if spec.execution is None else spec.execution.iri
            found = self._run.judged[index] = JudgedScenario(
                self._plan.request.name,
                spec.variant,
                spec.variation,
                values_words(spec),
                digests.variants.get(spec.variant, ""),
                digests.rows.get((spec.variant, spec.variation), ""),
                run=self._place.number,
                index=index,
                execution=execution,
                execution_digest=digests.executions.get(execution, ""),
            )
            begun = self._begun.setdefault(spec.variant, set())
            if (spec.variation, execution) not in begun:
                # Until it is executed again, a scenario keeps the result that it had.
                begun.add((spec.variation, execution))
                self._ls.results.drop(spec.variant, spec.variation, execution)
            self._ls.results.add([found])
        return found

    def _fault(self, index: int | None, fault: Fault) -> None:
        """Keep an error in users' code with the scenario that it spoils, or with all."""
        if index is None:
            self._shared_fault = fault.id
        for spoilt in range(len(self._results.scenarios)) if index is None else (index,):
            scenario = self._scenario(spoilt)
            scenario.faults = (*scenario.faults, fault)
        self._ls.show_results(self._plan.uris)

    def _drop_unjudged(self) -> None:
        """Forget scenarios that a cancelled run began, and no clause of which was judged."""
        for scenario in self._run.judged.values():
            if not scenario.finished and not scenario.clauses:
                self._ls.results.discard(scenario)

    def _judge(self, message: ClauseJudged) -> None:
        clause = clause_at(self._results, message.index, message.line)
        # What a cancelled run left open is unknown in its report, but no result.
        if clause is None or message.reason == CANCELLED:
            return
        outcome = Outcome(message.verdict)
        undefined = outcome is Outcome.UNKNOWN and message.reason.startswith(NO_STEP)
        judgement = Judgement(
            clause.name,
            "undefined" if undefined else str(outcome),
            margin(message.robustness, message.unit),
            _BADNESS[outcome] + (message.robustness or 0.0),
            verdict_words(message),
            self._plan.digests.clauses.get(clause.iri, ""),
            message.line,
            fault=message.fault or (self._shared_fault if outcome is Outcome.UNKNOWN else ""),
        )
        self._scenario(message.index).judge(clause.iri, judgement)
        self._ls.show_results(self._plan.uris)

    def _report_progress(self) -> None:
        finished = [scenario for scenario in self._results.scenarios if scenario.finished is not None]
        failed = sum(scenario.verdict is not Outcome.HOLDS for scenario in finished)
        self._progress.report(len(finished), failed, len(self._results.scenarios))

    def _told(self) -> str:
        told = f"{self._results.count(Outcome.HOLDS)} of {len(self._results.scenarios)} scenarios hold"
        return f"cancelled: {told}" if self._run.cancelled else told


async def _record(ls: RobbddServer, place: StoredRun) -> list[str]:
    """Picture the violations of a run into its folder and return the pictures' URIs."""
    pictures = place.folder / PICTURES
    try:
        await asyncio.to_thread(render_moments, place.folder, pictures)
    except NoPictures as error:
        ls.tell(f"there are no pictures: {error}")
        return []
    return [path_to_uri(path) for path in sorted(pictures.glob("*.png"))]


def _begin_recording(place: StoredRun, plan: RunPlan, policy: Policy) -> tuple[Recording, Manifest]:
    """Prepare the folder of a run and write down what is run; raises ``OSError``."""
    request = plan.request
    try:
        manifest = prepare_all([request], request.name, request.seed, place.folder, True)
        recording = Recording(place, manifest)
    except BaseException:
        place.discard()
        raise
    path = uri_to_path(request.name)
    shown, start = (request.name,) * 2 if path is None else (shown_path(path), origin(path, place.folder))
    files = digests(manifest, place.folder)
    record = RunRecord(shown, start, plan.digest, request.seed, __version__, files=files)
    try:
        recording.begin(record, policy, prepared_digest(place.folder))
        place.write_record(record)
    except BaseException:
        recording.close()
        raise
    return recording, manifest
