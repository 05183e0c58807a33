"""Judging a predicate on a trace: outcome, margin and instant."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from monitor.traces import heights, still, trace_of
from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.monitor.judge import judge, margin_range
from robbdd_tools.monitor.time import After, Before, During
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, unknown

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray


def height(evidence: Evidence, arguments: Arguments) -> FloatArray:
    return evidence.position(str(arguments["thing"]))[:, 2]


ABOVE = Predicate("above", "<thing> is above", "x:Above", (Slot("thing", Kind.OBJECT, "x:thing"),), "", "m", "", height)
ALL = During("start", "end")


def judged(values: list[float], thing: str = "ball") -> Verdict:
    trace = trace_of({"ball": heights(values)}, {"start": 0.0, "end": (len(values) - 1) * 0.1})
    return judge(ABOVE, {"thing": thing}, ALL, trace, {})


def test_holds_with_the_smallest_margin_and_its_instant() -> None:
    found = judged([0.3, 0.1, 0.2])
    assert (found.outcome, found.robustness, found.unit) == (Outcome.HOLDS, 0.1, "m")
    assert found.at == found.worst_at == pytest.approx(0.1)


def test_violated_with_the_smallest_margin_at_the_first_offending_sample() -> None:
    found = judged([0.3, -0.1, -0.4, 0.2])
    assert (found.outcome, found.robustness, found.unit) == (Outcome.VIOLATED, -0.4, "m")
    assert found.at == pytest.approx(0.1)
    assert found.worst_at == pytest.approx(0.2)


def test_a_margin_of_zero_is_no_offence() -> None:
    assert judged([0.0, -0.1]).at == pytest.approx(0.1)


def test_a_margin_of_zero_holds() -> None:
    assert judged([0.0]).outcome is Outcome.HOLDS


def test_only_the_window_counts() -> None:
    trace = trace_of({"ball": heights([-1.0, 0.5, -1.0])}, {"now": 0.1})
    assert judge(ABOVE, {"thing": "ball"}, Before("now"), trace, {}).outcome is Outcome.HOLDS
    assert judge(ABOVE, {"thing": "ball"}, After("now", 0.1), trace, {}).outcome is Outcome.VIOLATED


def test_what_the_trace_does_not_hold_is_unknown() -> None:
    assert judged([1.0], "cube") == unknown("the trace has no record of 'cube'", Cause.NO_RECORD)


def test_a_predicate_without_evaluator_is_unknown() -> None:
    mute = replace(ABOVE, evaluate=None)
    found = judge(mute, {"thing": "ball"}, ALL, trace_of({"ball": still(1)}), {})
    assert found == unknown("there is no evaluator for 'above'", Cause.NO_STEP)


def test_a_missing_event_is_unknown() -> None:
    found = judge(ABOVE, {"thing": "ball"}, After("never"), trace_of({"ball": still(1)}), {})
    assert found == unknown("event never never occurred", Cause.NO_EVENT)


def test_a_window_without_samples_is_unknown_and_could_not_have_been_violated() -> None:
    found = judge(ABOVE, {"thing": "ball"}, During("a", "a"), trace_of({"ball": still(3)}, {"a": 0.05}), {})
    assert found == unknown("no sample was taken in the window", Cause.EMPTY, "its window contains no sample")


def test_a_unit_may_depend_on_the_trace() -> None:
    def unit(evidence: Evidence, arguments: Arguments) -> str:
        return f"{len(evidence.times)} {arguments['thing']}"

    trace = trace_of({"ball": heights([1.0, 2.0])}, {"start": 0.0, "end": 0.1})
    assert judge(replace(ABOVE, unit_for=unit), {"thing": "ball"}, ALL, trace, {}).unit == "2 ball"


def test_regions_of_workspaces_are_those_of_the_scene() -> None:
    def count(evidence: Evidence, arguments: Arguments) -> FloatArray:
        return evidence.position(str(arguments["thing"]))[:, 2] + len(evidence.workspaces)

    trace = trace_of({"ball": heights([1.0, 2.0])}, {"start": 0.0, "end": 0.1})
    counted = replace(ABOVE, evaluate=count)
    assert judge(counted, {"thing": "ball"}, ALL, trace, {"bin": ()}).robustness == 2.0
    assert margin_range(counted, {"thing": "ball"}, trace, {"bin": ()}) == (2.0, 3.0)


def test_a_margin_that_is_not_a_number_is_unknown() -> None:
    assert judged([1.0, float("nan")]) == unknown("the margin is not a number at some sample", Cause.NO_RECORD)


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=30))
def test_robustness_is_the_minimum_and_its_sign_the_outcome(values: list[float]) -> None:
    found = judged(values)
    assert found.robustness == min(values)
    assert (found.outcome is Outcome.HOLDS) == (min(values) >= 0)


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=20), st.floats(-10, 10))
def test_one_more_sample_never_raises_robustness(values: list[float], extra: float) -> None:
    shorter, longer = judged(values).robustness, judged([*values, extra]).robustness
    assert shorter is not None
    assert longer is not None
    assert longer <= shorter


def at_some_time(values: list[float], horizon: float) -> Verdict:
    trace = trace_of({"ball": heights(values)}, {"start": 0.1})
    return judge(ABOVE, {"thing": "ball"}, After("start", horizon, some_time=True), trace, {})


def test_at_some_time_holds_with_the_largest_margin_and_says_when_it_first_held() -> None:
    found = at_some_time([0.5, -0.3, 0.1, 0.2, -0.1], 0.3)
    assert (found.outcome, found.robustness, found.unit) == (Outcome.HOLDS, 0.2, "m")
    assert (found.at, found.worst_at) == (pytest.approx(0.2), pytest.approx(0.3))
    assert found.reason == "first held at 0.20 s, 0.20 s before the window closes"


def test_at_some_time_is_violated_when_the_window_has_closed() -> None:
    found = at_some_time([0.5, -0.3, -0.1, -0.2, 0.4], 0.2)
    assert (found.outcome, found.robustness) == (Outcome.VIOLATED, -0.1)
    assert (found.at, found.worst_at) == (pytest.approx(0.3), pytest.approx(0.2))
    assert found.reason == "it held at no time until 0.30 s, and was closest at 0.20 s"


@pytest.mark.parametrize("values", [[0.5, -0.3, -0.1], [0.5, -0.3, float("nan"), -0.1, -0.1, -0.1]])
def test_at_some_time_is_unknown_while_a_part_of_the_window_may_still_hold(values: list[float]) -> None:
    assert at_some_time(values, 0.3).outcome is Outcome.UNKNOWN


@pytest.mark.parametrize("values", [[0.5, -0.3, 0.1], [0.5, -0.3, float("nan"), 0.1, -0.1, -0.1]])
def test_at_some_time_holds_whatever_is_not_known_if_it_held_once(values: list[float]) -> None:
    found = at_some_time(values, 0.3)
    assert (found.outcome, found.robustness) == (Outcome.HOLDS, 0.1)


def in_log(values: list[float]) -> Verdict:
    """Judge heights (m) of a log, every 0.1 s, from start to end; NaN where nothing was observed."""
    trace = trace_of({"ball": heights(values)}, {"start": 0.0, "end": (len(values) - 1) * 0.1})
    return judge(ABOVE, {"thing": "ball"}, ALL, replace(trace, log="drive.mcap"), {})


def test_a_gap_in_a_log_is_unknown_and_named() -> None:
    gap = float("nan")
    assert in_log([1.0, 1.0]).outcome is Outcome.HOLDS
    assert in_log([1.0, gap, gap, 1.0]) == unknown("ball was not observed between 0.00 s and 0.30 s", Cause.UNOBSERVED)
    assert in_log([1.0, 1.0, gap]) == unknown("ball was not observed after 0.10 s", Cause.UNOBSERVED)
    assert in_log([gap, 1.0]) == unknown("ball was not observed before 0.10 s", Cause.UNOBSERVED)
    assert in_log([gap]) == unknown("ball was not observed at any time", Cause.UNOBSERVED)


def test_a_comparison_with_a_missing_value_passes_nothing() -> None:
    def stays_low(evidence: Evidence, _: Arguments) -> FloatArray:
        high = evidence.position("ball")[:, 2] > 0.5
        return np.where(high, -1.0, 1.0)

    trace = replace(trace_of({"ball": heights([0.1, float("nan")])}, {"start": 0.0, "end": 0.1}), log="drive.mcap")
    found = judge(replace(ABOVE, evaluate=stays_low), {"thing": "ball"}, ALL, trace, {})
    assert found.outcome is Outcome.UNKNOWN


@pytest.mark.parametrize("question", ["orientation", "velocity", "position_at", "orientation_at", "gripped"])
def test_every_question_about_a_gap_is_refused(question: str) -> None:
    trace = trace_of({"ball": heights([0.1, float("nan"), 0.1])}, {"start": 0.0, "end": 0.2})
    turns = np.where(np.isnan(trace.positions[:, :, 2:]), np.nan, trace.orientations)
    grips = {"arm": np.array([[1.0], [np.nan], [1.0]])}
    trace = replace(trace, log="drive.mcap", orientations=turns, grips=grips)

    def asked(evidence: Evidence, _: Arguments) -> FloatArray:
        if question == "gripped":
            return evidence.gripped("arm", "ball")
        more = (evidence.times,) if question.endswith("_at") else ()
        values: FloatArray = getattr(evidence, question)("ball", *more)
        return np.nan_to_num(values[:, 0]) + 1.0

    found = judge(replace(ABOVE, evaluate=asked), {"thing": "ball"}, ALL, trace, {})
    assert (found.outcome, found.cause) == (Outcome.UNKNOWN, Cause.UNOBSERVED)


def test_the_truth_of_a_topic_is_known_throughout_the_window_or_refused() -> None:
    def said(evidence: Evidence, _: Arguments) -> FloatArray:
        return evidence.truth("/seen")

    trace = replace(trace_of({"ball": still(3)}, {"start": 0.0, "end": 0.2}), log="drive.mcap")
    reported = replace(ABOVE, evaluate=said)

    def judged_on(*values: float) -> Verdict:
        return judge(reported, {"thing": "ball"}, ALL, replace(trace, truths={"/seen": np.array(values)}), {})

    assert judged_on(1.0, 1.0, 1.0).outcome is Outcome.HOLDS
    assert judged_on(1.0, -1.0, 1.0).outcome is Outcome.VIOLATED
    unreported = unknown("the topic '/seen' reports nothing known at 0.10 s", Cause.UNOBSERVED)
    assert judged_on(1.0, float("nan"), 1.0) == unreported


def test_a_condition_that_never_applied_is_the_reason_for_what_holds() -> None:
    trace = trace_of({"ball": heights([-0.3, -0.1]), "lid": heights([-1.0, -2.0])}, {"start": 0.0})
    found = judge(ABOVE, {"thing": "ball"}, After("start", 0.1), trace, {}, (ABOVE, {"thing": "lid"}))
    assert found.outcome is Outcome.HOLDS
    assert found.reason == found.vacuous != ""


def test_a_condition_that_is_never_known_leaves_a_violation_unknown() -> None:
    trace = trace_of({"ball": heights([-0.3]), "lid": heights([float("nan")])}, {"start": 0.0})
    found = judge(ABOVE, {"thing": "ball"}, After("start"), trace, {}, (ABOVE, {"thing": "lid"}))
    assert found == unknown("its condition is not known at 0.00 s", Cause.NO_RECORD)


def test_at_some_time_holds_at_a_margin_of_zero() -> None:
    assert at_some_time([-1.0, -0.3, 0.0, -0.1], 0.2).outcome is Outcome.HOLDS


def test_the_margin_counts_samples_at_which_the_condition_may_hold() -> None:
    trace = trace_of({"ball": heights([0.3, 0.1, 0.2]), "lid": heights([1.0, float("nan"), -1.0])}, {"start": 0.0})
    found = judge(ABOVE, {"thing": "ball"}, After("start", 0.2), trace, {}, (ABOVE, {"thing": "lid"}))
    assert (found.outcome, found.robustness) == (Outcome.HOLDS, 0.1)
