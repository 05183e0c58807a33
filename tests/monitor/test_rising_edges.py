"""When a condition becomes true, against a definition sample by sample and against RTAMT."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from math import nan
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from monitor.traces import STEP, still, trace_of
from robbdd_tools.monitor.rising_edges import rising_edges
from robbdd_tools.monitor.time import After, During, NoWindow, interval, occurrence_times
from robbdd_tools.monitor.trace import Doubt

MARGINS = st.lists(st.sampled_from([1.0, 0.0, -1.0, nan]), min_size=1, max_size=12)


def edges(margins: list[float], samples: int = 0) -> tuple[list[int], list[tuple[int, int]]]:
    """Return the rows at which a condition has become true for some samples, and the spans of doubt in rows."""
    found = rising_edges(np.array(margins), np.arange(len(margins), dtype=np.float64) * STEP, samples * STEP)
    spans = [(round(since / STEP), round(until / STEP)) for since, until in found.doubtful]
    return [round(time / STEP) for time in found.times], spans


@pytest.mark.parametrize(
    ("margins", "samples", "rows"),
    [
        ([-1, 1, 1, -1, 0], 0, [1, 4]),
        ([1, 1, 1], 0, []),
        ([1, -1, 1], 0, [2]),
        ([-1, 1, 1, -1, 1, 1, 1], 2, [6]),
        ([-1, 1, 1, 1, 1], 2, [3]),
    ],
)
def test_it_occurs_when_the_margin_becomes_positive(margins: list[float], samples: int, rows: list[int]) -> None:
    assert edges(margins, samples) == (rows, [])


def test_nothing_is_known_from_the_known_sample_before_a_gap_until_the_one_after_it() -> None:
    assert edges([-1, nan, nan, 1, -1, 1]) == ([5], [(0, 3)])
    assert edges([nan, 1, -1, nan]) == ([], [(0, 1), (2, 3)])
    assert edges([-1, nan, 1, 1, 1], 2) == ([], [(0, 4)])


@given(MARGINS, st.integers(0, 3))
def test_an_occurrence_is_what_its_definition_says(margins: list[float], samples: int) -> None:
    expected = [
        row
        for row in range(samples + 1, len(margins))
        if margins[row - samples - 1] < 0 and all(value >= 0 for value in margins[row - samples : row + 1])
    ]
    rows, spans = edges(margins, samples)
    assert rows == expected
    # Whatever the unknown margins are, an occurrence is either found or in a span of doubt.
    for value in (1.0, -1.0):
        filled = [value if np.isnan(one) else one for one in margins]
        for row in edges(filled, samples)[0]:
            assert row in rows or any(since <= row <= until for since, until in spans)


@given(st.lists(st.sampled_from([2.0, 1.0, -1.0]), min_size=2, max_size=12))
def test_rtamt_finds_the_same_edges(margins: list[float]) -> None:
    specification: Any = import_module("rtamt").StlDiscreteTimeOfflineSpecification()
    specification.declare_var("p", "float")
    specification.spec = "rise(p >= 0)"
    specification.parse()
    answers = specification.evaluate({"time": list(range(len(margins))), "p": margins})
    assert [int(row) for row, value in answers[1:] if value >= 0] == edges(margins)[0]


def test_a_clause_does_not_use_an_event_that_may_have_occurred_before() -> None:
    trace = trace_of({"x": still(9)}, {"near": 0.6, "end": 0.8})
    doubt = Doubt("near", 0.2, 0.4, (1, 1), "x was not observed")
    doubted = replace(trace, doubts=(doubt,))
    assert occurrence_times(After("near"), trace) == (0.6,)
    unknown = occurrence_times(After("near"), doubted)
    assert isinstance(unknown, NoWindow)
    assert unknown.reason == ("it is not known whether event near occurred from 0.20 s to 0.40 s: x was not observed")
    assert isinstance(interval(During("near", "end"), doubted), NoWindow)
    # In another iteration, and after the first occurrence, it does not matter.
    assert doubted.doubt("near", (2, 2)) is None
    later = replace(trace, doubts=(replace(doubt, since=0.7, until=0.8),))
    assert occurrence_times(After("near"), later) == (0.6,)
    assert occurrence_times(After("near", which="first"), later) == (0.6,)
    assert isinstance(occurrence_times(After("near", which="every"), later), NoWindow)
