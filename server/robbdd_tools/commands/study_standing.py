"""Print the state of a study: its pass rate so far, with its interval, and the clause that fails most often."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.campaign.factor_rates import LevelRate
from robbdd_tools.campaign.study_clauses import clause_words
from robbdd_tools.commands.rate_lines import level_line
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.workbench.time_estimate import TimeEstimate

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_progress import StudyProgress, Tally


def standing(tally: Tally) -> Iterator[str]:
    """Yield the lines about the verdicts so far; none before the first verdict."""
    if not tally.finished:
        return
    yield level_line(LevelRate("all executions", tally.holding, tally.finished))
    worst = tally.worst()
    if worst is not None:
        name, counts = worst
        failing = f"{counts[Outcome.VIOLATED]} violated and {counts[Outcome.UNKNOWN]} unknown"
        yield f"worst clause: {clause_words(name)}, {failing} of {counts.total()}"


def progress_words(progress: StudyProgress) -> str:
    """Return the number of finished executions, the rate, and the remaining time, in words."""
    counted = f"{progress.finished:,} of {progress.total:,} executions"
    if progress.left is None:
        return counted
    return f"{counted}, {progress.rate:.1f} per second, about {_left(progress).duration} left"


def measured_words(progress: StudyProgress) -> str:
    """Return the remaining executions and their time, measured from the first ones, in words."""
    first = f"the first {progress.made} execution{'' if progress.made == 1 else 's'}"
    return f"{_left(progress)} left, measured on {first}"


def _left(progress: StudyProgress) -> TimeEstimate:
    return TimeEstimate(progress.total - progress.finished, progress.left, progress.made)
