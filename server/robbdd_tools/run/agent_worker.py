"""An agent process as the scheduler sees it: what it executes and until when."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import inf
from time import monotonic

from robbdd_tools.run.launch import Agent

STARTUP = 120.0
"""Seconds of wall time that a process has from its start, or from an order, until it starts with the scenario."""


@dataclass(slots=True, eq=False)
class AgentWorker:
    """An agent, the scenario that it is at, and the instant until which it must have finished or begun with it.

    ``following`` are the scenarios that it does next, because they share the execution of this one.
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

    def employ(self, task: Iterable[int]) -> None:
        """Give it scenarios to execute, one after the other."""
        self.following = deque(task)
        self.index = index = self.following.popleft()
        self.started = self.failed = False
        self.judged = set()
        self.deadline = monotonic() + STARTUP
        self.agent.execute(index)

    def release(self) -> None:
        """Let it go on with what follows; else take note that it has nothing to do."""
        self.index, self.deadline, self.started = None, inf, False
        if self.following:
            self.employ(self.following)

    def expire(self) -> None:
        """End it because it missed its deadline."""
        self.timed_out, self.deadline = True, inf
        self.agent.kill()
