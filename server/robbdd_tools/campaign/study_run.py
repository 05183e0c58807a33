"""Execute a study batch by batch. A resumed study has the same results as an uninterrupted one."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from time import monotonic
from typing import TYPE_CHECKING, Self

from robbdd_tools import __version__
from robbdd_tools.base.locks import acquire
from robbdd_tools.campaign.coverage_universe import coverage_universe, universe_text
from robbdd_tools.campaign.study_batches import Batch, batches
from robbdd_tools.campaign.study_changes import changed_files, changed_study, used_files
from robbdd_tools.campaign.study_place import BATCHES, StudyProblem
from robbdd_tools.campaign.study_progress import StudyProgress, Tally, WorkerState
from robbdd_tools.campaign.study_traces import MEGABYTE, keep_traces, traces_in, trim_traces
from robbdd_tools.protocol.messages import LogLine, ScenarioFinished
from robbdd_tools.run.database import DatabaseProblem
from robbdd_tools.run.report import values_words
from robbdd_tools.run.store import LOCK, NoSuchRun, begin_in, run_in
from robbdd_tools.run.stored_results import FINISHED
from robbdd_tools.run.study_store import StudyStore
from robbdd_tools.workbench.recorded_requirements import requirements_text
from robbdd_tools.workbench.resuming import resume
from robbdd_tools.workbench.run import Run

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.campaign.stopping import Ruling
    from robbdd_tools.campaign.study_file import Study
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.run.results import RunResults
    from robbdd_tools.run.run_policy import Policy
    from robbdd_tools.run.store import StoredRun

LOCKING = 1.0
"""Seconds to wait for the lock of a study."""
AGAIN = "start it again with --restart, which removes its results"


class StudyRun:
    """A study in progress. Use it as a context manager and iterate over ``progress`` once.

    Afterwards, ``ending`` is the reason why executions are open. It is empty if the study is complete or if its rule
    has stopped it (``ruling``).
    """

    def __init__(self, study: Study, folder: Path, policy: Policy, *, resumed: bool) -> None:
        self._study = study
        self._folder = folder
        self._policy = replace(policy, timeout=study.timeout)
        self._run: Run | None = None
        self._reason = ""
        self._draining = ""
        self.ending = ""
        self.tally = Tally()
        self.warned: Callable[[str], None] = lambda _: None
        """Called with each warning of an agent, such as a trace that could not be written."""
        self.batches = batches(study)
        self.total = sum(batch.size for batch in self.batches)
        folder.mkdir(parents=True, exist_ok=True)
        # A process that asks whether the study is executed holds the lock for a moment.
        lock = acquire(folder / LOCK, LOCKING)
        if lock is None:
            raise StudyProblem("another process executes this study: `robbdd study status` shows its progress")
        self._lock = lock
        try:
            self.store = StudyStore(folder)
        except BaseException:
            lock.release()
            raise
        try:
            self._check(resumed=resumed)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the store. Finished executions are kept."""
        self.store.close()
        self._lock.release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def ruling(self) -> Ruling | None:
        """Return the decision of the study's rule on all stored executions; ``None`` without a decision or a rule."""
        finished, holding = self._stored()
        return None if self._study.stop is None else self._study.stop.ruling(holding, finished)

    def cancel(self, reason: str) -> None:
        """End the study within half a second. It may be called from any thread or signal handler."""
        self._reason = self._reason or reason
        if self._run is not None:
            self._run.cancel(reason)

    def drain(self, reason: str) -> None:
        """Finish the executions in progress, and begin no other. Any thread or signal handler may call it."""
        self._draining = self._draining or reason
        if self._run is not None:
            self._run.drain(reason)

    def workers(self) -> list[WorkerState]:
        """Return what each worker does now. Any thread may call it."""
        run = self._run
        if run is None:
            return []
        specs = run.manifest.scenarios
        found = ((one, specs[one.index]) for one in run.work)
        return [
            WorkerState(f"process {one.number}", f"{spec.name}  {values_words(spec)}", one.seconds)
            for one, spec in found
        ]

    def progress(self) -> Iterator[StudyProgress]:
        """Execute the open batches. Yield the progress after each execution.

        Raises ``StudyProblem``, ``OSError``, ``UserCodeRefused`` and ``NothingSelected``.
        """
        done = self._removed_batches()
        self.tally = Tally.of(self.store)
        began, made = monotonic(), 0
        for batch in self.batches:
            if batch.number in done:
                continue
            if self._decided(batch):
                return
            self.ending = self._reason or self._draining
            if self.ending:
                return
            for _ in self._execute(batch):
                made += 1
                yield StudyProgress(self.total, self.tally, made / max(monotonic() - began, 1e-9), made)
            if self.ending:
                return

    def _removed_batches(self) -> frozenset[int]:
        """Return the numbers of the stored batches. Remove leftovers of their folders, but keep the traces."""
        done = self.store.batches()
        for place in filter(lambda one: one.folder.exists(), map(self._place, sorted(done))):
            with suppress(NoSuchRun, DatabaseProblem):
                results = place.read_results()
                if results is not None:
                    self._keep_traces(int(place.folder.name), results)
            shutil.rmtree(place.folder, ignore_errors=True)
        return done

    def _begins_stage(self, batch: Batch) -> bool:
        """Return whether a batch is the first one of its stage; false in the first stage."""
        return batch.stage > 1 and self.batches[batch.number - 2].stage != batch.stage

    def _decided(self, batch: Batch) -> bool:
        """Return whether the rule stops the study before this batch. It can do so only at the beginning of a stage."""
        rule = self._study.stop
        if rule is None or not self._begins_stage(batch):
            return False
        earlier = [one.number for one in self.batches if one.stage < batch.stage]
        counted = [(total, holding) for number, total, holding in self.store.outcomes() if number <= earlier[-1]]
        totals = (sum(column) for column in zip(*counted, strict=True))
        total, holding = totals if counted else (0, 0)
        return rule.ruling(holding, total) is not None

    def _execute(self, batch: Batch) -> Iterator[None]:
        """Execute a batch and store its results. Yield after each execution."""
        place = self._place(batch.number)
        if self._is_finished(place):
            results = place.read_results()
            self.tally.add_finished([] if results is None else results.scenarios)
        else:
            with self._started(batch, place) as run:
                self._check_files(batch, place)
                self.tally.add_finished(run.progress.scenarios)
                yield from self._follow(run)
            if self.ending:
                return
        self._store(batch, place)

    def _follow(self, run: Run) -> Iterator[None]:
        """Execute the open executions of a run. Yield after each of them."""
        self._run = run
        # A request to end may have arrived before there was a run.
        if self._draining:
            run.drain(self._draining)
        if self._reason:
            run.cancel(self._reason)
        for message in run.messages():
            if isinstance(message, ScenarioFinished):
                self.tally.add(run.progress.scenarios[message.index])
                yield
            else:
                self._warn(message)
        self._run = None
        # If a batch is complete in spite of a request to end, it is stored first.
        self.ending = run.problem or ("" if run.progress.complete else self._reason or self._draining or run.ending)

    def _warn(self, message: RunMessage) -> None:
        if isinstance(message, LogLine) and message.level != "info":
            self.warned(message.text)

    def _store(self, batch: Batch, place: StoredRun) -> None:
        """Move the results of a finished batch to the study's store."""
        results = place.read_results()
        if results is None or not all(one.finished is not None for one in results.scenarios):
            raise StudyProblem(f"batch {batch.number} has executions without a result")
        self._check_simulator(place)
        self.store.add(batch.number, batch.cell.words, batch.cell.levels, results)
        self._keep_traces(batch.number, results)
        shutil.rmtree(place.folder, ignore_errors=True)

    def _keep_traces(self, batch: int, results: RunResults) -> None:
        wanted = self._study.content.traces
        if wanted is not None:
            keep_traces(self._folder, self._place(batch).folder, results.scenarios, self.store.numbers(batch), wanted)
            trim_traces(self._folder, self.store.failing(traces_in(self._folder)), wanted.limit * MEGABYTE)

    def _is_finished(self, place: StoredRun) -> bool:
        """Return whether a batch was executed, but its results are not yet in the study's store."""
        try:
            return place.began and place.status().state == FINISHED
        except NoSuchRun:
            return False

    def _started(self, batch: Batch, place: StoredRun) -> Run:
        if place.began:
            try:
                known = place.status().total == batch.size
            except NoSuchRun:
                known = False
            if known:
                return resume(place, lambda _: self._policy)
        shutil.rmtree(place.folder, ignore_errors=True)
        begun, traces = begin_in(place.folder, kept=False), self._study.content.traces is not None
        return Run.begin(batch.plan(), begun, self._policy, repeat=self._study.repeat, traces=traces)

    def _place(self, number: int) -> StoredRun:
        # A batch is moved to the study's store, so it is not kept.
        return run_in(self._folder / BATCHES / str(number), kept=False)

    def _stored(self) -> tuple[int, int]:
        counted = list(self.store.outcomes())
        return sum(total for _, total, _ in counted), sum(holding for _, _, holding in counted)

    def _check(self, *, resumed: bool) -> None:
        digest = self.store.fact("digest")
        if digest is None:
            if resumed:
                raise StudyProblem("the study was never begun: `robbdd study run` begins it")
            facts = {"digest": self._study.digest, "version": __version__}
            facts |= {"name": self._study.name, "total": str(self.total)}
            facts |= {"requirements": requirements_text(self._study.requirements)}
            self.store.note({**facts, "coverable": universe_text(coverage_universe(self._study))})
        elif not resumed:
            finished, _ = self._stored()
            what = f"has {finished} of {self.total} executions"
            raise StudyProblem(f"the study {what}: continue it with `robbdd study resume`, or {AGAIN}")
        elif reason := changed_study(self._study, self.store):
            raise StudyProblem(f"{reason}, or {AGAIN}")

    def _check_files(self, batch: Batch, place: StoredRun) -> None:
        """Refuse a batch if users' files have changed since the earlier batches of its cell."""
        files = used_files(place)
        name = f"files {batch.cell.words}"
        known = self.store.fact(name)
        if known is None:
            self.store.note({name: json.dumps(files, sort_keys=True)})
        elif reason := changed_files(json.loads(known), files):
            raise StudyProblem(f"{reason}, or {AGAIN}")

    def _check_simulator(self, place: StoredRun) -> None:
        simulator, known = place.status().simulator, self.store.fact("simulator")
        if known is None:
            self.store.note({"simulator": simulator})
        elif known != simulator:
            raise StudyProblem(f"the study began with the simulator {known}, and this is {simulator}: {AGAIN}")
