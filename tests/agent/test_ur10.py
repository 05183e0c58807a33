"""The UR10: its kinematics against the published parameters, its limits, and a cup that holds only by suction."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agent.worlds import BALL, BIN, BIN_WS, CUBE, OTHER_BIN, OTHER_WS, SCENE, execution, pick_place
from robbdd_tools.agent.clauses import decide
from robbdd_tools.agent.execution import Call, Execution
from robbdd_tools.agent.kinematics import arm_of
from robbdd_tools.agent.motion import ToolPose, frame_of
from robbdd_tools.agent.sentences import read_clause
from robbdd_tools.catalog.robots.ur10 import UR10
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.run.protocol import ConfigSpec

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

ARM = arm_of(UR10)
AGENT = "env:ur10"
BENCH = replace(SCENE, agents=(AGENT,))
LOW, TALL = (
    replace(BENCH, config=tuple(ConfigSpec(name, "height_scale", scale) for name in (BIN, OTHER_BIN)))
    for scale in ("0.8", "1.1")
)
DH = (
    (0.0, 0.1273, pi / 2),
    (-0.612, 0.0, 0.0),
    (-0.5723, 0.0, 0.0),
    (0.0, 0.163941, pi / 2),
    (0.0, 0.1157, -pi / 2),
    (0.0, 0.0922, 0.0),
)
"""a (m), d (m), alpha (rad) of each joint."""
TUBE = 0.16
"""From the flange to the lip of the cup, m."""
HALF_TURN = np.diag([-1.0, -1.0, 1.0, 1.0])
poses = st.builds(
    ToolPose, st.floats(0.25, 0.9), st.floats(-2.4, 2.4), st.floats(-0.1, 0.3), st.floats(-pi / 2, pi / 2)
)


def link(a: float, d: float, alpha: float, theta: float) -> FloatArray:
    ca, sa, ct, st_ = cos(alpha), sin(alpha), cos(theta), sin(theta)
    rows = [[ct, -st_ * ca, st_ * sa, a * ct], [st_, ct * ca, -ct * sa, a * st_], [0, sa, ca, d], [0, 0, 0, 1]]
    return np.array(rows, dtype=np.float64)


def product(joints: FloatArray) -> FloatArray:
    """Cup after the product of the joints' transformations, the base turned by half a turn."""
    frame = HALF_TURN
    for (a, d, alpha), theta in zip(DH, joints, strict=True):
        frame = frame @ link(a, d, alpha, float(theta))
    return frame @ link(0.0, TUBE, 0.0, 0.0)


@given(st.lists(st.floats(0, 1), min_size=6, max_size=6))
@settings(max_examples=200, deadline=None)
def test_forward_kinematics_is_the_product_of_the_published_parameters(shares: list[float]) -> None:
    joints = ARM.lower + np.array(shares) * (ARM.upper - ARM.lower)
    position, rotation = ARM.forward(joints)
    expected = product(joints)
    assert np.abs(position - expected[:3, 3]).max() < 1e-6
    assert np.abs(rotation - expected[:3, :3]).max() < 1e-6


@given(poses)
@settings(max_examples=100, deadline=None)
def test_inverse_kinematics_puts_the_cup_there_within_the_limits(pose: ToolPose) -> None:
    position, rotation = frame_of(pose)
    joints = ARM.solve(ARM.towards(position), position, rotation)
    reached, turned = ARM.forward(joints)
    assert np.abs(reached - position).max() < 1e-4
    assert np.abs(turned - rotation).max() < 1e-3
    assert (joints >= ARM.lower).all()
    assert (joints <= ARM.upper).all()


def test_at_home_the_cup_points_down_straight_ahead() -> None:
    position, rotation = ARM.forward(ARM.home)
    assert position == pytest.approx([0.4, 0.0, 0.45], abs=1e-4)
    assert rotation == pytest.approx(np.diag([1.0, -1.0, -1.0]), abs=1e-4)


def to_the_end(run: Execution) -> Trace:
    return run.advance_until(lambda _: False)


def judged(run: Execution, sentence: str) -> Verdict:
    return decide(read_clause(sentence), run.trace, run.regions, {stamp.name for stamp in run.trace.events})


