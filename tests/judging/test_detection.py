"""The limits of a simulated sensor: what it does not see is not known."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from judging.judged_policies import NEAR, TRUTH, judged, moving, spec_of
from monitor.traces import still, trace_of
from robbdd_tools.judging.observation_streams import Stream
from robbdd_tools.monitor.policy import Observation, Provider, Rule, View
from robbdd_tools.monitor.time import Window
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.monitor.window_evidence import WindowEvidence
from world.worlds import CUBE

SENSOR = "env:camera"
WITHIN = View(SENSOR, 0.1, 1.0)
ANYWHERE = Rule("distance", form="less-than", bounds=(9.0,))


def seeing(view: View | None = WITHIN, misses: float = 0.0, rate: float = 10.0) -> Provider:
    return replace(TRUTH, rate=rate, view=view, misses=misses)


def watched(heights: list[float], across: float = 0.0) -> Trace:
    """A cube at some heights above an upright camera, sampled every 0.1 s."""
    path = [[across, 0.0, height] for height in heights]
    bodies = {CUBE: path, "env:bin": still(len(path), (0.0, 0.0, 0.5)), SENSOR: still(len(path))}
    return trace_of(bodies, {"t:a": 0.0, "t:b": (len(path) - 1) * 0.1})


def test_what_is_in_range_is_judged() -> None:
    found = judged(spec_of(ANYWHERE, seeing()), watched([0.2, 0.6, 0.95]))
    assert (found.outcome, found.reason) == (Outcome.HOLDS, "")


@pytest.mark.parametrize(
    ("view", "heights", "across", "reason"),
    [
        (WITHIN, [0.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2], 0.0, "it was farther than 1 m from env:camera"),
        (WITHIN, [0.2, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05], 0.0, "it was nearer than 0.1 m to env:camera"),
        (
            replace(WITHIN, angle=radians(60.0)),
            [0.6, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3],
            0.2,
            "it was outside the field of view of env:camera",
        ),
    ],
)
def test_what_was_not_seen_for_more_than_half_a_second_is_unknown(
    view: View, heights: list[float], across: float, reason: str
) -> None:
    found = judged(spec_of(ANYWHERE, seeing(view)), watched(heights, across))
    assert found.outcome is Outcome.UNKNOWN
    assert found.reason == f"{CUBE} was not observed between 0.00 s and 0.60 s: {reason}"
    shorter = judged(spec_of(ANYWHERE, seeing(view)), watched(heights[:-1], across))
    assert shorter.outcome is Outcome.HOLDS


def test_the_last_observation_counts_until_the_next() -> None:
    near = Rule("distance", form="less-than", bounds=(0.5,))
    # At 1.2 m, the cube is 0.7 m from the bin, which nobody saw.
    assert judged(spec_of(near, seeing()), watched([0.9, 1.2, 0.9])).outcome is Outcome.HOLDS
    assert judged(spec_of(near, seeing(replace(WITHIN, farthest=2.0))), watched([0.9, 1.2, 0.9])).outcome is (
        Outcome.VIOLATED
    )


def test_what_was_never_seen_is_unknown() -> None:
    found = judged(spec_of(ANYWHERE, seeing()), watched([1.2, 0.6]))
    assert found.reason == f"nothing was known of {CUBE} at 0.00 s: it was farther than 1 m from {SENSOR}"


def test_the_cone_of_a_field_of_view_turns_with_its_sensor() -> None:
    view, trace = replace(WITHIN, angle=radians(90.0)), watched([0.0] * 7, across=0.3)
    assert judged(spec_of(ANYWHERE, seeing(view), (CUBE, CUBE)), trace).outcome is Outcome.UNKNOWN
    along_x = np.array([0.5**0.5, 0.0, 0.5**0.5, 0.0])
    turned = trace.orientations.copy()
    turned[:, trace.names.index(SENSOR)] = along_x
    found = judged(spec_of(ANYWHERE, seeing(view), (CUBE, CUBE)), replace(trace, orientations=turned))
    assert found.outcome is Outcome.HOLDS


def test_a_variable_can_carry_the_sensor() -> None:
    spec = spec_of(ANYWHERE, seeing(replace(WITHIN, sensor="t:var-eye")))
    spec = replace(spec, values={**spec.values, "t:var-eye": SENSOR})
    assert judged(spec, watched([0.2, 0.6])).outcome is Outcome.HOLDS


def test_observations_are_missed_with_the_stated_probability() -> None:
    count = 2000
    equal = Rule("distance", form="equals", bounds=(0.0, 1000.0))
    trace = moving(list(np.arange(count) * 0.1))
    # Each sample has another distance, so the margin of the last one shows how old its observation is.
    assert judged(spec_of(equal, seeing(None, 1.0)), trace).reason.endswith("at 0.00 s: its sensor missed it")
    found = judged(spec_of(NEAR, seeing(None, 0.5)), moving([0.2] * count))
    assert "was not observed between" in found.reason
    assert found.reason.endswith("its sensor missed it")
    rare = judged(spec_of(NEAR, seeing(None, 0.05)), moving([0.2] * count))
    assert rare.outcome is Outcome.HOLDS


def test_a_missed_observation_does_not_change_what_was_seen_before() -> None:
    provider, trace = replace(seeing(None, 0.3), noise=0.01), moving([0.2] * 200)
    window = WindowEvidence(trace, Window(0, 199), {})
    seen = Stream(Observation("x:seen", provider, (CUBE,)), CUBE, window, 1)
    same = np.flatnonzero(np.diff(seen.stamps) == 0.0)
    assert same.size > 20
    assert (np.diff(seen.positions, axis=0)[same] == 0.0).all()
    assert np.ptp(seen.positions[:, 0]) > 0.01


def test_missed_observations_follow_from_the_seed() -> None:
    rule, trace = Rule("distance", form="less-than", bounds=(60.0,)), moving(list(np.arange(60) * 1.0))
    margins = {judged(spec_of(rule, seeing(None, 0.3), seed=seed), trace).robustness for seed in (1, 1, 2, 3, 4, 5, 6)}
    assert len(margins) > 1
    assert all(margin is None or margin in {1.0, 2.0, 3.0, 4.0, 5.0} for margin in margins)


def test_the_observations_of_a_log_have_no_further_limits() -> None:
    trace = replace(watched([1.2, 1.2]), log="drive")
    assert judged(spec_of(ANYWHERE, seeing()), trace).outcome is Outcome.HOLDS
