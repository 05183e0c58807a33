"""Scheduler's view of one agent process: its scenario and its deadline."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import inf
from time import monotonic

from robbdd_tools.monitor.fault import Fault
from robbdd_tools.protocol.run_folder import STARTUP
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run.launch import Agent

GRACE = 0.5
"""Seconds that a process has after a deadline to dump its stack before it is killed."""


@dataclass(slots=True, eq=False)
class AgentWorker:
    """An agent, its current scenario and the deadline for starting or finishing it.

    ``following`` are the scenarios that it executes next because they share the current execution.
    """

    agent: Agent
    index: int | None = None
    following: deque[int] = field(default_factory=deque[int])
    deadline: float = inf
    started: bool = False
    failed: bool = False
    timed_out: bool = False
    complaint: str = "the agent cannot work"
    judged: set[int] = field(default_factory=set[int])
    shared_outputs: int = 0

    def assign(self, task: Iterable[int]) -> None:
        """Assign scenarios to execute one after the other."""
        self.following = deque(task)
        self.index = index = self.following.popleft()
        self.started = self.failed = False
        self.judged = set()
        self.deadline = monotonic() + STARTUP + GRACE
        self.agent.execute(index)

    def release(self) -> None:
        """Continue with the following scenario, or mark the worker idle."""
        self.index, self.deadline, self.started = None, inf, False
        if self.following:
            self.assign(self.following)

    def expire(self) -> None:
        """End the worker because it missed its deadline."""
        self.timed_out, self.deadline = True, inf
        self.agent.kill()

    def fault(self, limit: float, spec: ScenarioSpec | None, sources: Mapping[str, str]) -> Fault | None:
        """Return the error in the user's code that ended the process, if any; see ``Crash.fault``.

        ``limit`` is the process's time limit (s), ``spec`` the scenario that it had begun.
        """
        ended = f"timed out after {limit:g} s" if self.timed_out else f"the process ended with {self.agent.exit()}"
        return self.agent.crash.fault(ended, spec, sources)