@pytest.mark.physics
@pytest.mark.parametrize("thing", [CUBE, BALL])
@pytest.mark.parametrize(("seed", "goal"), [(1, BIN_WS), (2, OTHER_WS)])
def test_the_ur10_brings_a_thing_into_the_bin(thing: str, seed: int, goal: str) -> None:
    run = execution([pick_place(thing, goal, AGENT)], LOW, seed)
    trace = to_the_end(run)
    assert not trace.remark
    held = judged(run, f'"{thing}" is held by "{AGENT}" from "t:pick-end" until "t:place-start"')
    assert held.outcome is Outcome.HOLDS
    assert judged(run, f'"{thing}" is located at "{goal}" after event "t:place-end"').outcome is Outcome.HOLDS
    assert judged(run, f'"{thing}" is held by "{AGENT}" after event "t:place-end"').outcome is Outcome.VIOLATED
    assert judged(run, f'"{AGENT}" does not drop "{thing}" from "t:pick-start" until "t:end"').outcome is Outcome.HOLDS


@pytest.mark.physics
def test_velocity_and_torque_stay_within_the_published_limits() -> None:
    run = execution([pick_place(BALL, OTHER_WS, AGENT)], LOW)
    simulation = run.simulation
    robot = simulation.robots[AGENT]
    speeds: list[FloatArray] = []
    torques: list[FloatArray] = []

    def look() -> None:
        speeds.append(np.abs(simulation.data.qvel[robot.speeds]))
        torques.append(np.abs(simulation.data.qfrc_actuator[robot.speeds]))

    simulation.watchers.append(look)
    to_the_end(run)
    assert run.completed == 1
    assert (np.max(speeds, axis=0) <= UR10.velocity_limits).all()
    assert (np.max(torques, axis=0) <= UR10.torque_limits).all()
    assert np.max(speeds) > 0.5


@pytest.mark.physics
def test_what_hangs_under_the_cup_hits_a_bin_that_is_too_tall() -> None:
    """The ball's lowest point travels at 0.24 m; the rims are at 0.22 m and 0.265 m."""
    clause = f'"{AGENT}" does not collide "{BIN_WS}" from "t:pick-start" until "t:end"'
    margins: list[float] = []
    for scene in (LOW, TALL):
        run = execution([pick_place(BALL, BIN_WS, AGENT)], scene, seed=2)
        to_the_end(run)
        margins.append(judged(run, clause).robustness or 0.0)
    assert margins[1] < 0.0 < margins[0]


@pytest.mark.physics
def test_a_cup_whose_lip_is_bent_off_lets_go() -> None:
    """The lip can take 42 N times 12 mm, which is 0.5 N m."""
    run = execution([Call("pick", {"agent": AGENT, "object": CUBE})], BENCH)
    run.run_behaviour(0)
    simulation = run.simulation
    body = simulation.model.body(CUBE)
    for torque, lost in ((0.2, False), (1.0, True)):
        ticks = 0
        while simulation.holds(AGENT, CUBE) and ticks < 30:
            simulation.data.xfrc_applied[body.id, 3] = torque
            simulation.tick()
            ticks += 1
        assert (ticks < 30) is lost
    simulation.data.xfrc_applied[body.id] = 0.0
    for _ in range(60):
        simulation.tick()
    assert simulation.data.body(CUBE).xpos[2] < 0.2


@pytest.mark.physics
def test_a_cup_grips_only_what_it_touches_and_only_by_suction() -> None:
    run = execution(scene=BENCH)
    simulation = run.simulation
    robot = simulation.robots[AGENT]
    assert simulation.model.neq == 0
    run.advance_until(lambda trace: trace.event_time("t:start") is not None)
    simulation.command(robot, ARM.home, UR10.gripper_closed)
    address = simulation.model.jnt_qposadr[simulation.model.body(BALL).jntadr[0]]
    tip = simulation.data.site_xpos[robot.tool].copy()
    simulation.data.qpos[address : address + 3] = tip - [0.0, 0.0, 0.031]
    simulation.data.qvel[:] = 0.0
    simulation.tick()
    assert not simulation.holds(AGENT, BALL)
    for _ in range(20):
        simulation.tick()
    assert simulation.data.body(BALL).xpos[2] < tip[2] - 0.1


@pytest.mark.physics
@pytest.mark.parametrize(("pull", "lost"), [(35.0, False), (50.0, True)])
def test_a_cup_lets_go_at_its_breakaway_force(pull: float, lost: bool) -> None:
    """The vacuum pulls with 42 N; the cube itself weighs 0.3 N."""
    run = execution([Call("pick", {"agent": AGENT, "object": CUBE})], BENCH)
    run.run_behaviour(0)
    simulation = run.simulation
    assert simulation.holds(AGENT, CUBE)
    simulation.data.xfrc_applied[simulation.model.body(CUBE).id, 2] = -pull
    for _ in range(20):
        simulation.tick()
    assert simulation.holds(AGENT, CUBE) is not lost
