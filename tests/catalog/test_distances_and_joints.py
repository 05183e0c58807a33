"""Predicates about gaps between surfaces, straight paths and joint limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from catalog.judged_predicates import judged, world
from monitor.traces import still
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome


def gapped(*gaps: float) -> Trace:
    """A trace with the gaps (m) between a ball and a tray."""
    return replace(world(len(gaps), ball=still(len(gaps))), gaps={("ball", "tray"): np.array(gaps)})


@pytest.mark.parametrize(
    ("distance", "margin", "unit"), [("5 cm", 2.0, "cm"), ("0.1 m", -0.03, "m"), ("70 mm", 0.0, "mm")]
)
def test_the_smallest_gap_is_compared_in_the_unit_of_the_clause(distance: str, margin: float, unit: str) -> None:
    for one, other in (("ball", "tray"), ("tray", "ball"), ("tray_ws", "ball")):
        found = judged("keeps-distance", gapped(0.2, 0.07, 0.3), one=one, distance=distance, other=other)
        assert (found.robustness, found.unit) == (pytest.approx(margin, abs=1e-12), unit)
    assert judged("keeps-distance", gapped(0.2, 0.07), one="ball", distance="8 cm", other="tray").at == 0.1


def test_overlapping_elements_keep_no_distance() -> None:
    found = judged("keeps-distance", gapped(-0.01, 0.2), one="ball", distance="0 mm", other="tray")
    assert (found.outcome, found.robustness) == (Outcome.VIOLATED, pytest.approx(-10.0))


def test_a_gap_that_was_not_measured_is_unknown() -> None:
    def outcome(trace: Trace, other: str) -> Outcome:
        return judged("keeps-distance", trace, one="ball", distance="1 cm", other=other).outcome

    assert outcome(gapped(0.2, 0.2), "tray") is Outcome.HOLDS
    assert outcome(gapped(0.2, np.nan), "tray") is Outcome.UNKNOWN
    assert outcome(gapped(0.2, 0.2), "far") is Outcome.UNKNOWN
    assert outcome(gapped(0.2, 0.2), "both_ws") is Outcome.UNKNOWN  # the gap to one of its carriers is missing
    assert outcome(gapped(0.2, 0.2), "ball") is Outcome.UNKNOWN
    assert outcome(world(ball=still(2)), "tray") is Outcome.UNKNOWN


@pytest.mark.parametrize(
    ("place", "margin"),
    [
        ((0.5, 0.0, 0.0), 10.0),
        ((0.5, 0.06, 0.08), 0.0),
        ((0.5, 0.0, 0.13), -3.0),
        ((-0.03, 0.04, 0.0), 5.0),  # beyond the start
        ((1.12, 0.0, 0.0), -2.0),  # beyond the end
        ((1.0, 0.0, 0.0), 10.0),
    ],
)
def test_the_distance_from_a_line_ends_at_its_ends(place: tuple[float, float, float], margin: float) -> None:
    for origin, destination in (("tray", "far"), ("far", "tray"), ("tray_ws", "far_ws")):
        found = judged(
            "stays-near-line",
            world(ball=[[0.2, 0.0, 0.0], list(place)]),
            one="ball",
            distance="10 cm",
            origin=origin,
            destination=destination,
        )
        assert (found.robustness, found.unit) == (pytest.approx(margin), "cm")


def test_a_line_may_move_and_may_have_no_length() -> None:
    trace = world(ball=still(2), post=[[0.0, 1.0, 0.0], [0.0, 0.3, 0.4]])
    found = judged("stays-near-line", trace, one="ball", distance="1 m", origin="post", destination="post")
    assert found.robustness == pytest.approx(0.0)
    assert found.worst_at == 0.0


@pytest.mark.parametrize("end", ["nothing", "both_ws"])
def test_a_line_without_a_certain_end_is_unknown(end: str) -> None:
    for origin, destination in ((end, "far"), ("far", end)):
        found = judged(
            "stays-near-line",
            world(ball=still(2)),
            one="ball",
            distance="9 m",
            origin=origin,
            destination=destination,
        )
        assert found.outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(("share", "margin"), [("0 %", 5.0), ("5 %", 0.0), ("12.5 %", -7.5)])
def test_joints_keep_a_share_of_their_range(share: str, margin: float) -> None:
    trace = replace(world(3), joint_clearances={"arm": np.array([0.3, 0.05, 0.4])})
    found = judged("keeps-joints-from-limits", trace, agent="arm", share=share)
    assert (found.robustness, found.unit) == (pytest.approx(margin), "%")
    assert found.outcome is (Outcome.HOLDS if margin >= 0 else Outcome.VIOLATED)


def test_joints_without_a_record_are_unknown() -> None:
    assert judged("keeps-joints-from-limits", world(2), agent="arm", share="0 %").outcome is Outcome.UNKNOWN
