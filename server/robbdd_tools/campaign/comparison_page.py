"""A comparison as one HTML page: clauses, and the executions that flipped with both replays side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.campaign.comparison_text import HEADER, cells, conclusion, deciding_clauses, method_words, moved_words
from robbdd_tools.campaign.report_moments import MOST_MOMENTS, first_violation, instant_of
from robbdd_tools.campaign.report_page import template
from robbdd_tools.run.readable import title as clause_title

if TYPE_CHECKING:
    from robbdd_tools.campaign.report_moments import Moments
    from robbdd_tools.campaign.run_comparison import RunComparison
    from robbdd_tools.run.store import StoredRun
    from robbdd_tools.workbench.comparison import ExecutionChange
    from robbdd_tools.workbench.execution_rows import ClauseResult, ExecutionResult

MOST_FLIPS = 50
"""At most this many flipped executions are shown."""


@dataclass(frozen=True, slots=True)
class TracedRun:
    """A run with traces. ``indices`` maps the index of a result in its source to the index in this run."""

    run: StoredRun
    results: Sequence[ExecutionResult]
    indices: Mapping[int, int]

    def result(self, index: int) -> ExecutionResult | None:
        """Return the recorded result of the source's result ``index``; ``None`` if it was not recorded."""
        found = self.indices.get(index)
        return None if found is None else self.results[found]


@dataclass(frozen=True, slots=True)
class Flip:
    """An execution that flipped, in words. ``picture`` is a ``data:`` URI; ``replays`` are numbers in the page."""

    name: str
    values: str
    places: str
    clauses: tuple[tuple[str, str, str], ...]
    words: str
    picture: str
    replays: str


def comparison_page(
    title: str, found: RunComparison, notes: Sequence[str], flips: Sequence[Flip], count: int, moments: Moments
) -> str:
    """Return a comparison as HTML. ``count`` executions flipped; ``flips`` are the first ones."""
    return template("comparison.html").render(
        title=title,
        decision=str(found.decision),
        conclusion=conclusion(found),
        method=method_words(found),
        level=f"{found.level:.0%}",
        notes=notes,
        header=HEADER,
        rows=[(str(effect.change), cells(effect)) for effect in found.effects],
        flips=flips,
        count=count,
        moments=moments.document().replace("<", "\\u003c"),
        problem=moments.problem,
    )


def flips_of(
    changes: Sequence[ExecutionChange], sides: tuple[Sequence[TracedRun], Sequence[TracedRun]], moments: Moments
) -> list[Flip]:
    """Return the executions that flipped. The first ``MOST_MOMENTS`` have replays.

    ``sides`` are the recordings of the earlier and the later executions. Raises ``NoSuchRun``.
    """
    shown = changes[:MOST_FLIPS]
    return [_flip(change, sides, moments if number < MOST_MOMENTS else None) for number, change in enumerate(shown)]


def _flip(
    change: ExecutionChange, sides: tuple[Sequence[TracedRun], Sequence[TracedRun]], moments: Moments | None
) -> Flip:
    assert change.before is not None
    assert change.after is not None
    clauses = tuple(
        (clause_title(clause.name, clause.name), moved_words(clause), clause.reason)
        for clause in deciding_clauses(change)
    )
    places = f"execution {change.before.index + 1}"
    if change.after.index != change.before.index:
        places += f" → {change.after.index + 1}"
    words, picture, replays = "", "", ""
    if moments is not None:
        found = [_recorded(side, one.index) for side, one in zip(sides, (change.before, change.after), strict=True)]
        words, picture, replays = _moment(found, moments)
    return Flip(change.name, change.values, places, clauses, words, picture, replays)


def _recorded(side: Sequence[TracedRun], index: int) -> tuple[TracedRun, ExecutionResult] | None:
    found = ((one, one.result(index)) for one in side)
    return next(((one, result) for one, result in found if result is not None), None)


def _moment(found: Sequence[tuple[TracedRun, ExecutionResult] | None], moments: Moments) -> tuple[str, str, str]:
    """Add replays of both sides around a violation: the one in the later run or, without it, in the earlier run."""
    for violated in reversed(found):
        if violated is None:
            continue
        recording, result = violated
        first = first_violation(result)
        if first is None:
            continue
        _, clause = first
        replays = [_replay(one, clause, moments, label) for one, label in zip(found, ("before", "after"), strict=True)]
        known = [str(number) for number in replays if number is not None]
        words = f"{clause_title(clause.name, clause.sentence)} is violated"
        return words, moments.picture(recording.run, result), ",".join(known)
    return "", "", ""


def _replay(
    recorded: tuple[TracedRun, ExecutionResult] | None, clause: ClauseResult, moments: Moments, label: str
) -> int | None:
    if recorded is None:
        return None
    recording, result = recorded
    what = f"{clause_title(clause.name, clause.sentence)} is violated"
    return moments.add_replay(recording.run, result.index, instant_of(clause), what, label)
