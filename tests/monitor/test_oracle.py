"""The monitor against a brute-force oracle that follows docs/semantics.md sentence by sentence."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isnan

import pytest
from hypothesis import given, settings

from monitor.random_traces import CLAUSES, Clause, Holds, Joined, Story, Takes, by_the_monitor, stories
from monitor.traces import STEP
from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint

TOLERANCE = 1e-9


@dataclass(frozen=True)
class Answer:
    """What the oracle says: outcome, margin, reported instant and worst instant."""

    outcome: str
    margin: float | None = None
    at: float | None = None
    worst: float | None = None


UNKNOWN = Answer("unknown")


def occurrence(story: Story, event: str, iteration: int) -> float | None:
    """t(e) of the page: of iteration k, those stamped k or 0 count; without a loop (k = 0) all do.

    The last execution of what emits the event is the one that was begun last; it may not be known yet.
    """
    if iteration == LAST:
        if event in story.pending:
            return None
        iteration = story.executions.get(event, 0)
    stamped = [(time, number) for name, time, number in story.events if name == event]
    times = [time for time, number in stamped if iteration == 0 or number == 0 or number == iteration]
    return min(times) if times else None


def selected(story: Story, time: Before | After) -> list[float] | None:
    """The times of the occurrences that 'the first', 'the last' or 'every' select in the clause's scope."""
    low, high = time.scope
    times = sorted(
        t
        for name, t, number in story.events
        if name == time.event and (low == 0 or number == 0 or low <= number <= high)
    )
    if time.which == "first":
        return times[:1] or None
    if not story.finished or time.event in story.pending:
        return None
    return (times[-1:] if time.which == "last" else times) or None


def at_occurrences(clause: Holds, story: Story, time: Before | After) -> Answer:
    """The page's verdict on the selected occurrences: each one alone, joined by 'and'."""
    times = selected(story, time)
    if times is None:
        return UNKNOWN
    plain = type(time)(time.event, time.horizon, 0, time.some_time)
    alone = [replace(story, events=((time.event, t, 0),), pending=(), executions={}) for t in times]
    return joined("and", [fluent(replace(clause, time=plain), one) for one in alone])


def in_window(time: TimeConstraint, story: Story, samples: list[float]) -> list[int] | None:
    """Rows of the samples of a window; ``None`` where the page says *unknown*.

    If it is enough that the predicate holds at some time, the samples of a window beyond the trace count, too.
    """

    def between(low: float, high: float) -> list[int]:
        return [row for row, t in enumerate(samples) if low - TOLERANCE <= t <= high + TOLERANCE]

    match time:
        case Before(event, horizon, k):
            t = occurrence(story, event, k)
            if t is None or (horizon is not None and t - horizon < -TOLERANCE and not time.some_time):
                return None
            return between(0.0, t)[-1:] if horizon is None else between(t - horizon, t)
        case After(event, horizon, k):
            t = occurrence(story, event, k)
            if t is None or (max(samples) < t + (horizon or 0.0) - TOLERANCE and not time.some_time):
                return None
            return between(t, float("inf"))[:1] if horizon is None else between(t, t + horizon)
        case During(start, end, (first, last)):
            a, b = occurrence(story, start, first), occurrence(story, end, last)
            return None if a is None or b is None or b < a else between(a, b)


def whole_window(time: TimeConstraint, story: Story, samples: list[float]) -> bool:
    """Whether the trace covers the window from its beginning to its end."""
    match time:
        case Before(event, float(horizon), k):
            return (occurrence(story, event, k) or 0.0) - horizon >= -TOLERANCE
        case After(event, horizon, k):
            return max(samples) >= (occurrence(story, event, k) or 0.0) + (horizon or 0.0) - TOLERANCE
        case _:
            return True


def at_some_time(time: TimeConstraint, story: Story, margins: dict[int, float], samples: list[float]) -> Answer:
    """The page's verdict where it is enough that the predicate holds at some time in the window."""
    known = {row: value for row, value in margins.items() if not isnan(value)}
    if not known:
        return UNKNOWN
    most = max(known.values())
    best = next(samples[row] for row in known if known[row] == most)
    if most >= 0:
        return Answer("holds", most, next(samples[row] for row in known if known[row] >= 0), best)
    if len(known) < len(margins) or not whole_window(time, story, samples):
        return UNKNOWN
    return Answer("violated", most, samples[max(known)], best)


def implied(condition: float, margin: float) -> str:
    """The verdict at one sample on a predicate that must hold whenever a condition holds."""
    not_condition = "unknown" if isnan(condition) else "violated" if condition >= 0 else "holds"
    predicate = "unknown" if isnan(margin) else "holds" if margin >= 0 else "violated"
    return max(not_condition, predicate, key=("violated", "unknown", "holds").index)


