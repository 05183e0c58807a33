"""The monitor against RTAMT, a signal temporal logic monitor, by the formulas of docs/semantics.md."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from math import floor
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from monitor.random_traces import (
    EVENTS,
    ITERATIONS,
    OBSERVED,
    Clause,
    Holds,
    Joined,
    Story,
    Takes,
    by_the_monitor,
    stories,
)
from monitor.traces import STEP
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint
from robbdd_tools.monitor.verdict import Outcome

HUGE = 1e6
"""Margin of the proposition "the event is at this sample", far beyond any margin of a predicate."""


def steps(horizon: float | None) -> str:
    return f"[0,{round((horizon or 0.0) / STEP)}]"


def formula(clause: Clause) -> str:
    match clause:
        case Holds(thing, time, str(condition)):
            return f"always(({when(time)} and ({condition} >= 0)) implies ({thing} >= 0))"
        case Holds(thing, time) if time.some_time:
            return f"eventually({when(time)} and ({thing} >= 0))"
        case Holds(thing, time):
            return f"always({when(time)} implies ({thing} >= 0))"
        case Takes(limit, During(start, end, (first, last))):
            within = f"eventually[0,{floor(limit / STEP)}] ({end}{last} >= 0)"
            return f"always(({start}{first} >= 0) implies ({within}))"
        case Takes():
            raise ValueError("a duration is between two events")
        case Joined("not", (part,)):
            return f"(not {formula(part)})"
        case Joined(operator, parts):
            return "(" + f" {operator} ".join(map(formula, parts)) + ")"


def when(time: TimeConstraint) -> str:
    if not isinstance(time, During) and time.which == "every":
        # Each occurrence has its own iteration there.
        return f"({' or '.join(when(replace(time, which='', iteration=number)) for number in ITERATIONS)})"
    match time:
        case Before(event, horizon, k):
            return f"(eventually{steps(horizon)} ({event}{k} >= 0))"
        case After(event, horizon, k):
            return f"(once{steps(horizon)} ({event}{k} >= 0))"
        case During(start, end, (first, last)):
            return f"((once ({start}{first} >= 0)) and (eventually ({end}{last} >= 0)))"


def by_rtamt(clause: Clause, story: Story) -> float:
    """Robustness at the first sample."""
    # rtamt has no types.
    specification: Any = import_module("rtamt").StlDiscreteTimeSpecification()
    instants = {f"{name}{number}": round(time / STEP) for name, time, number in story.events}
    for name in (*story.paths, *instants):
        specification.declare_var(name, "float")
    specification.spec = formula(clause)
    specification.parse()
    count = len(story.paths["x"])
    marks = {name: [HUGE if row == instant else -HUGE for row in range(count)] for name, instant in instants.items()}
    found = specification.evaluate({"time": list(range(count)), **story.paths, **marks})
    return float(found[0][1])


def _joined(parts: st.SearchStrategy[Clause]) -> st.SearchStrategy[Clause]:
    several = st.lists(parts, min_size=2, max_size=3).map(tuple)
    one = st.tuples(parts)
    return st.builds(Joined, st.sampled_from(["and", "or"]), several) | st.builds(Joined, st.just("not"), one)


CLAUSES = st.recursive(OBSERVED, _joined, max_leaves=4)


def known(clause: Clause, story: Story) -> bool:
    """Whether the semantics coincide: no fluent of a clause is unknown."""
    if isinstance(clause, Holds):
        return by_the_monitor(clause, story).robustness is not None
    return isinstance(clause, Joined) and all(known(part, story) for part in clause.parts)


@settings(max_examples=150)
@given(CLAUSES, stories(events_on_samples=True))
def test_robustness_is_that_of_signal_temporal_logic(clause: Clause, story: Story) -> None:
    # rtamt takes the sampling period from the first two samples.
    assume(len(story.paths["x"]) > 1 and known(clause, story))
    assert by_the_monitor(clause, story).robustness == by_rtamt(clause, story)


@pytest.mark.parametrize(
    "time",
    [
        Before("a", None, 2),
        After("a", None, 1),
        Before("a", 0.2, 2),
        After("a", 0.2, 1),
        During("a", "b", (1, 1)),
        During("a", "b", (1, 2)),
        Before("a", 0.2, 2, some_time=True),
        After("a", 0.2, 1, some_time=True),
        During("a", "b", (1, 2), some_time=True),
        Before("a", None, which="every"),
        After("a", 0.1, which="every"),
    ],
)
def test_every_kind_of_window_is_compared(time: TimeConstraint) -> None:
    events = (("a", 0.2, 1), ("b", 0.4, 1), ("a", 0.3, 2), ("b", 0.5, 2))
    story = Story({"x": [0.5, -1.0, 0.25, -2.0, 0.75, -3.0], "y": [0.0] * 6}, events)
    assert by_the_monitor(Holds("x", time), story).robustness == by_rtamt(Holds("x", time), story)


GUARDED = OBSERVED.filter(lambda one: isinstance(one, Holds) and not one.time.some_time).map(
    lambda one: Holds(one.thing, one.time, "y" if one.thing == "x" else "x") if isinstance(one, Holds) else one
)


@settings(max_examples=100)
@given(GUARDED, stories(events_on_samples=True))
def test_a_condition_has_the_truth_value_of_signal_temporal_logic(clause: Clause, story: Story) -> None:
    """The margins differ: there, they are also those of the condition."""
    assume(len(story.paths["x"]) > 1)
    found, margin = by_the_monitor(clause, story), by_rtamt(clause, story)
    # At a margin of 0, that monitor tells neither true from false.
    assume(found.outcome is not Outcome.UNKNOWN and margin != 0)
    assert (found.outcome is Outcome.HOLDS) == (margin > 0)


@settings(max_examples=60)
@given(st.integers(0, 10), st.sampled_from(EVENTS), st.sampled_from(EVENTS), stories(events_on_samples=True))
def test_a_duration_is_an_event_that_must_follow_in_time(steps_left: int, a: str, b: str, story: Story) -> None:
    """The truth value is the same; there, the margin is not a time."""
    assume(len(story.paths["x"]) > 1)
    clause = Takes(steps_left * STEP + STEP / 2, During(a, b, (1, 1)))
    found = by_the_monitor(clause, story)
    assume(found.outcome is not Outcome.UNKNOWN)
    assert (found.outcome is Outcome.HOLDS) == (by_rtamt(clause, story) > 0)
