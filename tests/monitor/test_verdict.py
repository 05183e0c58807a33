"""Strong Kleene logic on verdicts, with robustness as minimum and maximum."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict, conjunction, disjunction, negation, unknown

ORDER = [Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.HOLDS]


def of(margin: float | None) -> Verdict:
    if margin is None:
        return unknown("no evidence", Cause.NO_RECORD)
    return Verdict(Outcome.HOLDS if margin >= 0 else Outcome.VIOLATED, margin, "m", 1.0)


margins = st.one_of(st.none(), st.floats(-5, 5).filter(lambda value: value != 0))
verdicts = st.lists(margins.map(of), min_size=1, max_size=6)


def rank(verdict: Verdict) -> int:
    return ORDER.index(verdict.outcome)


@given(verdicts)
def test_and_is_the_least_and_or_the_greatest_outcome(operands: list[Verdict]) -> None:
    ranks = [rank(operand) for operand in operands]
    assert rank(conjunction(operands)) == min(ranks)
    assert rank(disjunction(operands)) == max(ranks)


@given(st.lists(st.floats(-5, 5), min_size=1))
def test_robustness_of_and_is_the_minimum_and_of_or_the_maximum(values: list[float]) -> None:
    assert conjunction(of(value) for value in values).robustness == min(values)
    assert disjunction(of(value) for value in values).robustness == max(values)


@given(verdicts)
def test_de_morgan(operands: list[Verdict]) -> None:
    left = negation(conjunction(operands))
    right = disjunction(negation(operand) for operand in operands)
    assert (left.outcome, left.robustness) == (right.outcome, right.robustness)


@given(margins)
def test_negation_twice_changes_nothing(margin: float | None) -> None:
    twice = negation(negation(of(margin)))
    assert (twice.outcome, twice.robustness) == (of(margin).outcome, of(margin).robustness)


def test_negation_of_unknown_keeps_its_reason() -> None:
    assert negation(unknown("no evidence", Cause.NO_RECORD)) == unknown("no evidence", Cause.NO_RECORD)


def test_unknown_never_passes_through_and() -> None:
    assert conjunction([of(1.0), unknown("no evidence", Cause.NO_RECORD)]).outcome is Outcome.UNKNOWN
    assert conjunction([of(-1.0), unknown("no evidence", Cause.NO_RECORD)]).outcome is Outcome.VIOLATED


def test_unknown_does_not_hide_a_fulfilled_alternative() -> None:
    assert disjunction([of(1.0), unknown("no evidence", Cause.NO_RECORD)]) == of(1.0)
    assert disjunction([of(-1.0), unknown("no evidence", Cause.NO_RECORD)]).outcome is Outcome.UNKNOWN


def test_nothing_to_judge_is_unknown() -> None:
    assert conjunction([]).outcome is disjunction([]).outcome is Outcome.UNKNOWN


def test_nothing_to_judge_could_not_have_been_violated() -> None:
    empty = unknown(
        "there is nothing to judge: the set is empty", Cause.EMPTY, "a set that it quantifies over is empty"
    )
    assert conjunction([]) == disjunction([]) == empty


def test_the_margin_of_a_negation_has_the_other_sign_at_the_worst_instant() -> None:
    violated = Verdict(Outcome.VIOLATED, -2.0, "m", at=1.0, worst_at=3.0, reason="too low", operand=1)
    assert negation(violated) == Verdict(Outcome.HOLDS, 2.0, "m", at=3.0, worst_at=3.0, operand=1)
    assert negation(Verdict(Outcome.HOLDS, 2.0, "m", 1.0, worst_at=1.0)).outcome is Outcome.VIOLATED


def test_the_first_unknown_of_several_is_the_answer() -> None:
    first, second = unknown("one", Cause.NO_RECORD), unknown("two", Cause.NO_EVENT)
    assert conjunction([of(1.0), first, second]) == first
    assert disjunction([of(-1.0), first, second]) == first


def test_the_verdict_that_decides_is_returned() -> None:
    low, high = replace(of(-1.0), operand=0), replace(of(-3.0), operand=1)
    assert conjunction([low, of(2.0), high]) is high
    assert disjunction([low, high]) is low
    assert disjunction([high, of(1.0), of(2.0)]).robustness == 2.0


def test_margins_of_several_units_are_compared_in_si_units() -> None:
    slow, near = Verdict(Outcome.HOLDS, 0.3, "m/s"), Verdict(Outcome.HOLDS, 20.0, "cm")
    assert conjunction([slow, near]) is near
    assert disjunction([slow, near]) is slow


def test_margins_are_those_of_the_operands_that_have_one() -> None:
    holds = Verdict(Outcome.HOLDS)
    assert conjunction([holds, holds]) is holds
    assert conjunction([of(2.0), holds, of(1.0)]).robustness == 1.0
    assert negation(holds).outcome is Outcome.VIOLATED
    assert disjunction([holds, of(0.5)]).robustness == 0.5


def test_a_fault_of_users_code_stays_with_its_verdict() -> None:
    fault = Fault("KeyError", "x", "policy:judge")
    found = unknown("its policy failed", Cause.USER_CODE, fault=fault)
    assert (found.outcome, found.reason, found.cause, found.fault) == (
        Outcome.UNKNOWN,
        "its policy failed",
        Cause.USER_CODE,
        fault,
    )
