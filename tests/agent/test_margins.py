"""Evaluators that need more than poses, in physics: each in a run in which it holds and in one in which it must not."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from agent.worlds import BALL, BIN_WS, CUBE, PANDA, SCENE, execution, pick_place
from robbdd_tools.agent.clauses import decide
from robbdd_tools.agent.execution import Execution
from robbdd_tools.agent.sentences import read_clause
from robbdd_tools.monitor.verdict import Outcome, Verdict

pytestmark = pytest.mark.physics
WHOLE = 'from "t:pick-start" until "t:end"'
REACH = f'"{PANDA}" can reach "{{}}" before event "t:pick-start"'


def judged(run: Execution, sentence: str) -> Verdict:
    clause = read_clause(sentence)
    trace = run.advance_until(lambda _: False)
    return decide(clause, run.measured(clause, trace), run.regions, {stamp.name for stamp in trace.events})


def move(run: Execution, name: str, x: float, y: float, z: float) -> None:
    simulation = run.simulation
    address = simulation.model.jnt_qposadr[simulation.model.body(name).jntadr[0]]
    simulation.data.qpos[address : address + 3] = (x, y, z)


@pytest.mark.parametrize("thing", [CUBE, BALL])
def test_a_thing_that_is_carried_and_set_down_is_not_dropped(thing: str) -> None:
    found = judged(execution([pick_place(thing)]), f'"{PANDA}" does not drop "{thing}" {WHOLE}')
    assert found.outcome is Outcome.HOLDS
    assert found.robustness is not None
    assert 0.0 < found.robustness < 0.05


def test_a_thing_that_slips_out_on_the_way_is_dropped() -> None:
    run = execution([pick_place()])
    trace = run.advance_until(lambda trace: trace.event_time("t:place-start") is not None)
    lost = trace.end
    for pad in run.simulation.robots[PANDA].pads:
        run.simulation.model.geom_friction[pad] = (1e-4, 1e-5, 1e-5)
    found = judged(run, f'"{PANDA}" does not drop "{CUBE}" {WHOLE}')
    assert found.outcome is Outcome.VIOLATED
    assert found.robustness is not None
    assert found.robustness < -0.05
    assert found.at is not None
    assert lost < found.at < lost + 1.0


def test_what_lies_before_the_robot_is_reached_with_room_to_the_joint_limits() -> None:
    found = judged(execution([pick_place()]), REACH.format(CUBE))
    assert found.outcome is Outcome.HOLDS
    assert found.unit == "rad"
    assert found.robustness is not None
    assert 0.0 < found.robustness < 1.5


def test_what_lies_too_far_away_is_not_reached() -> None:
    run = execution([pick_place(BALL)])
    move(run, CUBE, 0.82, 0.5, 0.12)
    found = judged(run, REACH.format(CUBE))
    assert (found.outcome, found.robustness) == (Outcome.VIOLATED, -pi)


def test_what_lies_in_a_corner_where_no_hand_fits_is_not_reached() -> None:
    run = execution([pick_place(BALL)], replace(SCENE, places={CUBE: BIN_WS}))
    position = run.simulation.data.body(CUBE).xpos
    carrier = run.simulation.data.body("env:bin1").xpos
    move(run, CUBE, carrier[0] + 0.12, carrier[1] + 0.07, position[2])
    assert judged(run, REACH.format(CUBE)).outcome is Outcome.VIOLATED
    assert judged(run, REACH.format(BALL)).outcome is Outcome.HOLDS


def test_reach_is_measured_throughout_a_window_and_only_there() -> None:
    run = execution([pick_place()])
    clause = read_clause(f'"{PANDA}" can reach "{CUBE}" within 0.2 seconds before event "t:pick-start"')
    trace = run.measured(clause, run.advance_until(lambda _: False))
    margins = trace.reaches[PANDA, CUBE]
    start = trace.event_time("t:pick-start")
    assert start is not None
    inside = (trace.times >= start - 0.2 - 1e-9) & (trace.times <= start + 1e-9)
    assert np.isfinite(margins[inside]).all()
    assert np.isnan(margins[~inside]).all()


@pytest.mark.parametrize(("agent", "thing"), [("env:nobody", CUBE), (PANDA, "env:cube7")])
def test_what_the_scene_lacks_is_unknown(agent: str, thing: str) -> None:
    found = judged(execution(), f'"{agent}" can reach "{thing}" before event "t:end"')
    assert found.reason == f"the trace has no record of '{agent} {thing}'"
