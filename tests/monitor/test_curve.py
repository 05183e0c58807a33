"""Margins over time, for plots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from monitor.traces import still, trace_of
from robbdd_tools.monitor.curve import POINTS, Curve, curve
from robbdd_tools.monitor.time import After, During, Window
from robbdd_tools.monitor.trace import EventStamp, Trace

LONG = 5000


def a_trace(rows: int = 11) -> Trace:
    return trace_of({"cube": still(rows)}, {"t:a": 0.2, "t:b": 0.6})


def test_a_margin_of_the_state_alone_goes_beyond_its_window() -> None:
    trace = a_trace()
    found = curve(Curve(unit="m"), After("t:a"), trace, lambda rows: trace.times[rows.first : rows.last + 1] - 0.5)
    assert (found.start, found.end, found.unit) == (0.2, 0.2, "m")
    assert (len(found.times), found.margins[2]) == (11, -0.3)


def test_a_margin_that_counts_from_the_opening_of_its_window_stays_within() -> None:
    trace = a_trace()
    found = curve(
        Curve(), During("t:a", "t:b"), trace, lambda rows: 1.0 - np.arange(rows.last - rows.first + 1, dtype=float)
    )
    assert (found.start, found.end) == (0.2, 0.6)
    assert (found.times, found.margins) == ((0.2, 0.3, 0.4, 0.5, 0.6), (1.0, 0.0, -1.0, -2.0, -3.0))


def test_without_a_window_the_curve_says_why() -> None:
    trace = a_trace()
    found = curve(Curve(), After("t:never"), trace, lambda rows: trace.times[rows.first : rows.last + 1])
    assert (found.start, found.end, found.reason) == (None, None, "event t:never never occurred")
    assert found.margins == found.times == tuple(round(row * 0.1, 6) for row in range(11))


def test_what_is_not_known_is_no_point() -> None:
    trace = a_trace()

    def margins(rows: Window) -> np.ndarray[tuple[int], np.dtype[np.float64]] | None:
        return None if rows.first == 0 else np.full(rows.last - rows.first + 1, np.nan)

    found = curve(Curve(), After("t:a"), trace, margins)
    assert (found.start, found.end, found.times, found.margins) == (0.2, 0.2, (), ())


@pytest.mark.parametrize("seed", range(5))
def test_a_long_curve_is_thinned_out_and_keeps_what_decides(seed: int) -> None:
    trace = a_trace(LONG)
    margins = np.random.default_rng(seed).normal(size=LONG)
    found = curve(Curve(), During("t:a", "t:b"), trace, lambda rows: margins[rows.first : rows.last + 1])
    assert len(found.times) <= POINTS + 3
    assert list(found.times) == sorted(found.times)
    assert max(found.margins) == pytest.approx(margins.max(), abs=1e-6)
    window = [margin for time, margin in zip(found.times, found.margins, strict=True) if 0.2 <= time <= 0.6]
    assert min(window) == pytest.approx(margins[2:7].min(), abs=1e-6)
    assert {0.2, 0.6} <= set(found.times)


def test_a_long_curve_keeps_the_largest_margin_where_one_sample_suffices() -> None:
    trace = a_trace(LONG)
    margins = np.cos(np.arange(LONG) * 0.9)
    margins[3:5] = 2.0, 1.5
    margins[7] = 3.0
    during = During("t:a", "t:b", some_time=True)
    found = curve(Curve(), during, trace, lambda rows: margins[rows.first : rows.last + 1])
    assert found.some_time
    assert len(found.times) < LONG
    assert (0.3, 2.0) in zip(found.times, found.margins, strict=True)


@pytest.mark.parametrize(("some_time", "margins", "start"), [(False, [1, -1, 2], 0.3), (True, [0, 4, 3], 0.2)])
def test_of_every_occurrence_the_deciding_one_has_its_window(
    some_time: bool, margins: list[float], start: float
) -> None:
    trace = trace_of({"cube": still(8)})
    trace = replace(trace, events=tuple(EventStamp("t:bell", time) for time in (0.2, 0.3, 0.4)))
    values = np.array([5.0, 5.0, *margins, 5.0, 5.0, 5.0])
    every = After("t:bell", 0.05, some_time=some_time, which="every")
    found = curve(Curve(), every, trace, lambda rows: values[rows.first : rows.last + 1])
    assert (found.start, found.some_time) == (start, some_time)


def test_a_sample_without_a_number_is_no_gap_in_the_rest() -> None:
    trace = a_trace()
    values = np.array([np.nan, 1, 2, np.nan, 4, 5, 6, 7, 8, 9, np.inf])
    found = curve(Curve(), During("t:a", "t:b"), trace, lambda rows: values[rows.first : rows.last + 1])
    assert found.times == (0.1, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
    assert found.margins == (1, 2, 4, 5, 6, 7, 8, 9)


def test_a_margin_known_in_the_window_only_is_drawn_there() -> None:
    trace = a_trace()

    def margins(rows: Window) -> np.ndarray[tuple[int], np.dtype[np.float64]] | None:
        return None if rows.first == 0 else np.ones(rows.last - rows.first + 1)

    assert curve(Curve(), During("t:a", "t:b"), trace, margins).times == (0.2, 0.3, 0.4, 0.5, 0.6)


def test_an_execution_without_samples_has_no_curve() -> None:
    def margins(rows: Window) -> np.ndarray[tuple[int], np.dtype[np.float64]] | None:
        raise AssertionError(rows)

    found = curve(Curve(unit="m", negated=True), After("t:a"), trace_of({}), margins)
    assert found == Curve(unit="m", negated=True, reason="event t:a never occurred")


def test_times_and_margins_are_rounded_to_six_decimals() -> None:
    trace = trace_of({"cube": still(2)}, {"t:a": 0.0})
    found = curve(Curve(), After("t:a"), trace, lambda rows: np.full(rows.last - rows.first + 1, 1 / 3))
    assert found.margins == (0.333333, 0.333333)


def test_a_curve_of_as_many_points_as_a_screen_shows_is_whole() -> None:
    for rows, points in ((POINTS, POINTS), (POINTS + 1, POINTS)):
        trace = a_trace(rows)
        found = curve(Curve(), After("t:a"), trace, lambda rows: np.sin(np.arange(rows.first, rows.last + 1) * 2.0))
        assert len(found.times) == pytest.approx(points, abs=3)
        assert (len(found.times) == rows) == (rows == POINTS)


def test_a_long_curve_without_a_window_keeps_its_extremes() -> None:
    trace = a_trace(LONG)
    margins = np.random.default_rng(3).normal(size=LONG)
    found = curve(Curve(), During("t:a", "t:never"), trace, lambda rows: margins[rows.first : rows.last + 1])
    part = LONG // (POINTS // 2)
    for first in range(0, LONG, part):
        times = {
            round(0.1 * (first + row), 6)
            for row in (margins[first : first + part].argmin(), margins[first : first + part].argmax())
        }
        assert times <= set(found.times)
