"""Evaluators that need more than poses, in physics: each in a run in which it holds and in one in which it must not."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.trace import EventStamp
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.specs import ConfigSpec, SceneSpec
from world.worlds import BALL, BENCH_WS, BIN_WS, CUBE, OTHER_WS, PANDA, SCENE, execution, pick_place

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
    run.simulation.model.pair_friction[:] = 1e-4
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
    clause = read_clause(f'"{PANDA}" can reach "{CUBE}" for 0.2 seconds before event "t:pick-start"')
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


def configured(*wanted: tuple[str, str, str]) -> SceneSpec:
    return replace(SCENE, config=tuple(ConfigSpec(*one) for one in wanted))


@pytest.mark.parametrize(("limit", "outcome"), [("1.0", Outcome.HOLDS), ("0.2", Outcome.VIOLATED)])
def test_an_arm_moves_safely_when_it_is_slower_than_it_may_be(limit: str, outcome: Outcome) -> None:
    run = execution([pick_place()], configured((PANDA, "max_speed", limit)))
    found = judged(run, f'"{PANDA}" moves safely {WHOLE}')
    assert (found.outcome, found.unit) == (outcome, "m/s")


def test_by_default_an_arm_moves_safely_at_the_reduced_speed() -> None:
    sentence = f'"{PANDA}" moves safely {WHOLE}'
    slow = execution([pick_place()], configured((PANDA, "ee_speed", "0.15")))
    assert judged(slow, sentence).outcome is Outcome.HOLDS
    fast = execution([pick_place()], configured((PANDA, "ee_speed", "0.5")))
    assert judged(fast, sentence).outcome is Outcome.VIOLATED


COLLIDE = f'"{PANDA}" does not collide "{BIN_WS}" {WHOLE}'


def test_a_bin_that_nothing_presses_against_is_not_collided_with() -> None:
    found = judged(execution([pick_place(workspace=OTHER_WS)], configured((BIN_WS, "force_limit", "5"))), COLLIDE)
    assert (found.outcome, found.robustness, found.unit) == (Outcome.HOLDS, 5.0, "N")


@pytest.mark.parametrize(("limit", "outcome"), [("200", Outcome.HOLDS), ("5", Outcome.VIOLATED)])
def test_what_fingers_close_on_feels_their_force(limit: str, outcome: Outcome) -> None:
    run = execution([pick_place()], configured((CUBE, "force_limit", limit)))
    found = judged(run, f'"{PANDA}" does not collide "{CUBE}" {WHOLE}')
    assert found.outcome is outcome
    assert found.robustness is not None
    assert float(limit) - found.robustness > 2 * 14.0


def test_watching_forces_changes_nothing_that_happens() -> None:
    plain, watched = (
        execution([pick_place()], scene).advance_until(lambda _: False)
        for scene in (SCENE, configured((BIN_WS, "force_limit", "5")))
    )
    assert plain.positions.tobytes() == watched.positions.tobytes()


@pytest.mark.parametrize(("share", "outcome"), [(0.0, Outcome.HOLDS), (0.9, Outcome.VIOLATED)])
def test_a_ball_is_wholly_in_a_bin_unless_it_reaches_into_its_wall(share: float, outcome: Outcome) -> None:
    run = execution([], configured((BALL, "whole_object", "yes")))
    ((carrier, region),) = run.regions[BIN_WS]
    x, y, z = (float(value) for value in run.simulation.data.body(carrier).xpos)
    move(run, BALL, x + share * region.half[0], y, z + region.center[2])
    run.simulation.restart()
    clause = read_clause(f'"{BALL}" is located at "{BIN_WS}" before event "t:start"')
    trace = replace(run.trace, events=(EventStamp("t:start", 0.0),))
    assert decide(clause, run.measured(clause, trace), run.regions, {"t:start"}).outcome is outcome
    by_position = replace(run.measured(clause, trace), settings={})
    assert decide(clause, by_position, run.regions, {"t:start"}).outcome is Outcome.HOLDS


@pytest.mark.parametrize(("goals", "outcome"), [((BIN_WS, OTHER_WS), Outcome.HOLDS), ((OTHER_WS,), Outcome.VIOLATED)])
def test_what_was_brought_into_a_bin_is_sorted_into_bins_that_are_told(
    goals: tuple[str, ...], outcome: Outcome
) -> None:
    run = execution([pick_place()])
    found = judged(run, f'"{[CUBE]}" are sorted into "{list(goals)}" after event "t:place-end"')
    assert found.outcome is outcome


@pytest.mark.parametrize(
    ("goals", "outcome"), [((BIN_WS, OTHER_WS), Outcome.HOLDS), ((BIN_WS, BENCH_WS), Outcome.VIOLATED)]
)
def test_what_lies_in_a_bin_on_a_bench_is_in_two_workspaces(goals: tuple[str, ...], outcome: Outcome) -> None:
    run = execution([pick_place()], configured((CUBE, "exactly_one", "yes")))
    found = judged(run, f'"{[CUBE]}" are sorted into "{list(goals)}" after event "t:place-end"')
    assert found.outcome is outcome