def whenever(guard: dict[int, float], margins: dict[int, float], samples: list[float]) -> Answer:
    """The page's verdict on a clause with a condition."""
    verdicts = [implied(guard[row], margins[row]) for row in margins]
    if "violated" in verdicts:
        counted = {row: margins[row] for row in margins if guard[row] >= 0 and not isnan(margins[row])}
    elif "unknown" in verdicts:
        return UNKNOWN
    else:
        counted = {row: margins[row] for row in margins if not guard[row] < 0}
    if not counted:
        return Answer("holds")
    least = min(counted.values())
    worst = next(samples[row] for row in counted if counted[row] == least)
    if least >= 0:
        return Answer("holds", least, worst, worst)
    return Answer("violated", least, next(samples[row] for row in counted if counted[row] < 0), worst)


def fluent(clause: Holds, story: Story) -> Answer:
    if not isinstance(clause.time, During) and clause.time.which:
        return at_occurrences(clause, story, clause.time)
    samples = [row * STEP for row in range(len(story.paths["x"]))]
    rows = in_window(clause.time, story, samples)
    if not rows or not {clause.thing, clause.condition or "x"} <= story.paths.keys():
        return UNKNOWN
    margins = {row: story.paths[clause.thing][row] for row in rows}
    if clause.condition is not None:
        guard = {row: story.paths[clause.condition][row] for row in rows}
        return UNKNOWN if clause.time.some_time else whenever(guard, margins, samples)
    if clause.time.some_time:
        return at_some_time(clause.time, story, margins, samples)
    if any(isnan(value) for value in margins.values()):
        return UNKNOWN
    least = min(margins.values())
    worst = next(samples[row] for row in rows if margins[row] == least)
    if least >= 0:
        return Answer("holds", least, worst, worst)
    return Answer("violated", least, next(samples[row] for row in rows if margins[row] < 0), worst)


def duration(clause: Takes, story: Story) -> Answer:
    """The page's verdict on the time between two events."""
    time = clause.time
    if not isinstance(time, During) or time.some_time:
        return UNKNOWN
    samples = len(story.paths["x"])
    begin = occurrence(story, time.start, time.iterations[0])
    end = occurrence(story, time.end, time.iterations[1])
    uncertain = any(
        event in story.pending and k == LAST for event, k in zip((time.start, time.end), time.iterations, strict=True)
    )
    if begin is None or uncertain or (end is not None and end < begin):
        return UNKNOWN
    left = begin + clause.limit - ((samples - 1) * STEP if end is None else end)
    if end is None and (story.log or not story.finished or left >= 0):
        return UNKNOWN
    until = (samples - 1) * STEP if end is None else end
    return Answer("holds", left, until, until) if left >= 0 else Answer("violated", left, begin + clause.limit, until)


def answer(clause: Clause, story: Story) -> Answer:
    match clause:
        case Takes():
            return duration(clause, story)
        case Holds():
            return fluent(clause, story)
        case Joined("not", (part,)):
            inner = answer(part, story)
            if inner.outcome == "unknown":
                return UNKNOWN
            outcome = {"holds": "violated", "violated": "holds"}[inner.outcome]
            margin = None if inner.margin is None else -inner.margin
            return Answer(outcome, margin, inner.worst, inner.worst)
        case Joined(operator, parts):
            return joined(operator, [answer(part, story) for part in parts])


def joined(operator: str, answers: list[Answer]) -> Answer:
    order = ("violated", "unknown", "holds")
    ranks = [order.index(one.outcome) for one in answers] or [1]
    outcome = order[min(ranks) if operator == "and" else max(ranks)]
    if outcome == "unknown":
        return UNKNOWN
    margins = [one.margin for one in answers if one.margin is not None and one.outcome == outcome]
    if not margins:
        return Answer(outcome)
    decisive = min(margins) if operator == "and" else max(margins)
    return next(one for one in answers if one.margin == decisive and one.outcome == outcome)


@settings(max_examples=500)
@given(CLAUSES, stories(events_on_samples=False))
def test_outcome_margin_and_instants_are_those_of_the_page(clause: Clause, story: Story) -> None:
    expected, found = answer(clause, story), by_the_monitor(clause, story)
    assert str(found.outcome) == expected.outcome
    assert found.robustness == pytest.approx(expected.margin)
    assert found.at == pytest.approx(expected.at)
    assert found.worst_at == pytest.approx(expected.worst)


@settings(max_examples=200)
@given(CLAUSES, stories(events_on_samples=False))
def test_what_is_unknown_has_a_reason_and_what_is_not_has_a_margin(clause: Clause, story: Story) -> None:
    found = by_the_monitor(clause, story)
    assert found.robustness is not None or str(found.outcome) == "unknown" or found.vacuous
    assert found.reason or found.robustness is not None
