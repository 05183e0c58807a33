"""Predicates whose margin never varied."""

from __future__ import annotations

from dataclasses import replace

from monitor.random_traces import ABOVE
from monitor.traces import heights, still, trace_of
from robbdd_tools.monitor.judge import margin_range
from robbdd_tools.monitor.vacuity import is_constant, joined

WORDS = {"thing": "ball"}


def test_the_range_is_that_of_all_samples_and_not_of_a_window() -> None:
    trace = trace_of({"ball": heights([0.5, -1.0, 2.0])}, {"e": 0.0})
    assert margin_range(ABOVE, WORDS, trace, {}) == (-1.0, 2.0)


def test_what_never_varies_is_constant_in_one_execution_and_in_several() -> None:
    one = margin_range(ABOVE, WORDS, trace_of({"ball": still(5, (0, 0, 0.5))}), {})
    other = margin_range(ABOVE, WORDS, trace_of({"ball": still(5, (0, 0, 0.6))}), {})
    assert one is not None
    assert other is not None
    assert is_constant(one)
    assert is_constant(joined([one, one]))
    assert not is_constant(joined([one, other]))


def test_nothing_is_said_where_nothing_tells_whether_it_could_be_otherwise() -> None:
    trace = trace_of({"ball": still(5)})
    assert margin_range(ABOVE, {"thing": "cube"}, trace, {}) is None
    assert margin_range(ABOVE, WORDS, trace_of({"ball": still(1)}), {}) is None
    for kind in (replace(ABOVE, set_up=True), replace(ABOVE, quantities=("reach",)), replace(ABOVE, evaluate=None)):
        assert margin_range(kind, WORDS, trace, {}) is None


def test_samples_without_a_number_are_not_counted() -> None:
    nan = float("nan")
    assert margin_range(ABOVE, WORDS, trace_of({"ball": heights([nan, 1.0, 3.0])}), {}) == (1.0, 3.0)
    assert margin_range(ABOVE, WORDS, trace_of({"ball": heights([nan, 1.0])}), {}) is None
    assert margin_range(ABOVE, WORDS, trace_of({"ball": heights([2.0, 1.0])}), {}) == (1.0, 2.0)


def test_a_difference_by_rounding_only_is_none() -> None:
    assert is_constant((1.0, 1.0 + 1e-12))
    assert is_constant((0.0, 1e-9))
    assert not is_constant((-1.0, 1.0))


def test_ranges_are_joined_to_the_one_that_holds_all() -> None:
    assert joined([(0.0, 1.0), (-1.0, 0.5), (0.2, 3.0)]) == (-1.0, 3.0)
