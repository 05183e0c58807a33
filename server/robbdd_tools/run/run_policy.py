"""How a run is executed: processes, time limits, logs, debuggers."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from typing import Self

from robbdd_tools.run.agent_log import LIMIT

TIMEOUT = 300.0
"""Default wall time of a scenario, s."""


@dataclass(frozen=True, slots=True)
class Policy:
    """The policy of a run.

    It states the number of parallel processes, the limit of wall time for each scenario in s, and whether the first
    failure ends the run. ``log_limit`` is the maximum size of each process's log in bytes. It also states the port of a
    debugger of Python code, and whether a debugger controls the ``pausing`` of executions.
    """

    jobs: int = field(default_factory=lambda: os.cpu_count() or 1)
    timeout: float = TIMEOUT
    stop_on_failure: bool = False
    log_limit: int = LIMIT
    debug: int | None = None
    pausing: bool = False

    @property
    def is_debugged(self) -> bool:
        """Whether a person debugs the run, so that there is no time limit."""
        return self.debug is not None or self.pausing

    @classmethod
    def of(cls, *, jobs: int | None = None, timeout: float | None = None, stop_on_failure: bool = False) -> Self:
        """Return a policy in which every argument that is ``None`` has its default value."""
        policy = cls(stop_on_failure=stop_on_failure)
        policy = policy if jobs is None else replace(policy, jobs=jobs)
        return policy if timeout is None else replace(policy, timeout=timeout)
