"""Execute one run. Agents execute a prepared folder, and each finished execution is stored before it is shown."""

from __future__ import annotations

import asyncio
import tempfile
import threading
from collections.abc import AsyncIterator, Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Self

from robbdd_tools import __version__
from robbdd_tools.graph.verified_requirements import merged_links
from robbdd_tools.protocol.messages import ScenarioFinished
from robbdd_tools.run.debugging import debugged
from robbdd_tools.run.recording import OtherSimulator, Recording, failure_reason
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import CANCELLED, Scheduler
from robbdd_tools.run.store import RunRecord, relative_model_path, shown_path
from robbdd_tools.run.used_files import digests, prepared_digest
from robbdd_tools.run.user_code import refuse_mappers, refuse_user_code
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_result, execution_results
from robbdd_tools.workbench.judged_text import write_texts
from robbdd_tools.workbench.recorded_requirements import write_requirements
from robbdd_tools.workbench.stored import Recorded

if TYPE_CHECKING:
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.protocol.pauses import DebugOrder
    from robbdd_tools.protocol.specs import Manifest
    from robbdd_tools.run.agent_worker import Busy
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.plan import Plan

Listener = Callable[["RunMessage"], None]
Reason = str
"""Why executions were left open; empty if none was."""


class Run(Recorded):
    """A run in progress. Use it as a context manager, synchronous or asynchronous.

    Consume it once, in one of three ways: iterate over it to get results as executions finish, iterate over
    ``messages`` to get messages in the order of the manifest, or call ``wait``. ``cancel`` may be called from any
    thread. Leaving the context cancels open executions and keeps finished ones. Then ``ending`` is the reason why
    executions were left open; it is empty for a complete run. ``problem`` is the reason why the run could not continue,
    for example a full disk.
    """

    def __init__(
        self,
        place: StoredRun,
        policy: Policy,
        recording: Recording,
        results: RunResults,
        indices: Sequence[int] | None = None,
        on_close: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__(place)
        self._manifest = results.manifest
        self._recording = recording
        self._listeners: list[Listener] = []
        self._scheduler = Scheduler(place.folder, results.manifest, policy, self._take, indices)
        self.open_indices = tuple(range(len(results.manifest.scenarios)) if indices is None else indices)
        """The numbers of the scenarios that were open when the run was begun or resumed."""
        self._on_close = on_close
        self._reason = ""
        self._draining = ""
        self._thread: threading.Thread | None = None
        self._closed = False
        self.progress = results
        """The known results; replaced by the stored results when the run ends."""
        self.ending = ""
        """Why executions were left open; empty for a complete run."""
        self.problem = ""
        """Why the run could not continue, such as a full disk; else empty."""

    @classmethod
    def begin(
        cls,
        plan: Plan,
        place: StoredRun,
        policy: Policy,
        *,
        seed: int | None = None,
        repeat: int | None = None,
        traces: bool | None = None,
        on_close: Callable[[], None] = lambda: None,
    ) -> Self:
        """Prepare the run of a plan in a run folder. If this fails, the folder is removed.

        ``traces`` says whether agents write traces; by default, they do if the run is kept.
        Raises ``OSError``, ``NothingSelected`` and ``UserCodeRefused``.
        """
        try:
            recording = begin_recording(plan, place, policy, seed=seed, repeat=repeat, traces=traces)
        except BaseException:
            if place.number:
                place.discard()
            on_close()
            raise
        return cls(place, policy, recording, RunResults(recording.manifest), on_close=on_close)

    @property
    def manifest(self) -> Manifest:
        """The scenarios that the agents execute."""
        return self._manifest

    def listen(self, listener: Listener) -> None:
        """Call ``listener`` with every message on arrival. It is called in the thread that consumes the run."""
        self._listeners.append(listener)

    def cancel(self, reason: str = CANCELLED) -> None:
        """End the run within half a second.

        Finished executions are kept, and open clauses are unknown for ``reason``.
        """
        self._reason = self._reason or reason
        self._scheduler.cancel()

    def drain(self, reason: str) -> None:
        """Finish the executions in progress, and begin no other. Any thread or signal handler may call it."""
        self._draining = self._draining or reason
        self._scheduler.drain()

    @property
    def work(self) -> list[Busy]:
        """The busy agent processes."""
        return self._scheduler.work

    def order(self, order: DebugOrder) -> None:
        """Send an order of a debugger to the run's processes. This may be called from any thread."""
        self._scheduler.order(order)

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages of the run in the order of the manifest.

        Each is yielded after ``progress`` has applied it.
        """
        try:
            for message in self._scheduler.messages():
                if self._recording.is_new(message):
                    self.progress.apply(message)
                    yield message
            ending = self._scheduler.ending
            self.ending = self._reason or (self._draining if ending == CANCELLED else "") or ending
        except GeneratorExit:
            self.ending = self._reason = self._reason or CANCELLED
            raise
        except OtherSimulator as error:
            self.ending = self.problem = str(error)
        except OSError as error:
            self.ending = self.problem = failure_reason(error)
        finally:
            self._conclude()

    def receive(self, messages: Iterable[RunMessage], host: str) -> None:
        """Record messages about executions of another machine, called ``host``, instead of executing scenarios here.

        Raises ``OSError``, and ``OtherSimulator`` if the machine does not simulate as the run did before.
        """
        for message in messages:
            if self._recording.take(message, host):
                self.progress.apply(message)

    def conclude(self, ending: Reason) -> None:
        """End a run whose messages were received."""
        self.ending = ending
        self._conclude()

    def wait(self) -> Self:
        """Execute all scenarios, and return the run."""
        for _ in self.messages():
            pass
        return self

    def __iter__(self) -> Iterator[ExecutionResult]:
        """Yield the result of each execution as it finishes, in any order."""
        finished: SimpleQueue[ExecutionResult | BaseException | None] = SimpleQueue()
        known = RunResults(self._manifest)

        def collect(message: RunMessage) -> None:
            known.apply(message)
            if isinstance(message, ScenarioFinished):
                finished.put(execution_result(message.index, known.scenario_json(message.index)))

        def consume() -> None:
            try:
                self.wait()
            except BaseException as error:  # raised again in the thread that iterates
                finished.put(error)
            finished.put(None)

        self.listen(collect)
        self._thread = threading.Thread(target=consume, daemon=True)
        self._thread.start()
        while (result := finished.get()) is not None:
            if isinstance(result, BaseException):
                raise result
            yield result

    async def __aiter__(self) -> AsyncIterator[ExecutionResult]:
        """Yield results as ``__iter__`` does, but without blocking the event loop."""
        results = iter(self)
        while (result := await asyncio.to_thread(next, results, None)) is not None:
            yield result

    @property
    def results(self) -> tuple[ExecutionResult, ...]:
        """The results of all executions in the order of the manifest.

        Scenarios that are not yet executed are executed now.
        """
        if self._thread is not None:
            self._thread.join()
        elif not self._closed and not self.ending and not self.progress.complete:
            self.wait()
        return execution_results(self.progress.as_json())

    def close(self) -> None:
        """Cancel open executions and release the store."""
        if self._closed:
            return
        self.cancel()
        if self._thread is not None:
            self._thread.join()
        self._closed = True
        self._recording.close()
        self._on_close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        await asyncio.to_thread(self.close)

    def _take(self, message: RunMessage) -> None:
        if self._recording.take(message):
            for listener in self._listeners:
                listener(message)

    def _conclude(self) -> None:
        """Record the end of the run. The stored results replace ``progress``."""
        try:
            self.progress = self._recording.end(self.ending, interrupted=bool(self._reason or self._draining))
        except OSError as error:
            self.problem = self.problem or failure_reason(error)
            # An execution that could not be stored is executed again when the run is resumed.
            self.progress.drop_unfinished()
            self.progress.close(self.problem)
        self.ending = self.progress.ending


def begin_run(
    plan: Plan,
    place: StoredRun,
    *,
    repeat: int | None = None,
    jobs: int | None = None,
    stop_on_failure: bool = False,
    debug: int | None = None,
) -> Run:
    """Prepare the run of a plan in a run folder that the caller has created. Raises the errors of ``Run.begin``.

    With ``debug``, the process that executes it waits for a debugger on this port.
    """
    policy = Policy.of(jobs=jobs, stop_on_failure=stop_on_failure)
    return Run.begin(plan, place, policy if debug is None else debugged(policy, debug), repeat=repeat)


def check_user_code(plan: Plan) -> None:
    """Raise ``UserCodeRefused`` if a plan would execute users' code that is not permitted.

    Raises ``OSError`` and ``NothingSelected`` as well.
    """
    with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
        refuse_user_code(plan.prepare(Path(folder)), Path(folder))


def begin_recording(
    plan: Plan,
    place: StoredRun,
    policy: Policy,
    *,
    seed: int | None = None,
    repeat: int | None = None,
    traces: bool | None = None,
    models: Sequence[Path] = (),
    log: Path | None = None,
) -> Recording:
    """Write everything that agents need into a run folder, and record the beginning of the run in its database.

    ``traces`` is as in ``Run.begin``. ``models`` are the model files, unless they are all models in the plan's folder.
    ``log`` is the log that is judged, if nothing is simulated. Raises ``OSError``, ``NothingSelected`` and
    ``UserCodeRefused``.
    """
    manifest = plan.prepare(place.folder, seed=seed, repeat=repeat, traces=place.kept if traces is None else traces)
    refuse_user_code(manifest, place.folder)
    if log is not None:
        refuse_mappers(manifest)
    recording = Recording(place, manifest)
    try:
        record = _record(plan, place.folder, manifest, plan.selection.seed if seed is None else seed)
        record = replace(
            record,
            models=tuple(relative_model_path(model, place.folder) for model in models or plan.models),
            log="" if log is None else str(log),
        )
        recording.begin(record, policy, prepared_digest(place.folder))
        place.write_record(record)
        write_texts(plan.texts, place.folder)
        write_requirements(merged_links(file.requirements for file in plan.files), place.folder)
    except BaseException:
        recording.close()
        raise
    return recording


def _record(plan: Plan, folder: Path, manifest: Manifest, user_seed: int | None) -> RunRecord:
    """Return the record of a run. A model without a file is recorded by its name."""
    path = plan.path
    shown, start = (plan.name, plan.name) if path is None else (shown_path(path), relative_model_path(path, folder))
    files = digests(manifest, folder)
    return RunRecord(shown, start, plan.digest, manifest.seed, __version__, files=files, user_seed=user_seed)
