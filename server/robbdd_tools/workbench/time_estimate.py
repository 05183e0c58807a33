"""Estimate the duration of a run from stored executions of the same variants."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.run.execution_times import Duration, usual_durations
from robbdd_tools.run.run_policy import Policy

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ScenarioSpec

LARGE = 60.0
"""A run that is expected to take at least this many seconds is announced with its estimated duration."""


@dataclass(frozen=True, slots=True)
class TimeEstimate:
    """The estimated duration of a run.

    - ``executions``: the number of executions.
    - ``seconds``: the estimated wall time in s; ``None`` if no variant of the run has a stored execution.
    - ``measured``: the number of stored executions from which the time is estimated.
    """

    executions: int
    seconds: float | None
    measured: int

    @property
    def is_large(self) -> bool:
        """Whether the run is expected to take a minute or longer."""
        return self.seconds is not None and self.seconds >= LARGE

    @property
    def duration(self) -> str:
        """The estimated time in words: ``8 s``, ``2 min``, ``3 h``; empty if it is unknown."""
        if self.seconds is None:
            return ""
        if self.seconds < 60:
            return f"{max(1, round(self.seconds))} s"
        minutes = round(self.seconds / 60)
        return f"{minutes} min" if minutes < 100 else f"{round(self.seconds / 3600)} h"

    @property
    def basis(self) -> str:
        """The source of the estimate, in words."""
        return f"estimated from {self.measured:,} stored execution{'' if self.measured == 1 else 's'}"

    def __str__(self) -> str:
        executions = f"{self.executions:,} execution{'' if self.executions == 1 else 's'}"
        return executions if self.seconds is None else f"{executions}, about {self.duration}"


def estimate(scenarios: Iterable[ScenarioSpec], database: Path, jobs: int | None = None) -> TimeEstimate:
    """Return the estimate for some scenarios. Raises ``DatabaseProblem``.

    A variant that has never been executed is expected to take as long as the others on average. ``jobs`` is the number
    of agent processes, which share the work evenly; by default, that of a run.
    """
    counts = Counter(spec.variant for spec in scenarios)
    return estimate_from(counts, usual_durations(database, counts), jobs)


def estimate_from(counts: Mapping[str, int], known: Mapping[str, Duration], jobs: int | None = None) -> TimeEstimate:
    """Return the estimate for a number of executions of each variant, given the usual durations of some of them."""
    total, measured = sum(counts.values()), sum(duration.executions for duration in known.values())
    covered = sum(counts[iri] for iri in known)
    if not covered:
        return TimeEstimate(total, None, 0)
    work = sum(counts[iri] * duration.seconds for iri, duration in known.items())
    return TimeEstimate(total, work * total / covered / min(Policy.of(jobs=jobs).jobs, total), measured)
