"""Print the state of a study: its pass rate so far, with its interval, and the clause that fails most often."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.campaign.factor_rates import LevelRate
from robbdd_tools.campaign.study_clauses import clause_words
from robbdd_tools.commands.rate_lines import level_line
from robbdd_tools.monitor.verdict import Outcome

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


def measured_words(progress: StudyProgress) -> str:
    """Return the remaining executions and their time, measured from the first ones, in words."""
    first = f"the first {progress.made} execution{'' if progress.made == 1 else 's'}"
    return f"{progress.expected} left, measured on {first}"
