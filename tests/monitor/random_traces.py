"""Random traces and clauses for the tests that compare the monitor with something else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import nan
from typing import TYPE_CHECKING

from hypothesis import strategies as st

from monitor.traces import STEP, heights, trace_of
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.last_iteration import LAST
from robbdd_tools.monitor.time import OCCURRENCES, After, Before, During, TimeConstraint
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.monitor.verdict import Verdict, conjunction, disjunction, negation

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

EVENTS: tuple[str, ...] = ("a", "b", "c")
ITERATIONS = (1, 2)


def _height(evidence: Evidence, arguments: Arguments) -> FloatArray:
    return evidence.position(str(arguments["thing"]))[:, 2]


ABOVE = Predicate(
    "above", "<thing> is above", "x:Above", (Slot("thing", Kind.OBJECT, "x:thing"),), "", "m", "", _height
)


@dataclass(frozen=True)
class Holds:
    """The predicate *above* of an object, which has a path of heights, perhaps whenever another one is above."""

    thing: str
    time: TimeConstraint
    condition: str | None = None


@dataclass(frozen=True)
class Takes:
    """The time between two events is shorter than a limit (s)."""

    limit: float
    time: TimeConstraint


@dataclass(frozen=True)
class Joined:
    """``and``, ``or`` or ``not`` of clauses."""

    operator: str
    parts: tuple[Clause, ...]


Clause = Holds | Takes | Joined


@dataclass(frozen=True)
class Story:
    """Heights by object, one per sample, and stamped events."""

    paths: dict[str, list[float]]
    events: tuple[tuple[str, float, int], ...]
    """Name, time and iteration."""
    executions: Mapping[str, int] = field(default_factory=dict[str, int])
    """Events of a behaviour tree to how often what emits them was begun."""
    pending: tuple[str, ...] = ()
    """Events whose last occurrence is unknown."""
    log: str = ""
    finished: bool = True

    @property
    def trace(self) -> Trace:
        """The same as a trace."""
        found = trace_of({name: heights(path) for name, path in self.paths.items()})
        stamps = tuple(EventStamp(*event) for event in self.events)
        trace = Trace(found.names, found.times, found.positions, found.orientations, {}, stamps)
        return replace(trace, executions=self.executions, pending=self.pending, log=self.log, finished=self.finished)


def by_the_monitor(clause: Clause, story: Story) -> Verdict:
    """Judge a clause with the implementation under test."""
    match clause:
        case Holds(thing, time, condition):
            guard = None if condition is None else (ABOVE, {"thing": condition})
            return judge(ABOVE, {"thing": thing}, time, story.trace, {}, guard)
        case Takes(limit, time):
            return judge(load_catalog().predicates["takes-less-than"], {"limit": f"{limit!r} s"}, time, story.trace, {})
        case Joined("not", (part,)):
            return negation(by_the_monitor(part, story))
        case Joined(operator, parts):
            verdicts = [by_the_monitor(part, story) for part in parts]
            return conjunction(verdicts) if operator == "and" else disjunction(verdicts)


# Multiples of 1/8 are exact in binary: equal margins are equal in every implementation.
MARGINS = st.integers(-16, 16).map(lambda number: number / 8)


@st.composite
def stories(draw: st.DrawFn, *, events_on_samples: bool) -> Story:
    """Traces of two things; events may be missing, or come twice, unless they are to lie on samples.

    There, each occurs once in each iteration. Else some margins are missing.
    """
    count = draw(st.integers(1, 12))
    margins = MARGINS if events_on_samples else st.one_of(*[MARGINS] * 7, st.just(nan))
    paths = {name: draw(st.lists(margins, min_size=count, max_size=count)) for name in ("x", "y")}
    instants = st.integers(0, count - 1).map(lambda row: row * STEP)
    if events_on_samples:
        return Story(paths, tuple((name, draw(instants), number) for name in EVENTS for number in ITERATIONS))
    anywhere = instants | st.floats(0.0, count * STEP)
    stamps = draw(st.lists(st.tuples(st.sampled_from(EVENTS), anywhere, st.sampled_from((0, *ITERATIONS))), max_size=8))
    executions = draw(st.dictionaries(st.sampled_from(EVENTS), st.integers(1, 3)))
    pending = draw(st.sets(st.sampled_from(EVENTS), max_size=1))
    finished = draw(st.booleans())
    return Story(
        paths, tuple(sorted(stamps, key=lambda stamp: stamp[1])), executions, tuple(pending), finished=finished
    )


_EVENT = st.sampled_from(EVENTS)
_HORIZON = st.none() | st.integers(0, 8).map(lambda steps: steps * STEP)


_CHOICES = (
    _EVENT,
    _HORIZON,
    st.just(0),
    st.booleans(),
    st.sampled_from(OCCURRENCES),
    st.sampled_from([(0, 0), (1, 1), (1, 2), (2, 2), (0, LAST)]),
)
_SELECTED: st.SearchStrategy[TimeConstraint] = st.builds(Before, *_CHOICES) | st.builds(After, *_CHOICES)
"""Time constraints that select occurrences of their event."""


def _times(iterations: tuple[int, ...]) -> st.SearchStrategy[TimeConstraint]:
    number = st.sampled_from(iterations)
    some_time = st.booleans()
    return (
        st.builds(Before, _EVENT, _HORIZON, number, some_time)
        | st.builds(After, _EVENT, _HORIZON, number, some_time)
        | st.builds(During, _EVENT, _EVENT, st.tuples(number, number), some_time)
    )


OBSERVED: st.SearchStrategy[Clause] = st.builds(Holds, st.sampled_from(["x", "y"]), _times(ITERATIONS))
"""Clauses that name an iteration each, of things that are recorded."""
DURATIONS: st.SearchStrategy[Clause] = st.builds(
    Takes, st.integers(0, 10).map(lambda steps: steps * STEP), _times((0, LAST, *ITERATIONS))
)
FLUENTS: st.SearchStrategy[Clause] = DURATIONS | st.builds(
    Holds,
    st.sampled_from(["x", "y", "missing"]),
    _times((0, LAST, *ITERATIONS)) | _SELECTED,
    st.none() | st.sampled_from(["x", "y", "missing"]),
)


def _joined(parts: st.SearchStrategy[Clause]) -> st.SearchStrategy[Clause]:
    several = st.lists(parts, max_size=3).map(tuple)
    one = st.tuples(parts)
    return st.builds(Joined, st.sampled_from(["and", "or"]), several) | st.builds(Joined, st.just("not"), one)


CLAUSES: st.SearchStrategy[Clause] = st.recursive(FLUENTS, _joined, max_leaves=5)
