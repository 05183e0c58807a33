"""Gaps between surfaces, and distances from joint limits, are measured from recorded states."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Timing
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import After, During, TimeConstraint
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.clauses import Fluent
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.gaps import GapSampler
from robbdd_tools.world.joint_clearance import joint_clearances
from world.worlds import BIN, BIN_WS, CUBE, OTHER_BIN, OTHER_WS, PANDA, execution, pick_place

SHAPES = """<mujoco><worldbody>
  <body name="box"><geom type="box" size=".1 .2 .3"/></body>
  <body name="ball">
    <freejoint/><geom type="sphere" size=".05"/><geom type="sphere" size=".4" contype="0" conaffinity="0"/>
  </body>
  <body name="pair">
    <freejoint/><geom type="sphere" size=".02" pos="0 0 .5"/><geom type="capsule" size=".01 .1" pos="0 0 -.5"/>
  </body>
  <body name="ghost"><geom type="box" size="1 1 1" contype="0" conaffinity="0"/></body>
  <body name="box/lid"><geom type="sphere" size=".05" pos="0 0 2"/></body>
  <body name="ground"><geom type="plane" size="1 1 1"/></body>
</worldbody></mujoco>"""


def sampler(*states: list[float]) -> GapSampler:
    """Measure between the shapes, at poses of the ball and of the pair: positions, (m) without turns."""
    model = mujoco.MjModel.from_xml_string(SHAPES)
    full = np.array([[*state[:3], 1, 0, 0, 0, *state[3:], 1, 0, 0, 0] for state in states])
    objects = dict.fromkeys(("box", "box/lid", "ball", "pair", "ghost", "ground"))
    regions = {"both_ws": (("box", None), ("pair", None)), "ghost_ws": (("ghost", None),)}
    cast_ = SimpleNamespace(objects=objects, regions=regions)
    found = SimpleNamespace(
        model=model, robots={}, world=SimpleNamespace(cast=cast_), recorder=SimpleNamespace(states=full)
    )
    return GapSampler(cast(Any, found))


@pytest.mark.parametrize(
    ("place", "gap"),
    [
        ((0.25, 0.0, 0.0), 0.1),
        ((0.0, 0.0, 0.36), 0.01),
        ((0.13, 0.24, 0.3), 0.0),
        ((0.22, 0.36, 0.3), 0.15),
        ((0.14, 0.0, 0.0), -0.01),
        ((9.0, 0.0, 0.0), 8.85),
    ],
)
def test_the_gap_of_a_ball_and_a_box_is_exact(place: tuple[float, float, float], gap: float) -> None:
    gaps = sampler([*place, 5.0, 5.0, 5.0])
    gaps.sample("ball", "box", range(1))
    assert gaps.record(1)["ball", "box"] == pytest.approx([gap], abs=1e-6)


def test_an_undeclared_moving_part_is_a_surface_of_its_object() -> None:
    gaps = sampler([0, 0, 1.8, 5.0, 5.0, 5.0])
    gaps.sample("ball", "box", range(1))
    assert gaps.record(1)["ball", "box"] == pytest.approx([0.1], abs=1e-6)


def test_the_nearest_of_all_surfaces_counts_and_each_sample_is_measured_at_its_own_state() -> None:
    gaps = sampler([2.0, 0, 0, 2.0, 0, 0.8], [2.0, 0, 0, 2.0, 0, -0.8], [2.0, 0, 0, 2.0, 0, 0.3])
    gaps.sample("ball", "pair", range(1, 3))
    gaps.sample("pair", "ball", range(1))
    found = gaps.record(4)
    assert set(found) == {("ball", "pair")}
    assert found["ball", "pair"][:3] == pytest.approx(
        [0.3 - 0.1 - 0.01 - 0.05, 0.3 - 0.02 - 0.05, 0.2 - 0.1 - 0.06], abs=1e-6
    )
    assert np.isnan(found["ball", "pair"][3])


def test_a_workspace_means_its_carriers() -> None:
    gaps = sampler([0.25, 0, 0, 1.25, 0, 0.5])
    gaps.sample("both_ws", "ball", range(1))
    found = gaps.record(1)
    assert found["ball", "box"] == pytest.approx([0.1], abs=1e-6)
    assert found["ball", "pair"] == pytest.approx([0.99 - 0.05], abs=1e-6)


def test_elements_without_a_convex_surface_are_not_measured() -> None:
    gaps = sampler([0.25, 0, 0, 1, 0, 0])
    for other in ("ghost", "ghost_ws", "ground", "ball", "nobody"):
        gaps.sample("ball", other, range(1))
    assert gaps.record(1) == {}


def fluent(time: TimeConstraint, one: str = PANDA, other: str = BIN_WS) -> Fluent:
    predicate = load_catalog().predicates["keeps-distance"]
    return Fluent(predicate, {"one": one, "distance": "1 cm", "other": other}, time)


@pytest.mark.physics
def test_gaps_are_measured_in_the_windows_of_their_clauses() -> None:
    run = execution([pick_place(CUBE, BIN_WS)], timing=Timing(tail=0.5))
    trace = run.advance_until(lambda _: False)
    assert run.complete(trace).gaps == {}
    clause = fluent(During("t:place-start", "t:place-end"))
    gaps = run.measured(clause, trace).gaps[BIN, PANDA]
    start, end = trace.event_time("t:place-start"), trace.event_time("t:place-end")
    assert start is not None
    assert end is not None
    window = (trace.times >= start) & (trace.times <= end)
    assert np.array_equal(np.isfinite(gaps), window)
    # The gripper goes into the bin but does not touch it.
    assert 0.0 < gaps[window].min() < 0.05
    apart = run.measured(fluent(After("t:place-end", 0.25, which="every"), CUBE, OTHER_BIN), trace)
    assert np.isfinite(apart.gaps[OTHER_BIN, CUBE]).sum() in (15, 16, 17)
    assert np.nanmin(apart.gaps[OTHER_BIN, CUBE]) > 0.1


@pytest.mark.physics
def test_the_arm_keeps_its_distance_to_one_bin_but_not_to_the_one_that_it_reaches_into() -> None:
    run = execution([pick_place(CUBE, BIN_WS)])
    trace = run.advance_until(lambda _: False)

    def verdict(other: str) -> Verdict:
        clause = fluent(During("t:pick-start", "t:place-end"), PANDA, other)
        arguments = {"one": PANDA, "distance": "5 cm", "other": other}
        return judge(clause.predicate, arguments, clause.time, run.measured(clause, trace), run.regions)

    far, near = verdict(OTHER_WS), verdict(BIN_WS)
    assert (far.outcome, near.outcome) == (Outcome.HOLDS, Outcome.VIOLATED)
    assert near.robustness is not None
    assert -5.0 < near.robustness < 0.0
    # Nothing was measured before the window: a wider one is unknown.
    wider = During("t:start", "t:place-end")
    measured = run.complete(trace)
    arguments = {"one": PANDA, "distance": "5 cm", "other": OTHER_WS}
    assert judge(fluent(wider).predicate, arguments, wider, measured, run.regions).outcome is Outcome.UNKNOWN


@pytest.mark.physics
def test_joints_are_compared_with_their_published_limits() -> None:
    run = execution()
    trace = run.complete(run.advance_until(lambda found: found.end > 0.05))
    robot = run.simulation.robots[PANDA]
    assert len(trace.joint_clearances[PANDA]) == len(trace.times)
    # Franka Emika: joint 4 from -3.0718 rad to -0.0698 rad.
    state = run.simulation.recorder.states[:1].copy()
    middle = robot.limits.mean(axis=1)
    state[0, robot.limited] = middle
    assert joint_clearances([robot], state)[PANDA] == pytest.approx([0.5])
    state[0, robot.joints[3]] = -0.0698 - 0.3
    assert joint_clearances([robot], state)[PANDA] == pytest.approx([0.3 / 3.002], rel=1e-3)
    state[0, robot.joints[3]] = -3.0718 - 0.03
    assert joint_clearances([robot], state)[PANDA] == pytest.approx([-0.03 / 3.002], rel=1e-2)
