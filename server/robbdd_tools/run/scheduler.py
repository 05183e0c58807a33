"""Distribute the scenarios of a run folder among several agent processes.

This module uses the standard library only. It needs to replace a hanging worker and to know which task killed a worker.
Existing process pools can do neither.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from itertools import count
from math import inf
from pathlib import Path
from queue import Empty, SimpleQueue
from time import monotonic

from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.fault_places import sources_in
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    DebuggerAwaited,
    LogLine,
    MarginRanges,
    Output,
    RunFinished,
    RunMessage,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
    never_judged,
)
from robbdd_tools.protocol.pauses import DebugOrder, Paused, SceneWritten, encode_order
from robbdd_tools.protocol.run_folder import STARTUP
from robbdd_tools.protocol.specs import Manifest
from robbdd_tools.run.agent_worker import AgentWorker, Busy, grace
from robbdd_tools.run.launch import Agent, stop
from robbdd_tools.run.message_order import OrderedMessages
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.tasks import earlier_than, grouped

ATTEMPTS = 3
"""The run is given up if this many processes in a row end before they start a scenario."""
CANCELLED = "the run was cancelled"
STOPPED = "not executed: the run was stopped at the first failure"


Event = tuple[AgentWorker, RunMessage | None]


def ignore_event(_: RunMessage) -> None:
    """Ignore the message."""


class Scheduler:
    """Executes the scenarios of a prepared run folder in several processes.

    - ``messages`` yields the messages in the order of the manifest, whatever the number of processes. One thread
      consumes it.
    - ``cancel`` may be called from any thread and from a signal handler.
    - ``watch`` is called with every message on arrival.
    - ``ending`` is the reason why scenarios are open.
    - ``indices`` are the numbers of the scenarios to execute in increasing order; ``None`` executes all.
    - ``first_agent`` is the number of the first process. The numbers name the logs.

    Scenarios that share an execution are sent to the same process, one after the other. Instead of calling
    ``messages``, a caller can execute single scenarios in any order with ``execute``; the processes then stay alive
    until ``close``.
    """

    def __init__(
        self,
        folder: Path,
        manifest: Manifest,
        policy: Policy | None = None,
        watch: Callable[[RunMessage], None] = ignore_event,
        indices: Sequence[int] | None = None,
        first_agent: int = 1,
    ) -> None:
        self._folder = folder
        self._specs = manifest.scenarios
        self._sources = sources_in(folder, manifest.sources)
        self._policy = policy or Policy()
        self._watch = watch
        self._events: SimpleQueue[Event | None] = SimpleQueue()
        self._indices = range(len(self._specs)) if indices is None else indices
        self._waiting = deque(grouped(manifest, self._indices))
        self._workers: list[AgentWorker] = []
        self._order = OrderedMessages(self._indices)
        self._agent_numbers = count(first_agent)
        self._wasted = 0
        self._greeted = False
        self._cancelled = False
        self._draining = False
        self._stopped = False
        self._shared_faults: set[str] = set()
        self._shared_outputs = 0
        self.ending = ""

    @property
    def busy(self) -> dict[int, int]:
        """The number of the current scenario of each busy process, by the number of the process."""
        return {w.agent.pid: w.index for w in list(self._workers) if w.index is not None and w.started}

    @property
    def work(self) -> list[Busy]:
        """The busy processes in the order of their numbers."""
        now = monotonic()
        busy = (one for one in list(self._workers) if one.started)
        return sorted(Busy(w.number, w.index, now - w.since) for w in busy if w.index is not None)

    def drain(self) -> None:
        """Begin no further execution. Those in progress are finished. Any thread or signal handler may call it."""
        self._draining = True
        self._events.put(None)

    def cancel(self) -> None:
        """End the run within half a second; finished results are kept."""
        self._cancelled = True
        self._events.put(None)

    def execute(self, index: int) -> Iterator[RunMessage]:
        """Execute one scenario and yield its messages. Raises ``OSError``.

        If the messages end without ``ScenarioFinished``, the scenario is unfinished and ``ending`` is the reason.
        """
        self._order = OrderedMessages([index])
        self._waiting = deque[tuple[int, ...]]([(index,)])
        yield from self._until_done()

    def order(self, order: DebugOrder) -> None:
        """Send an order of a debugger to all processes. This may be called from any thread."""
        for worker in list(self._workers):
            worker.agent.order(encode_order(order))

    def close(self) -> None:
        """End the processes."""
        stop(worker.agent for worker in self._workers)

    def messages(self) -> Iterator[RunMessage]:
        """Yield the messages of the run; the last one is ``RunFinished``. Raises ``OSError``."""
        complaints: set[str] = set()
        for message in self._messages():
            # Every process, and every scenario of a broken feature, reports the same problem: show it once.
            if isinstance(message, LogLine):
                if message.text in complaints:
                    continue
                complaints.add(message.text)
            yield message
        yield RunFinished(not self.ending)

    def _messages(self) -> Iterator[RunMessage]:
        try:
            yield from self._until_done()
            yield from self._order.finished()
        finally:
            self.close()

    def _until_done(self) -> Iterator[RunMessage]:
        left_out = False
        while not (self._cancelled or self._gave_up) and self._open:
            if self._draining and self._waiting:
                self._waiting.clear()
                left_out = True
                continue
            self._employ()
            event = self._next_event()
            if event is not None and event[0] in self._workers:
                yield from self._take(*event)
        if (self._cancelled and self._open) or (left_out and not self.ending):
            self.ending = CANCELLED

    @property
    def _gave_up(self) -> bool:
        return bool(self.ending) and not self._stopped

    @property
    def _open(self) -> bool:
        return bool(self._waiting) or any(worker.index is not None for worker in self._workers)

    def _employ(self) -> None:
        """Assign waiting scenarios to idle workers; start new workers up to the limit."""
        idle = [worker for worker in self._workers if worker.index is None]
        while self._waiting and (idle or len(self._workers) < self._policy.jobs):
            worker = idle.pop() if idle else self._launch()
            worker.assign(self._waiting.popleft())

    def _launch(self) -> AgentWorker:
        policy, number = self._policy, next(self._agent_numbers)
        agent = Agent(
            self._folder,
            number,
            log_limit=policy.log_limit,
            timeout=policy.timeout,
            debug=policy.debug,
            pausing=policy.pausing,
        )
        worker = AgentWorker(agent, debugged=policy.is_debugged, number=number)
        self._workers.append(worker)
        threading.Thread(target=self._listen, args=(worker,), daemon=True).start()
        return worker

    def _listen(self, worker: AgentWorker) -> None:
        for message in worker.agent.messages():
            self._events.put((worker, message))
        self._events.put((worker, None))

    def _next_event(self) -> Event | None:
        """Wait for the next message or deadline. A worker that misses its deadline is killed.

        Deadlines expire even while messages arrive constantly.
        """
        first = min(self._workers, key=lambda worker: worker.deadline)
        left = first.deadline - monotonic()
        if left <= 0.0:
            first.expire()
        try:
            return self._events.get(timeout=None if left == inf else max(0.0, left))
        except Empty:
            return None

    def _take(self, worker: AgentWorker, message: RunMessage | None) -> Iterator[RunMessage]:
        """Handle a message of a worker, or its end if ``message`` is ``None``.

        A message that the worker cannot have sent is logged and ignored.
        """
        problem = "" if message is None else worker.misfit(message, self._specs)
        if problem:
            message = LogLine("warning", problem)
        match message:
            case None:
                self._workers.remove(worker)
                yield from self._close_ended(worker)
            case RunStarted():
                if not self._greeted:
                    self._greeted = True
                    self._watch(message)
                    yield message
            case RunFinished():
                self.ending = worker.complaint
            case LogLine(level, text):
                worker.complaint = text if level == "error" else worker.complaint
                yield from self._pass_on(worker, message)
            case ScenarioStarted():
                self._wasted = 0
                if not worker.started:
                    worker.started, worker.since = True, monotonic()
                    worker.deadline = worker.since + self._limit + grace(self._limit)
                yield from self._pass_on(worker, message)
            case UserCodeFailed(None, fault):
                # Each process loads the code that all scenarios share.
                if fault.id not in self._shared_faults:
                    self._shared_faults.add(fault.id)
                    self._watch(message)
                    yield message
            case Output(None):
                # Each process loads the same code and prints the same; show only the first one.
                worker.shared_outputs += 1
                if worker.shared_outputs > self._shared_outputs:
                    self._shared_outputs = worker.shared_outputs
                    self._watch(message)
                    yield message
            case ClauseStarted() | MarginRanges() | UserCodeFailed() | Output():
                yield from self._pass_on(worker, message)
            case DebuggerAwaited() | Paused() | SceneWritten():
                yield from self._pass_on(worker, message)
            case ClauseJudged():
                worker.judged.add(message.line)
                worker.failed = worker.failed or message.verdict != Outcome.HOLDS
                yield from self._pass_on(worker, message)
            case ScenarioFinished():
                yield from self._finish(worker, message)

    @property
    def _limit(self) -> float:
        """The wall time in s that a scenario may take."""
        return self._policy.timeout or inf

    def _finish(self, worker: AgentWorker, message: ScenarioFinished) -> Iterator[RunMessage]:
        if worker.failed and self._policy.stop_on_failure:
            self._stop_after(message.index)
        yield from self._pass_on(worker, message)
        worker.release()

    def _stop_after(self, index: int) -> None:
        """Skip the scenarios after number ``index``.

        Earlier scenarios continue, so that the outcome of the run does not depend on timing.
        """
        if index != self._indices[-1]:
            self.ending, self._stopped = STOPPED, True
        self._waiting = deque(earlier for task in self._waiting if (earlier := earlier_than(index, task)))
        self._order.forget(index + 1)
        beyond = [worker for worker in self._workers if worker.index is not None and worker.index > index]
        self._workers = [worker for worker in self._workers if worker not in beyond]
        for worker in self._workers:
            worker.following = deque(earlier_than(index, worker.following))
        stop(worker.agent for worker in beyond)

    def _close_ended(self, worker: AgentWorker) -> Iterator[RunMessage]:
        """Handle a process that has ended.

        The clauses of a scenario that it had started are closed. Scenarios that it had not started are queued again.
        """
        if worker.index is None:
            return
        spec = self._specs[worker.index]
        if worker.started:
            if worker.following:
                self._waiting.appendleft(tuple(worker.following))
                worker.following.clear()
            cause = Cause.TIMED_OUT if worker.timed_out else Cause.PROCESS_ENDED
            fault = worker.fault(self._limit, spec, self._sources)
            late = f"timed out after {self._limit:g} s"
            reason = late if worker.timed_out else worker.agent.ending()
            if fault is not None:
                reason = fault.words
                yield from self._pass_on(worker, UserCodeFailed(worker.index, fault))
            for clause in spec.clauses:
                if clause.line not in worker.judged:
                    worker.failed = True
                    judged = never_judged(worker.index, clause.line, reason, cause, fault)
                    yield from self._pass_on(worker, judged)
            yield from self._finish(worker, ScenarioFinished(worker.index, 0.0, 0.0, 0.0))
            return
        self._wasted += 1
        self._waiting.appendleft((worker.index, *worker.following))
        if self._wasted == ATTEMPTS:
            late = f"the agent process did not begin within {STARTUP:g} s"
            fault = worker.fault(STARTUP, None, self._sources)
            self.ending = late if worker.timed_out else worker.agent.ending()
            if fault is not None:
                self.ending = fault.words
                self._watch(failed := UserCodeFailed(None, fault))
                yield failed

    def _pass_on(self, worker: AgentWorker, message: RunMessage) -> Iterator[RunMessage]:
        self._watch(message)
        if worker.index is None:
            yield message
        else:
            yield from self._order.take(worker.index, message)
