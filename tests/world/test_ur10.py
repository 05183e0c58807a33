"""The UR10: a cup that holds only by suction, and what hangs under it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.robots.ur10 import UR10
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.specs import ConfigSpec
from robbdd_tools.world.arm_kinematics import arm_of
from world.worlds import BALL, BIN, BIN_WS, CUBE, OTHER_BIN, OTHER_WS, SCENE, execution, pick_place

if TYPE_CHECKING:
    pass

ARM = arm_of(UR10)
AGENT = "env:ur10"
BENCH = replace(SCENE, agents=(AGENT,))
LOW, TALL = (
    replace(BENCH, config=tuple(ConfigSpec(name, "height_scale", scale) for name in (BIN, OTHER_BIN)))
    for scale in ("0.8", "1.1")
)


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
@pytest.mark.parametrize("agent", [AGENT, "env:panda"])
@pytest.mark.parametrize("thing", [BALL, "env:bottle"])
def test_with_room_below_what_it_carries_an_arm_fills_a_tall_bin(agent: str, thing: str) -> None:
    room = ConfigSpec(agent, "carry_clearance", "0.02")
    scene = replace(TALL, objects=(*SCENE.objects, "env:bottle"), agents=(agent,), config=(*TALL.config, room))
    run = execution([pick_place(thing, BIN_WS, agent)], scene, seed=2)
    trace = to_the_end(run)
    assert not trace.remark
    for clause in (
        f'"{agent}" does not collide "{BIN_WS}" from "t:pick-start" until "t:end"',
        f'"{agent}" does not drop "{thing}" from "t:pick-start" until "t:end"',
        f'"{thing}" is located at "{BIN_WS}" after event "t:place-end"',
    ):
        assert judged(run, clause).outcome is Outcome.HOLDS, clause


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


@pytest.mark.physics
@pytest.mark.parametrize(("mass", "is_lifted"), [("1.0", True), ("2.5", True), ("3.5", True), ("4.2", False)])
def test_the_cup_lifts_what_its_vacuum_bears(mass: str, is_lifted: bool) -> None:
    """The vacuum pulls with 42 N; a box of 3.5 kg weighs 34.3 N, one of 4.2 kg 41.2 N, and lifting accelerates it."""
    box = "env:box1"
    config = (ConfigSpec(box, "mass", mass), ConfigSpec(AGENT, "ee_speed", "0.1"))
    scene = replace(SCENE, objects=(box, "env:bench"), agents=(AGENT,), workspaces={}, contains={}, config=config)
    for seed in range(1, 4):
        run = execution([Call("pick", {"agent": AGENT, "object": box})], scene, seed)
        assert run.run_behaviour(0) is is_lifted, run.trace.remark
