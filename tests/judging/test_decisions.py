"""Deciding clauses on traces made by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from monitor.traces import still, trace_of
from robbdd_tools.catalog.api import Region
from robbdd_tools.judging.decisions import alternatives, decide, is_closed, occurred
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.unobserved import Unobserved
from robbdd_tools.monitor.verdict import Cause, Outcome, unknown
from robbdd_tools.protocol.clauses import Fluent
from robbdd_tools.user_code.calls import UserCodeError

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

BOX = Region((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
REGIONS = {"left": (("bin1", BOX),), "right": (("bin2", BOX),)}
EVENTS = {"t:e": "pick-start", "t:later": "pick-end"}


def a_trace(finished: bool = True) -> Trace:
    paths = {
        "bin1": still(5, (0.0, 0.0, 0.0)),
        "bin2": still(5, (1.0, 0.0, 0.0)),
        "ball": still(5, (0.0, 0.0, 0.02)),
        "cube": still(5, (1.0, 0.0, 0.05)),
    }
    return trace_of(paths, {"t:e": 0.2}, {"arm": {"ball": [1.0] * 5}}, finished)


@pytest.mark.parametrize(
    ("sentence", "outcome", "robustness"),
    [
        ('"ball" is located at "left" after event "t:e"', Outcome.HOLDS, 0.08),
        ('not ( "ball" is located at "left" after event "t:e" )', Outcome.VIOLATED, -0.08),
        ('"ball" is located at "any of [\'right\', \'left\']" after event "t:e"', Outcome.HOLDS, 0.08),
        ('"any of [\'ball\', \'cube\']" is located at "right" after event "t:e"', Outcome.HOLDS, 0.05),
        ('"[\'ball\', \'cube\']" is located at "left" after event "t:e"', Outcome.VIOLATED, -0.9),
        ("\"['ball', 'cube']\" are sorted into \"['left', 'right']\" after event \"t:e\"", Outcome.HOLDS, 0.05),
        ('"ball" are sorted into "left" after event "t:e"', Outcome.HOLDS, 0.08),
        (
            '( "ball" is located at "right" after event "t:e" or "ball" is held by "arm" after event "t:e" )',
            Outcome.HOLDS,
            1.0,
        ),
        ('( the lamp is green or "ball" is held by "arm" after event "t:e" )', Outcome.HOLDS, 1.0),
        ('"ball" is located at "left" whenever "ball" is held by "arm" after event "t:e"', Outcome.HOLDS, 0.08),
        ('"ball" is located at "right" whenever "ball" is held by "arm" after event "t:e"', Outcome.VIOLATED, -0.9),
        ('"ball" is located at "right" whenever "cube" is held by "arm" after event "t:e"', Outcome.HOLDS, None),
        (
            'not ( "ball" is located at "right" whenever "cube" is held by "arm" after event "t:e" )',
            Outcome.VIOLATED,
            None,
        ),
        (
            "\"['ball', 'cube']\" is located at \"left\" whenever \"['ball', 'cube']\" is held by \"arm\""
            ' after event "t:e"',
            Outcome.HOLDS,
            0.08,
        ),
        (
            '"ball" is located at "left" whenever "ball" is located at "any of [\'left\', \'right\']"'
            ' after event "t:e"',
            Outcome.HOLDS,
            0.08,
        ),
        (
            '( "ball" is located at "right" whenever "cube" is held by "arm" after event "t:e"'
            ' and "ball" is located at "left" after event "t:e" )',
            Outcome.HOLDS,
            0.08,
        ),
        ('( the lamp is green and "ball" is held by "arm" after event "t:e" )', Outcome.UNKNOWN, None),
    ],
)
def test_decides(sentence: str, outcome: Outcome, robustness: float | None) -> None:
    found = decide(read_clause(sentence), a_trace(), REGIONS, EVENTS.keys())
    assert found.outcome is outcome
    assert found.robustness == (None if robustness is None else pytest.approx(robustness))


NEGATIVE = "the limit '-1 m{}' is negative, so its clause would always have the same verdict: remove the sign"


@pytest.mark.parametrize(
    ("sentence", "reason"),
    [
        ('"ball" is farther than "-1 m" from "cube" after event "t:e"', NEGATIVE.format("")),
        ('not ( "ball" is nearer than "-1 m" to "cube" after event "t:e" )', NEGATIVE.format("")),
        ('"ball" moves slower than "-1 m/s" after event "t:e"', NEGATIVE.format("/s")),
        (
            '"ball" is farther than "1 kg" from "cube" after event "t:e"',
            "'1 kg' is a mass, not a length: write a length with its unit, as in '5 m'",
        ),
        ('"ball" is farther than "1e400 m" from "cube" after event "t:e"', "the number in '1e400 m' is too large"),
    ],
)
def test_a_limit_that_is_no_limit_decides_nothing(sentence: str, reason: str) -> None:
    found = decide(read_clause(sentence), a_trace(), REGIONS, EVENTS.keys())
    assert (found.outcome, found.cause, found.reason) == (Outcome.UNKNOWN, Cause.UNOBSERVED, reason)


LEFT, HELD = '"ball" is located at "left" after event "t:e"', '"ball" is held by "arm" after event "t:e"'
RIGHT = '"ball" is located at "right" after event "t:e"'


@pytest.mark.parametrize(
    ("sentence", "operand", "unit"),
    [
        (LEFT, 0, "m"),
        (f"( {RIGHT} or {LEFT} )", 1, "m"),
        (f"( {HELD} and {LEFT} )", 1, "m"),
        (f"( {RIGHT} or not ( {LEFT} ) )", 1, "m"),
        (f"( the lamp is green or ( {RIGHT} or {HELD} ) )", 1, ""),
    ],
)
def test_the_fluent_that_decides_is_named(sentence: str, operand: int, unit: str) -> None:
    found = decide(read_clause(sentence), a_trace(), REGIONS, EVENTS.keys())
    assert (found.operand, found.unit) == (operand, unit)


@pytest.mark.parametrize(
    ("sentence", "cause"),
    [
        ("the lamp is green", Cause.NO_STEP),
        ('"ball" is located at "left" after event "t:other"', Cause.NO_EMITTER),
        ('"ball" is located at "left" after event "t:later"', Cause.NO_EVENT),
        ('"ball" has config "mass" = "1" before event "t:e"', Cause.NO_RECORD),
        ('"ball" is located at "any of []" after event "t:e"', Cause.EMPTY),
        (LEFT, None),
    ],
)
def test_causes_of_unknown_verdicts_are_told_apart_without_words(sentence: str, cause: Cause | None) -> None:
    assert decide(read_clause(sentence), a_trace(), REGIONS, EVENTS.keys()).cause is cause


@pytest.mark.parametrize(
    ("sentence", "reason"),
    [
        ("the lamp is green", "no step definition for 'the lamp is green'"),
        ('"ball" is located at "left" after event "t:other"', "nothing in the scenario emits event t:other"),
        ('"ball" is located at "left" after event "t:later"', "event t:later never occurred"),
        ('"ball" has config "mass" = "1" before event "t:e"', "the trace has no record of 'ball mass'"),
        ('"ball" is located at "nowhere" after event "t:e"', "the trace has no record of 'nowhere'"),
        ('"ball" is located at "any of []" after event "t:e"', "there is nothing to judge: the set is empty"),
    ],
)
def test_says_why_it_is_unknown(sentence: str, reason: str) -> None:
    found = decide(read_clause(sentence), a_trace(), REGIONS, EVENTS.keys())
    assert (found.outcome, found.reason) == (Outcome.UNKNOWN, reason)


def test_a_clause_stays_open_until_all_its_windows_are_closed() -> None:
    both = read_clause(
        '( "ball" is located at "left" after event "t:e" and "ball" is located at "left" after event "t:later" )'
    )
    assert not is_closed(both, a_trace(finished=False), EVENTS.keys())
    assert is_closed(both, a_trace(finished=True), EVENTS.keys())


def test_nobody_waits_for_what_cannot_be_judged() -> None:
    for sentence in (
        "the lamp is green",
        '"ball" is located at "left" after event "t:other"',
    ):
        assert is_closed(read_clause(sentence), a_trace(finished=False), EVENTS.keys())


def failing(error: Exception) -> Fluent:
    """Return a clause whose evaluator fails."""

    def evaluate(*_: object) -> FloatArray:
        raise error

    clause = read_clause(LEFT)
    assert isinstance(clause, Fluent)
    return replace(clause, predicate=replace(clause.predicate, evaluate=evaluate))


def test_a_failure_of_an_evaluator_is_missing_evidence_and_kept() -> None:
    found = decide(failing(ZeroDivisionError("by zero")), a_trace(), REGIONS, EVENTS.keys())
    assert (found.outcome, found.cause) == (Outcome.UNKNOWN, Cause.USER_CODE)
    assert found.reason == "the evaluator of 'located-at' failed: ZeroDivisionError: by zero"
    assert found.fault is not None
    assert (found.fault.exception, found.fault.code) == ("ZeroDivisionError", "located-at")


def test_an_invalid_configuration_is_missing_evidence_and_no_failure_of_code() -> None:
    found = decide(
        read_clause('"arm" has config "ee_speed" = "ball" before event "t:e"'), a_trace(), REGIONS, EVENTS.keys()
    )
    assert (found.outcome, found.fault) == (Outcome.UNKNOWN, None)
    assert found.reason == "'ee_speed' cannot be 'ball': it must be a number from 0.01 to 3 m/s"


def test_a_failure_of_users_code_and_a_missing_observation_have_their_causes() -> None:
    fault = Fault("KeyError", "x", "policy:judge")
    found = decide(failing(UserCodeError("policy:judge failed", fault)), a_trace(), REGIONS, EVENTS.keys())
    assert found == replace(unknown("policy:judge failed", Cause.USER_CODE, fault=fault), operand=0)
    found = decide(failing(Unobserved("nobody looked")), a_trace(), REGIONS, EVENTS.keys())
    assert found == replace(unknown("nobody looked", Cause.UNOBSERVED), operand=0)


def test_what_was_never_reached_is_unknown_whatever_the_clause() -> None:
    trace = replace(a_trace(), unreached="the tree failed before")
    for sentence in (LEFT, "the lamp is green"):
        found = decide(read_clause(sentence), trace, REGIONS, EVENTS.keys())
        assert found == unknown("the tree failed before", Cause.UNREACHED)


def test_without_evaluator_a_missing_emitter_is_no_reason() -> None:
    clause = read_clause('"ball" is located at "left" after event "t:other"')
    assert isinstance(clause, Fluent)
    mute = replace(clause, predicate=replace(clause.predicate, evaluate=None))
    assert decide(mute, a_trace(), REGIONS, EVENTS.keys()).cause is Cause.NO_STEP
    assert is_closed(mute, a_trace(finished=False), EVENTS.keys())


def test_both_events_of_an_interval_must_be_emitted() -> None:
    for start, end in (("t:e", "t:other"), ("t:other", "t:e")):
        clause = read_clause(f'"ball" is located at "left" from "{start}" until "{end}"')
        assert decide(clause, a_trace(), REGIONS, EVENTS.keys()).reason == (
            "nothing in the scenario emits event t:other"
        )
        assert is_closed(clause, a_trace(finished=False), EVENTS.keys())


def test_each_existential_slot_is_chosen_by_itself() -> None:
    some = "\"any of ['ball', 'cube']\" is located at \"any of ['right', 'left']\" after event \"t:e\""
    clause = read_clause(some)
    assert isinstance(clause, Fluent)
    assert [[dict(one.arguments) for one in group] for group in alternatives(clause)] == [
        [{"object": "ball", "workspace": "right"}],
        [{"object": "ball", "workspace": "left"}],
        [{"object": "cube", "workspace": "right"}],
        [{"object": "cube", "workspace": "left"}],
    ]


def test_of_a_set_every_member_must_hold() -> None:
    clause = read_clause("\"['ball', 'cube']\" is located at \"any of ['left', 'right']\" after event \"t:e\"")
    assert isinstance(clause, Fluent)
    assert [
        [(one.arguments["object"], one.arguments["workspace"]) for one in group] for group in alternatives(clause)
    ] == [
        [("ball", "left"), ("cube", "left")],
        [("ball", "right"), ("cube", "right")],
    ]


def test_an_event_that_has_not_occurred_passes_nothing() -> None:
    assert (occurred(a_trace(), "t:e", 0).outcome, occurred(a_trace(), "t:e", 0).at) == (Outcome.HOLDS, 0.2)
    assert occurred(a_trace(), "t:later", 0) == unknown("event t:later never occurred", Cause.NO_EVENT)
    unreached = replace(a_trace(), unreached="another branch was taken")
    assert occurred(unreached, "t:e", 0) == unknown("another branch was taken", Cause.UNREACHED)
