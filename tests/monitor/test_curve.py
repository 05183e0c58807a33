"""Margins over time, for plots."""

from __future__ import annotations

import numpy as np
import pytest

from monitor.traces import still, trace_of
from robbdd_tools.monitor.curve import POINTS, Curve, curve
from robbdd_tools.monitor.time import After, During, Window
from robbdd_tools.monitor.trace import Trace

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
    assert (found.start, found.reason, len(found.times)) == (None, "event t:never never occurred", 11)


def test_what_is_not_known_is_no_point() -> None:
    trace = a_trace()

    def margins(rows: Window) -> np.ndarray[tuple[int], np.dtype[np.float64]] | None:
        return None if rows.first == 0 else np.full(rows.last - rows.first + 1, np.nan)

    assert curve(Curve(), After("t:a"), trace, margins).times == ()


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
