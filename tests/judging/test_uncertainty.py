"""Where errors of the measurements could change a verdict, it is unknown."""

from __future__ import annotations

from dataclasses import replace

import pytest

from monitor.traces import still, trace_of
from robbdd_tools.catalog.api import Region
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.trace import OTHERS, Trace
from robbdd_tools.monitor.verdict import Verdict

BOX = Region((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
REGIONS = {"left": (("bin", BOX),)}
INSIDE = '"ball" is located at "left" after event "t:e"'
NEAR = '"ball" is nearer than "50 mm" to "cup" after event "t:e"'
TILT = '"ball" is tilted less than "10 deg" after event "t:e"'
FAST = '"arm" moves slower than "1 m/s" after event "t:e"'
PUSHED = '"arm" does not collide "ball" after event "t:e"'
LOOSE = '"arm" does not drop "ball" after event "t:e"'
HELD = '"ball" is held by "arm" after event "t:e"'


def measured(errors: dict[str, float]) -> Trace:
    paths = {
        "bin": still(9, (0.0, 0.0, 0.0)),
        "ball": still(9, (0.0, 0.0, 0.07)),
        "cup": still(9, (0.03, 0.0, 0.07)),
        "arm": still(9, (0.0, 0.0, 1.0)),
    }
    trace = trace_of(paths, {"t:e": 0.2}, {"arm": {"ball": [1.0] * 9}}, True)
    return replace(trace, log="drive", uncertain=errors)


def judged(sentence: str, errors: dict[str, float]) -> Verdict:
    clause = read_clause(sentence)
    return decide(clause, measured(errors), REGIONS, {"t:e"})


@pytest.mark.parametrize(
    ("sentence", "errors", "outcome"),
    [
        # The margin is 30 mm.
        (INSIDE, {}, "holds"),
        (INSIDE, {OTHERS: 0.0149}, "holds"),
        (INSIDE, {OTHERS: 0.0151}, "unknown"),
        (INSIDE, {OTHERS: 0.0151, "cup": 9.0}, "unknown"),
        (INSIDE, {"ball": 0.029, "cup": 9.0}, "holds"),
        (INSIDE, {"ball": 0.02, "bin": 0.011}, "unknown"),
        (f"not ( {INSIDE} )", {OTHERS: 0.0149}, "violated"),
        (f"not ( {INSIDE} )", {OTHERS: 0.0151}, "unknown"),
        # The margin is 20 mm, in the unit of the clause.
        (NEAR, {OTHERS: 0.0099}, "holds"),
        (NEAR, {OTHERS: 0.0101}, "unknown"),
        (NEAR.replace("50", "10"), {OTHERS: 0.0099}, "violated"),
        (NEAR.replace("50", "10"), {OTHERS: 0.0101}, "unknown"),
        # The margin is 10 deg.
        (TILT, {OTHERS: 0.001}, "unknown"),
        (TILT, {"angle": 0.17}, "holds"),
        (TILT, {"angle": 0.18}, "unknown"),
        (FAST, {OTHERS: 0.001}, "unknown"),
        (FAST, {"speed": 0.9}, "holds"),
        (FAST, {"speed": 1.1}, "unknown"),
        (PUSHED, {}, "holds"),
        # The ball is still: the margin is 50 mm.
        (PUSHED, {OTHERS: 0.0124}, "holds"),
        (PUSHED, {OTHERS: 0.0126}, "unknown"),
        (PUSHED, {"ball": 0.0124, "arm": 9.0}, "holds"),
        (HELD, {OTHERS: 9.0}, "holds"),
        (f"( {INSIDE} or {HELD} )", {OTHERS: 9.0}, "holds"),
        (f"( {INSIDE} and {HELD} )", {OTHERS: 9.0}, "unknown"),
    ],
)
def test_a_verdict_that_an_error_could_change_is_unknown(sentence: str, errors: dict[str, float], outcome: str) -> None:
    assert judged(sentence, errors).outcome == outcome


def test_the_reason_has_the_margin_and_the_uncertainty_in_the_unit_of_the_clause() -> None:
    words = "its margin of +20 mm is within the uncertainty of the measurements, ±22 mm"
    assert judged(NEAR, {OTHERS: 0.011}).reason == words
    assert judged(TILT, {OTHERS: 0.1}).reason == "the uncertainty of an angle is not stated: add --uncertainty '2 deg'"
    assert judged(LOOSE, {OTHERS: 0.1}).reason == (
        "how uncertain the margin of 'does-not-drop' is cannot be computed from the uncertainty of the measurements"
    )


@pytest.mark.parametrize(
    ("distance", "errors", "outcome"),
    [
        # The ball and the cup are 30 mm apart, and the ball is outside of the workspace.
        ("50 mm", {}, "violated"),
        ("50 mm", {OTHERS: 0.009}, "violated"),
        ("50 mm", {OTHERS: 0.011}, "unknown"),
        ("10 mm", {OTHERS: 0.009}, "holds"),
        ("10 mm", {OTHERS: 0.011}, "unknown"),
    ],
)
def test_a_condition_that_an_error_could_change_makes_the_clause_unknown(
    distance: str, errors: dict[str, float], outcome: str
) -> None:
    sentence = f'"arm" is nearer than "0.5 m" to "ball" whenever "ball" is nearer than "{distance}" to "cup"'
    assert judged(f'{sentence} after event "t:e"', errors).outcome == outcome


def test_a_condition_that_an_error_could_change_does_not_matter_if_the_clause_holds_anyway() -> None:
    sentence = '"arm" is nearer than "2 m" to "ball" whenever "ball" is nearer than "31 mm" to "cup" after event "t:e"'
    assert judged(sentence, {OTHERS: 0.1}).outcome == "holds"


def test_each_predicate_of_lengths_names_the_effect_of_errors() -> None:
    """A predicate of the list is unknown as soon as an uncertainty is stated: add none without a reason."""
    otherwise = {one.name for one in load_catalog().predicates.values() if one.measured == "otherwise"}
    assert otherwise == {
        "does-not-drop",
        "is-at-rest",
        "is-closed",
        "is-on-top-of",
        "is-open",
        "keeps-distance",
        "keeps-joints-from-limits",
        "object-does-not-collide",
        "stays-near-line",
    }
