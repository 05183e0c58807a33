"""Impacts on a fixed table: a short form of the impact study in docs/simulation.md."""

from __future__ import annotations

import pytest

from bench.impact_study import AGENTS, DRIVEN_ON, strike
from robbdd_tools.catalog.predicates.does_not_collide import FORCE_LIMIT

pytestmark = pytest.mark.physics


@pytest.mark.parametrize("agent", AGENTS)
def test_a_faster_blow_is_harder_and_passes_the_limit(agent: str) -> None:
    slow, fast = strike(agent, 0.05), strike(agent, 0.5)
    assert fast.peak > 2 * slow.peak
    assert fast.impulse > 2 * slow.impulse
    assert fast.peak > FORCE_LIMIT
    # Nothing but a change of momentum stops an arm; the servos, which go on pressing, add to it.
    assert fast.impulse > 0.9 * fast.mass * fast.speed


@pytest.mark.parametrize("agent", AGENTS)
def test_an_arm_that_is_driven_on_passes_the_limit_even_when_slow(agent: str) -> None:
    assert strike(agent, 0.02, DRIVEN_ON).peak > FORCE_LIMIT


def test_a_careful_touch_that_is_noticed_stays_below_the_limit() -> None:
    for agent in ("env:panda", "env:kinova"):
        assert 1.0 < strike(agent, 0.05).peak < FORCE_LIMIT
