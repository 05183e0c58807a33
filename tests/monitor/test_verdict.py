"""Strong Kleene logic on verdicts, with robustness as minimum and maximum."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

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
