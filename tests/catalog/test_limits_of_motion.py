"""Predicates that limit speed, distance and tilt."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from catalog.judged_predicates import REGIONS, judged, limited, world
from monitor.traces import heights, still
from robbdd_tools.base.quantity_units import QuantityError
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import Before
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.monitor.verdict import Outcome


def test_an_agent_moves_safely_as_long_as_its_tool_is_slow() -> None:
    slow = world(3, arm=[[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.03, 0.0, 0.0]])
    assert judged("moves-safely", slow, agent="arm").robustness == pytest.approx(0.25 - 0.2)
    fast = world(4, arm=heights([0.0, 0.0, 0.03, 0.03]))
    found = judged("moves-safely", fast, agent="arm")
    assert (found.robustness, found.unit) == (pytest.approx(0.25 - 0.3), "m/s")
    assert found.at == pytest.approx(0.2)
    assert judged("moves-safely", limited(fast, "arm", "max_speed", "0.5"), agent="arm").outcome is Outcome.HOLDS


def test_speed_at_the_beginning_of_a_window_is_that_since_the_sample_before_it() -> None:
    trace = world(4, arm=heights([0.0, 0.0, 0.03, 0.03]))
    predicate = load_catalog().predicates["moves-safely"]
    for time, robustness in ((0.1, 0.25), (0.2, -0.05)):
        events = (EventStamp("e", time),)
        found = judge(predicate, {"agent": "arm"}, Before("e"), replace(trace, events=events), REGIONS)
        assert found.robustness == pytest.approx(robustness)
    assert judged("moves-safely", world(1, arm=still(1)), agent="arm").outcome is Outcome.UNKNOWN


@pytest.mark.parametrize(("limit", "robustness", "unit"), [("0.5 m/s", 0.3, "m/s"), ("0.1 m/s", -0.1, "m/s")])
def test_moves_slower_than_a_limit(limit: str, robustness: float, unit: str) -> None:
    found = judged("moves-slower-than", world(arm=[[0.0, 0.0, 0.0], [0.02, 0.0, 0.0]]), agent="arm", limit=limit)
    assert found.robustness == pytest.approx(robustness)
    assert found.unit == unit


@pytest.mark.parametrize(
    ("distance", "nearer", "unit"), [("50 cm", 20.0, "cm"), ("0.2 m", -0.1, "m"), ("310 mm", 10.0, "mm")]
)
def test_distances_are_compared_in_the_unit_of_the_clause(distance: str, nearer: float, unit: str) -> None:
    trace = world(ball=still(2, (0.0, 0.3, 0.0)))
    for other in ("tray", "tray_ws"):
        one = judged("is-nearer-than", trace, one="ball", distance=distance, other=other)
        assert (one.robustness, one.unit) == (pytest.approx(nearer), unit)
        far = judged("is-farther-than", trace, one="ball", distance=distance, other=other)
        assert (far.robustness, far.unit) == (pytest.approx(-nearer), unit)


def test_of_a_workspace_the_nearest_carrier_counts() -> None:
    trace = world(ball=still(2, (0.9, 0.0, 0.0)))
    found = judged("is-nearer-than", trace, one="ball", distance="0.3 m", other="both_ws")
    assert found.robustness == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("limit", "robustness", "unit"), [("45 deg", 15.0, "deg"), ("0.5 rad", 0.5 - np.pi / 6, "rad")]
)
def test_tilt_is_the_angle_of_the_upward_axis(limit: str, robustness: float, unit: str) -> None:
    upright = world(ball=still(2, (0.0, 0.0, 0.1)))
    orientations = upright.orientations.copy()
    # 30° about x, after a turn about z, which does not tilt.
    about_x, about_z = (np.cos(np.pi / 12), np.sin(np.pi / 12)), (np.cos(0.4), np.sin(0.4))
    tilted = (about_x[0] * about_z[0], about_x[1] * about_z[0], -about_x[1] * about_z[1], about_x[0] * about_z[1])
    orientations[:, upright.column("ball")] = tilted
    found = judged("is-tilted-less-than", replace(upright, orientations=orientations), object="ball", limit=limit)
    assert (found.robustness, found.unit) == (pytest.approx(robustness), unit)
    untilted = judged("is-tilted-less-than", upright, object="ball", limit="10 deg")
    assert untilted.robustness == pytest.approx(10.0)


@pytest.mark.parametrize("limit", ["0.25", "0.25 m", "fast", "0.25 mph"])
def test_a_quantity_that_does_not_fit_is_no_evidence(limit: str) -> None:
    with pytest.raises(QuantityError):
        judged("moves-slower-than", world(arm=still(2)), agent="arm", limit=limit)
