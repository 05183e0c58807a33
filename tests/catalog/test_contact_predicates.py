"""Predicates of contact, rest and fit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from catalog.judged_predicates import judged, world
from monitor.traces import still
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome

SMALL_BALL = {"ball": (((0.0, 0.0, 0.0), 0.05),)}
CORNERS = {"ball": tuple(((x, y, z), 0.0) for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05))}


@pytest.mark.parametrize(
    ("place", "margin"),
    [
        ((0.0, 0.0, 0.05), 0.05),
        ((0.0, 0.05, 0.05), 0.0),
        ((0.0, 0.06, 0.05), -0.01),  # located at the tray, but it sticks out
        ((0.0, 0.0, 0.16), -0.01),  # higher than the rim
        ((0.5, 0.0, 0.05), -0.35),
    ],
)
def test_entirely_inside_is_the_distance_of_the_farthest_point(
    place: tuple[float, float, float], margin: float
) -> None:
    trace = replace(world(ball=still(2, place)), outlines=SMALL_BALL)
    found = judged("is-entirely-inside", trace, object="ball", workspace="tray_ws")
    assert found.robustness == pytest.approx(margin, abs=1e-9)


def test_a_turned_box_sticks_out_with_its_corner() -> None:
    trace = replace(world(ball=still(2, (0.0, 0.045, 0.05))), outlines=CORNERS)
    assert judged("is-entirely-inside", trace, object="ball", workspace="tray_ws").outcome is Outcome.HOLDS
    orientations = trace.orientations.copy()
    orientations[:, trace.column("ball")] = (np.cos(np.pi / 8), 0.0, 0.0, np.sin(np.pi / 8))
    turned = judged("is-entirely-inside", replace(trace, orientations=orientations), object="ball", workspace="tray_ws")
    assert turned.robustness == pytest.approx(0.1 - 0.045 - 0.05 * np.sqrt(2))


def test_an_object_without_an_outline_is_unknown_where_all_of_it_counts() -> None:
    trace = world(ball=still(2, (0.0, 0.0, 0.05)))
    for outlines in ({}, {"ball": ()}):
        bare = replace(trace, outlines=outlines)
        assert judged("is-entirely-inside", bare, object="ball", workspace="tray_ws").outcome is Outcome.UNKNOWN
        assert judged("is-at-rest", bare, object="ball").outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(("way", "margin"), [(0.0, 0.01), (0.001, 0.0), (0.0015, -0.005)])
def test_what_shifts_is_not_at_rest(way: float, margin: float) -> None:
    trace = replace(world(ball=[[0.0, 0.0, 0.1], [way, 0.0, 0.1]]), outlines=SMALL_BALL)
    assert judged("is-at-rest", trace, object="ball").robustness == pytest.approx(margin, abs=1e-9)


def test_what_turns_on_the_spot_is_not_at_rest() -> None:
    trace = replace(world(ball=still(2, (0.0, 0.0, 0.1))), outlines=CORNERS)
    orientations = trace.orientations.copy()
    orientations[1, trace.column("ball")] = (-np.cos(0.01), 0.0, 0.0, -np.sin(0.01))  # 0.02 rad in 0.1 s, as -q
    found = judged("is-at-rest", replace(trace, orientations=orientations), object="ball")
    assert found.robustness == pytest.approx(0.01 - 0.2 * 0.05 * np.sqrt(3))


def test_one_sample_does_not_show_rest() -> None:
    trace = replace(world(1, ball=still(1)), outlines=SMALL_BALL)
    assert judged("is-at-rest", trace, object="ball").outcome is Outcome.UNKNOWN


def touching(force: float, watched: tuple[str, ...] = ("ball",)) -> Trace:
    pressed = {("ball", "tray"): np.array([0.0, force])} if force else {}
    return replace(world(ball=still(2)), touches=pressed, touch_watched=watched)


@pytest.mark.parametrize(
    ("force", "touches", "apart"), [(0.0, -0.01, 0.0), (0.009, -0.01, 0.0), (0.01, -0.01, -0.01), (3.0, -0.01, -3.0)]
)
def test_touching_is_a_contact_force_at_each_sample(force: float, touches: float, apart: float) -> None:
    for one, other in (("ball", "tray"), ("tray", "ball"), ("ball", "tray_ws")):
        found = judged("touches", touching(force), one=one, other=other)
        assert found.robustness == pytest.approx(touches)  # the first sample has no contact
        assert judged("does-not-touch", touching(force), one=one, other=other).robustness == pytest.approx(apart)


def test_a_force_is_compared_with_the_limit() -> None:
    found = judged("presses-with-less-than", touching(3.0), one="ball", other="tray_ws", limit="2 N")
    assert (found.outcome, found.robustness, found.unit) == (Outcome.VIOLATED, pytest.approx(-1.0), "N")
    assert judged("presses-with-less-than", touching(3.0), one="ball", other="tray", limit="3 N").robustness == 0.0


@pytest.mark.parametrize("predicate", ["touches", "does-not-touch"])
def test_forces_that_were_not_recorded_are_unknown(predicate: str) -> None:
    assert judged(predicate, touching(0.0, ()), one="ball", other="tray").outcome is Outcome.UNKNOWN
    assert judged(predicate, touching(0.0), one="far", other="tray").outcome is Outcome.UNKNOWN
    assert judged(predicate, touching(0.0), one="tray_ws", other="tray").outcome is Outcome.UNKNOWN
    # One of the two trays was watched by nobody.
    assert judged(predicate, touching(0.0, ("tray",)), one="both_ws", other="ball").outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(
    ("place", "force", "margin"),
    [
        ((0.0, 0.0, 0.15), 1.0, 0.1),
        ((0.0, 0.06, 0.15), 1.0, 0.04),
        ((0.0, 0.1, 0.15), 1.0, 0.0),
        ((0.0, 0.11, 0.15), 1.0, -0.01),  # it leans over the edge
        ((0.18, 0.0, 0.15), 1.0, 0.02),
        ((0.0, 0.0, 0.0), 1.0, -0.05),  # it is inside, or hangs through
        ((0.0, 0.11, 0.0), 1.0, -0.05),  # it touches the side
        ((0.0, 0.0, 0.15), 0.0, -0.05),  # it hovers
        ((0.0, 0.0, 0.1), 0.0, -0.0001),  # it is let go of without contact
    ],
)
def test_on_top_needs_contact_and_the_centre_above(
    place: tuple[float, float, float], force: float, margin: float
) -> None:
    slab = tuple(((x, y, z), 0.0) for x in (-0.2, 0.2) for y in (-0.1, 0.1) for z in (0.0, 0.05))
    trace = replace(
        world(ball=still(2, place)),
        outlines={**SMALL_BALL, "tray": slab},
        touches={("ball", "tray"): np.full(2, force)},
        touch_watched=("ball", "tray"),
    )
    found = judged("is-on-top-of", trace, one="ball", other="tray")
    assert found.robustness == pytest.approx(margin, abs=1e-9)


@pytest.mark.parametrize(("lowest", "margin"), [(0.05, 0.05), (0.0015, 0.05), (0.0005, -0.0006), (-0.02, -0.0211)])
def test_what_reaches_down_as_far_as_another_object_stands_beside_it(lowest: float, margin: float) -> None:
    """A post, 0.2 m high, that touches the inner side of a frame, 50 mm high, does not stand on the frame."""
    frame = tuple(((x, y, z), 0.0) for x in (-0.2, 0.2) for y in (-0.1, 0.1) for z in (0.0, 0.05))
    post = (((0.0, 0.0, 0.1), 0.0), ((0.0, 0.0, lowest - 0.1), 0.0))
    trace = replace(
        world(ball=still(2, (0.0, 0.0, 0.1))),
        outlines={"ball": post, "tray": frame},
        touches={("ball", "tray"): np.ones(2)},
        touch_watched=("ball", "tray"),
    )
    assert judged("is-on-top-of", trace, one="ball", other="tray").robustness == pytest.approx(margin, abs=1e-9)


def test_on_top_is_unknown_without_forces_or_outlines() -> None:
    trace = replace(world(ball=still(2, (0.0, 0.0, 0.15))), outlines={**SMALL_BALL, "tray": SMALL_BALL["ball"]})
    assert judged("is-on-top-of", trace, one="ball", other="tray").outcome is Outcome.UNKNOWN
    felt = replace(trace, touch_watched=("ball",), outlines=SMALL_BALL)
    assert judged("is-on-top-of", felt, one="ball", other="tray").outcome is Outcome.UNKNOWN


def test_the_footprint_turns_with_the_object() -> None:
    bar = tuple(((x, y, z), 0.0) for x in (-0.2, 0.2) for y in (-0.02, 0.02) for z in (-0.05, 0.05))
    trace = replace(
        world(ball=still(2, (0.0, 0.1, 0.1))),
        outlines={**SMALL_BALL, "tray": bar},
        touches={("ball", "tray"): np.ones(2)},
    )
    assert judged("is-on-top-of", trace, one="ball", other="tray").robustness == pytest.approx(-0.08)
    orientations = trace.orientations.copy()
    orientations[:, trace.column("tray")] = (np.cos(np.pi / 4), 0.0, 0.0, np.sin(np.pi / 4))
    turned = replace(trace, orientations=orientations)
    assert judged("is-on-top-of", turned, one="ball", other="tray").robustness == pytest.approx(0.02)
