"""One agent process as the scheduler sees it: its scenario and its deadline."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from time import monotonic

from robbdd_tools.monitor.fault import Fault
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    ClauseStarted,
    MarginRanges,
    RunFinished,
    RunMessage,
    ScenarioFinished,
)
from robbdd_tools.protocol.run_folder import STARTUP
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run.launch import Agent
from robbdd_tools.run.message_check import misfit

GRACE = 0.5
"""Seconds that a process has after a deadline to dump its stack before it is killed."""


def grace(limit: float) -> float:
    """Return the seconds that a process has beyond a time limit (s): at most a tenth of the limit."""
    return min(GRACE, limit / 10)


@dataclass(frozen=True, slots=True, order=True)
class Busy:
    """A busy process: its number, the number of its current scenario, and for how many s it has executed it."""

    number: int
    index: int
    seconds: float


@dataclass(slots=True, eq=False)
class AgentWorker:
    """An agent process, its current scenario, and the deadline for starting or finishing that scenario.

    ``number`` counts the processes of a run. ``index`` is the number of the current scenario, and ``since`` the clock
    time in s at which it began. ``following`` are the numbers of the scenarios that the agent executes next because
    they share the execution of the current one.
    """

    agent: Agent
    debugged: bool = False
    number: int = 0
    index: int | None = None
    following: deque[int] = field(default_factory=deque[int])
    deadline: float = inf
    started: bool = False
    since: float = 0.0
    failed: bool = False
    timed_out: bool = False
    complaint: str = "the agent cannot work"
    judged: set[int] = field(default_factory=set[int])
    shared_outputs: int = 0

    def assign(self, task: Iterable[int]) -> None:
        """Assign scenarios to this agent, which executes them one after the other."""
        self.following = deque(task)
        self.index = index = self.following.popleft()
        self.started = self.failed = False
        self.judged = set()
        # A person needs as long as it takes to connect a debugger.
        self.deadline = inf if self.debugged else monotonic() + STARTUP + grace(STARTUP)
        self.agent.execute(index)

    def release(self) -> None:
        """Start the next scenario in ``following``. If there is none, mark the worker idle."""
        self.index, self.deadline, self.started = None, inf, False
        if self.following:
            self.assign(self.following)

    def expire(self) -> None:
        """Kill the agent because it missed its deadline."""
        self.timed_out, self.deadline = True, inf
        self.agent.kill()

    def misfit(self, message: RunMessage, specs: Sequence[ScenarioSpec]) -> str:
        """Return the reason why the agent cannot have sent a message; empty if it may have sent the message."""
        match message:
            case ClauseJudged(line=line) if line in self.judged:
                return f"ignored another verdict on the clause of line {line}"
            case ClauseStarted() | ClauseJudged() | MarginRanges() | ScenarioFinished() if not self.started:
                return f"ignored {type(message).__name__} before the beginning of a scenario"
            case RunFinished() if self.started:
                return "ignored RunFinished within a scenario"
            case _:
                return misfit(message, specs, self.index)

    def fault(self, limit: float, spec: ScenarioSpec | None, sources: Mapping[str, str]) -> Fault | None:
        """Return the error in the user's code that ended the agent process, if any (see ``Crash.fault``).

        ``limit`` is the time limit of the process in s. ``spec`` is the scenario that the process had begun.
        ``sources`` maps copies of files of steps to the originals.
        """
        ended = f"timed out after {limit:g} s" if self.timed_out else f"the process ended with {self.agent.exit()}"
        return self.agent.crash.fault(ended, spec, sources)
