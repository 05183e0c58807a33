"""Show a run in the client while it executes: results at the clauses, messages and progress."""

from __future__ import annotations

import asyncio
from collections import Counter
from typing import TYPE_CHECKING, Any

from robbdd_tools.lsp.refresh import LENSES
from robbdd_tools.lsp.run_messages import RUN_MESSAGE, clause_at, for_client
from robbdd_tools.lsp.run_progress import RunProgress
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    LogLine,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
)
from robbdd_tools.run.consequences import Causes, Consequence
from robbdd_tools.run.readable import clause_title, readable
from robbdd_tools.run.results import RunResults
from robbdd_tools.workbench.judged_scenarios import (
    Repetitions,
    judged_scenario,
    judgement,
    project_of,
    with_cause,
)

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.lsp.active_run import ActiveRun
    from robbdd_tools.lsp.run_request import RunText
    from robbdd_tools.lsp.server import RobbddServer
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.workbench.run import Run


class RunFollower:
    """Follows one run. Messages arrive in the thread of the run and are handled in the event loop."""

    def __init__(self, ls: RobbddServer, active: ActiveRun, text: RunText, run: Run) -> None:
        self._ls = ls
        self._active = active
        self._run = run
        self._text = text
        self._project = project_of(text.uri)
        self._progress = RunProgress(ls, active.progress)
        self._results = RunResults(run.manifest)
        self._repetitions = Repetitions(run.manifest.scenarios)
        self._loop = asyncio.get_running_loop()
        self._shared_fault = ""
        self._causes: dict[int, Causes] = {}
        self._ended: dict[int, Outcome] = {}
        self._outcomes: Counter[Outcome] = Counter()
        self._begun: dict[str, set[tuple[int, str, int | None]]] = {}
        run.listen(self._hear)

    async def follow(self) -> None:
        """Execute the run to its end and show it."""
        uris = self._text.places.uris
        await self._progress.begin()
        try:
            await asyncio.to_thread(self._run.wait)
            self._conclude()
        finally:
            self._progress.end(self._outcome())
        if self._run.problem:
            self._ls.warn(self._run.problem)
        self._ls.show_results(uris)
        await self._ls.show_changed()
        await self._ls.stored_verdicts.save()
        self._ls.rejudging.results_changed()
        # A finished run can be replayed.
        self._ls.refreshes.want(LENSES)

    def summary(self) -> dict[str, Any]:
        """Return the outcome of the run, as the answer to the client's request."""
        outcomes = Counter(str(scenario.verdict) for scenario in self._results.scenarios)
        counts = {outcome: outcomes[outcome] for outcome in ("holds", "violated", "unknown")}
        total, cancelled = len(self._results.scenarios), self._active.cancelled
        failed = self._results.first_failure()
        return {"run": self._active.id, "total": total, "cancelled": cancelled, "failed": failed, **counts}

    def _hear(self, message: RunMessage) -> None:
        self._loop.call_soon_threadsafe(self._take, message)

    def _conclude(self) -> None:
        """Close the scenarios that are still open, and remove results that no longer belong to the model."""
        ending = self._run.ending
        stops = self._active.options.stop_on_failure
        first = self._results.first_failure() if stops else None
        for judged in self._results.close(ending):
            self._take(judged, left_open=stops or self._active.cancelled)
        for index, scenario in self._active.judged.items():
            # The store does not keep executions after the first failure, whichever process was faster.
            if first is not None and index > first:
                self._ls.results.discard(scenario)
        if self._active.options.is_whole and not ending:
            for variant, begun in self._begun.items():
                self._ls.results.drop_others(self._project, variant, {number for number, *_ in begun})
        for scenario in self._active.judged.values():
            if not scenario.finished and not scenario.clauses:
                self._ls.results.discard(scenario)
        self._ls.results.drop_deleted(self._text.uri, self._text.variants, self._text.executions)
        for scenario in self._active.judged.values():
            scenario.mark_vacuous(self._results.vacuous())
        self._take(RunFinished(not ending))

    def _take(self, message: RunMessage, *, left_open: bool = False) -> None:
        """Handle a message.

        ``left_open`` is true for a clause that a cancelled run, or a run that stops at the first failure, left open.
        Such a clause is unknown in the report, but its verdict is not stored.
        """
        self._results.apply(message)
        because = None
        if isinstance(message, ClauseJudged):
            because = self._because(message)
            message = readable(message, self._results.scenarios[message.index].spec, self._results.faults)
        match message:
            case ScenarioStarted(index):
                self._scenario(index)
            case ClauseJudged() if not left_open:
                self._judge(message, because)
            case UserCodeFailed(index, fault):
                self._fault(index, fault)
            case ScenarioFinished(index):
                self._scenario(index).finished = True
                self._report_progress(index)
            case _:
                pass
        params = for_client(self._active.id, self._text, self._results, message, cancelled=left_open, because=because)
        self._ls.protocol.notify(RUN_MESSAGE, params)
        if isinstance(message, RunStarted):
            for note in self._text.notes:
                self._take(LogLine("info", note))

    def _scenario(self, index: int) -> JudgedScenario:
        known = self._active.judged.get(index)
        if known is not None:
            return known
        spec, text = self._results.scenarios[index].spec, self._text
        scenario = judged_scenario(
            spec,
            text.uri,
            text.digests,
            self._project,
            run=self._run.number,
            index=index,
            seed=text.seed,
            repetitions=self._repetitions.of(spec),
        )
        self._active.judged[index] = scenario
        # A scenario keeps its older results until it is executed again; repetitions that held are not executed again.
        repetition = spec.repetition if self._active.options.failed else None
        begun = self._begun.setdefault(spec.variant, set())
        if (spec.variation, scenario.execution, repetition) not in begun:
            begun.add((spec.variation, scenario.execution, repetition))
            self._ls.results.drop(scenario.scenario_key, scenario.execution, repetition)
        self._ls.results.add([scenario])
        return scenario

    def _fault(self, index: int | None, fault: Fault) -> None:
        """Store an error in users' code with the scenario that it stopped, or with all of them if it concerns all."""
        if index is None:
            self._shared_fault = fault.id
        for stopped in range(len(self._results.scenarios)) if index is None else (index,):
            scenario = self._scenario(stopped)
            scenario.faults = (*scenario.faults, fault)
        self._ls.show_results(self._text.places.uris)

    def _because(self, message: ClauseJudged) -> Consequence | None:
        clause, spec = (
            clause_at(self._results, message.index, message.line),
            self._results.scenarios[message.index].spec,
        )
        causes = self._causes.setdefault(message.index, Causes())
        return None if clause is None else causes.add(spec.clauses.index(clause), clause_title(clause), message)

    def _judge(self, message: ClauseJudged, because: Consequence | None) -> None:
        clause = clause_at(self._results, message.index, message.line)
        if clause is not None:
            found = judgement(clause, message, self._text.digests, self._shared_fault)
            found = with_cause(found, because, self._results.scenarios[message.index].spec)
            self._scenario(message.index).judge(clause.iri, found)
            self._ls.show_results(self._text.places.uris)

    def _report_progress(self, finished: int) -> None:
        """Count a scenario that has finished. A scenario that finishes again counts once, with its last verdict."""
        if finished in self._ended:
            self._outcomes[self._ended[finished]] -= 1
        self._ended[finished] = self._results.scenarios[finished].verdict
        self._outcomes[self._ended[finished]] += 1
        self._progress.report(self._outcomes, len(self._results.scenarios))

    def _outcome(self) -> str:
        words = f"{self._results.count(Outcome.HOLDS)} of {len(self._results.scenarios)} scenarios hold"
        return f"cancelled: {words}" if self._active.cancelled else words
