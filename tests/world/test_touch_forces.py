"""Contacts of chosen elements are measured in every step, also while objects sleep."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Timing
from robbdd_tools.monitor.trace import Trace
from world.worlds import BALL, BIN, BIN_WS, CUBE, PANDA, SCENE, execution, pick_place

pytestmark = pytest.mark.physics
BENCH = "env:bench"


@pytest.fixture(scope="module")
def carried() -> Trace:
    """The cube is carried from the bench into a bin."""
    run = execution([pick_place(CUBE, BIN_WS)], timing=Timing(tail=1.0, touching=frozenset({CUBE, BIN_WS})))
    return run.complete(run.advance_until(lambda _: False))


def test_an_object_that_sleeps_from_the_first_sample_on_keeps_its_contact(carried: Trace) -> None:
    at_rest = carried.touches[CUBE, BENCH][:20]
    assert at_rest[0] > 0.1
    assert at_rest == pytest.approx([at_rest[0]] * 20, rel=0.05)


def test_a_contact_ends_when_the_object_leaves_and_begins_where_it_arrives(carried: Trace) -> None:
    held = carried.touches[CUBE, PANDA] > 1.0
    height = carried.positions[:, carried.column(CUBE), 2]
    lifted = held & (height > height[0] + 0.1)
    assert lifted.any()
    assert carried.touches[CUBE, BENCH][lifted].max() == 0.0
    assert carried.touches[CUBE, PANDA][-1] == 0.0
    assert carried.touches[CUBE, BIN][-1] > 0.1
    assert (CUBE, BENCH) in carried.touches
    assert carried.touches[CUBE, BENCH][-1] == 0.0


def test_what_lies_in_a_drawer_touches_the_chest_that_it_belongs_to() -> None:
    drawer = "env:drawer"
    scene = replace(
        SCENE,
        objects=(CUBE, drawer, "env:bench"),
        workspaces={"env:bench_ws": ("env:bench",), "env:drawer_ws": (drawer,)},
        contains={"env:bench_ws": ("env:drawer_ws",)},
        places={CUBE: "env:drawer_ws"},
    )
    run = execution(scene=scene, timing=Timing(tail=0.5, touching=frozenset({CUBE})))
    trace = run.complete(run.advance_until(lambda _: False))
    assert trace.touches[CUBE, drawer][-1] > 0.1
    assert list(trace.touches) == [(CUBE, drawer)]


def test_both_sides_of_a_contact_have_the_same_force(carried: Trace) -> None:
    assert np.array_equal(carried.touches[CUBE, BIN], carried.touches[BIN, CUBE])


def test_what_never_touches_has_no_entry_but_is_known(carried: Trace) -> None:
    assert (CUBE, BALL) not in carried.touches
    assert set(carried.touch_watched) == {CUBE, BIN}


def test_without_a_clause_about_touching_nothing_is_recorded() -> None:
    run = execution()
    trace = run.complete(run.advance_until(lambda found: found.end > 0.1))
    assert (trace.touches, trace.touch_watched) == ({}, ())
