"""Execute single scenarios of a run in the order in which a test runner asks for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.protocol.messages import ClauseJudged, LogLine, Output, UserCodeFailed
from robbdd_tools.run.recording import OtherSimulator, Recording, failure_reason
from robbdd_tools.run.results import RunResults
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.run.scheduler import Scheduler
from robbdd_tools.workbench.execution_rows import ExecutionResult, execution_result
from robbdd_tools.workbench.run import begin_recording

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.protocol.messages import RunMessage
    from robbdd_tools.protocol.specs import Manifest
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.plan import Plan


class CannotRecord(RobbddError):
    """Results can no longer be stored. The message gives the reason."""


@dataclass(frozen=True, slots=True)
class Executed:
    """The result of one execution.

    - ``faults``: the errors in users' code that left clauses unknown.
    - ``output``: the lines that users' code printed.
    - ``log``: the warnings and errors of the agent.
    """

    result: ExecutionResult
    faults: tuple[Fault, ...]
    output: tuple[str, ...]
    log: tuple[str, ...]


class OnDemand:
    """Executes scenarios of a prepared run one at a time, in one agent process that is reused.

    Use it as a context manager; leaving the context ends the agent. ``begin`` begins a run, ``join`` joins a run that
    another process has begun, and ``end_run`` ends it. ``first_agent`` is the number of the first agent. It must be
    different in each process that executes scenarios of the run.
    """

    def __init__(self, place: StoredRun, recording: Recording, timeout: float | None = None, first_agent: int = 1):
        self.place = place
        self._recording = recording
        policy = Policy.of(jobs=1, timeout=timeout)
        self._scheduler = Scheduler(place.folder, self.manifest, policy, self._take, first_agent=first_agent)
        self._results = RunResults(self.manifest)
        self._shared_faults: list[Fault] = []
        self._listener: Callable[[RunMessage], None] | None = None
        self._problem = ""

    @classmethod
    def begin(
        cls,
        plan: Plan,
        place: StoredRun,
        *,
        repeat: int | None = None,
        timeout: float | None = None,
        models: Sequence[Path] = (),
        first_agent: int = 1,
        processes: int = 1,
    ) -> Self:
        """Begin the run of a plan in a run folder that the caller has created.

        Raises the errors of ``begin_recording``. ``processes`` is the number of processes that will execute scenarios
        of the run.
        """
        policy = Policy.of(jobs=processes, timeout=timeout)
        recording = begin_recording(plan, place, policy, repeat=repeat, models=models)
        return cls(place, recording, timeout, first_agent)

    @classmethod
    def join(cls, place: StoredRun, *, timeout: float | None = None, first_agent: int = 1) -> Self:
        """Join a run that another process has begun. Raises ``NoSuchRun`` and ``OSError``."""
        return cls(place, Recording(place, place.manifest()), timeout, first_agent)

    @property
    def manifest(self) -> Manifest:
        """The manifest of the run. ``execute`` takes the positions of its scenarios."""
        return self._recording.manifest

    def execute(self, index: int) -> Executed:
        """Execute a scenario and return its result after it is stored. Raises ``CannotRecord``.

        Clauses without a verdict are unknown, for example because the agent died. If the scenario was already executed,
        it is executed again and its result is replaced.
        """
        faults: list[Fault] = []
        output: list[str] = []
        log: list[str] = []

        def collect(message: RunMessage) -> None:
            match message:
                case UserCodeFailed(None, fault):
                    # Code that all scenarios share fails once in each agent process.
                    self._shared_faults.append(fault)
                case UserCodeFailed(_, fault):
                    faults.append(fault)
                case Output(_, text):
                    output.extend(text.split("\n"))
                case LogLine(level, text) if level != "info":
                    log.append(text)
                case _:
                    self._results.apply(message)

        if self._problem:
            raise CannotRecord(self._problem)
        self._results.scenarios[index].judged.clear()
        self._results.scenarios[index].finished = None
        self._listener = collect
        try:
            self._recording.forget(index)
            for _ in self._scheduler.execute(index):
                pass
        except OtherSimulator as error:
            self._problem = str(error)
        except OSError as error:
            self._problem = failure_reason(error)
        if self._problem:
            raise CannotRecord(self._problem)
        self._leave_unknown(index)
        result = execution_result(index, self._results.scenario_json(index))
        if result.verdict is Outcome.UNKNOWN:
            faults.extend(fault for fault in self._shared_faults if fault not in faults)
        return Executed(result, tuple(faults), tuple(output), tuple(log))

    def close(self) -> None:
        """End the agent and release the database. The run itself does not end."""
        self._scheduler.close()
        self._recording.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _take(self, message: RunMessage) -> None:
        self._recording.take(message)
        if self._listener is not None:
            self._listener(message)

    def _leave_unknown(self, index: int) -> None:
        """Set the verdicts of clauses to *unknown* because their scenario was not executed."""
        scenario = self._results.scenarios[index]
        if scenario.finished is not None:
            return
        reason = self._scheduler.ending or "the scenario was not executed"
        for clause in scenario.spec.clauses:
            if clause.line not in scenario.judged:
                self._results.apply(ClauseJudged(index, clause.line, Outcome.UNKNOWN, None, "", None, reason))


def end_run(place: StoredRun, ending: str) -> RunResults:
    """End a run and return its results. Raises ``NoSuchRun`` and ``OSError``.

    ``ending`` is the reason why scenarios that were not executed are unknown. If there are such scenarios, the run can
    be resumed.
    """
    recording = Recording(place, place.manifest())
    try:
        return recording.end(ending, interrupted=True)
    finally:
        recording.close()
