"""Accepted changes as users write them."""

from __future__ import annotations

import math

import pytest

from robbdd_tools.campaign.gate import NotAGate, parse_gate


@pytest.mark.parametrize(
    ("text", "name", "unit", "limit"),
    [
        ("no clause worse than 2 points", "at-goal", "", 0.02),
        ("no clause worse than 1 point", "at-goal", "", 0.01),
        ("no  clause worse than .5%", "at-goal", "", 0.005),
        ("no clause worse than 5 mm", "at-goal", "m", 0.005),
        ("no clause worse than 0.1 m/s", "slow", "m/s", 0.1),
        ("no clause worse than 3 deg", "upright", "rad", math.radians(3)),
        ("at-goal not worse than 2 cm", "at-goal", "m", 0.02),
        ("at-goal not worse than 2 points", "held", "", None),
        ("no clause worse than 5 mm", "at-goal", "", None),
    ],
)
def test_a_gate_limits_a_clause_in_one_unit(text: str, name: str, unit: str, limit: float | None) -> None:
    assert parse_gate([text]).limit(name, unit) == (None if limit is None else pytest.approx(limit))


def test_the_limit_of_one_clause_comes_before_that_of_all() -> None:
    gate = parse_gate(["no clause worse than 2 points", "held not worse than 0 points"])
    assert (gate.limit("held"), gate.limit("at-goal")) == (0.0, 0.02)


@pytest.mark.parametrize("text", ["", "2", "no clause worse", "no clause worse than −2 points", "worse than 2 points"])
def test_other_texts_are_refused_with_an_example(text: str) -> None:
    with pytest.raises(NotAGate, match="write 'no clause worse than 2 points'"):
        parse_gate([text])
