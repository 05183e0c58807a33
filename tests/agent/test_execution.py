"""Executions in the simulated world: the physics, the recording, the messages on failure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call, Timing
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import After, Before, During, TimeConstraint
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.specs import ConfigSpec
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.placement import TABLE_TOP
from world.worlds import (
    BALL,
    BENCH_WS,
    BIN,
    BIN_WS,
    CUBE,
    OTHER_WS,
    PANDA,
    SCENE,
    execution,
    pick_place,
)

pytestmark = pytest.mark.physics
ORDER = ["t:start", "t:pick-start", "t:pick-end", "t:place-start", "t:place-end", "t:end"]


def to_the_end(run: Execution) -> Trace:
    return run.advance_until(lambda _: False)


def judged(run: Execution, predicate: str, constraint: TimeConstraint, **words: str) -> Verdict:
    return judge(load_catalog().predicates[predicate], words, constraint, run.trace, run.regions)


def names(trace: Trace) -> list[str]:
    return [stamp.name for stamp in trace.events]


@pytest.mark.parametrize("thing", [CUBE, BALL])
@pytest.mark.parametrize(("seed", "goal", "other"), [(1, BIN_WS, OTHER_WS), (2, OTHER_WS, BIN_WS)])
def test_the_panda_brings_a_thing_into_the_bin_and_into_no_other(thing: str, seed: int, goal: str, other: str) -> None:
    run = execution([pick_place(thing, goal)], seed=seed)
    trace = to_the_end(run)
    assert names(trace) == ORDER
    assert trace.finished
    assert not trace.remark
    assert run.completed == 1
    placed, carried = After("t:place-end"), During("t:pick-start", "t:place-end")
    assert judged(run, "located-at", Before("t:pick-start"), object=thing, workspace=BENCH_WS).outcome is Outcome.HOLDS
    assert judged(run, "held-by", During("t:pick-end", "t:place-start"), object=thing, agent=PANDA).robustness == 1.0
    assert judged(run, "located-at", placed, object=thing, workspace=goal).outcome is Outcome.HOLDS
    assert judged(run, "located-at", placed, object=thing, workspace=other).outcome is Outcome.VIOLATED
    assert judged(run, "held-by", placed, object=thing, agent=PANDA).outcome is Outcome.VIOLATED
    assert judged(run, "does-not-collide", carried, agent=PANDA, target=goal).outcome is Outcome.HOLDS
    assert judged(run, "does-not-collide", carried, agent=PANDA, target=thing).outcome is Outcome.VIOLATED


def test_the_thing_travels_at_the_height_of_the_paper() -> None:
    trace = to_the_end(execution([pick_place(CUBE)]))
    start, end = (trace.event_time(name) for name in ("t:pick-end", "t:place-end"))
    assert start is not None
    assert end is not None
    height = trace.positions[trace.first_at_or_after(start), trace.column(CUBE), 2]
    assert height == pytest.approx(0.3, abs=0.005)


def test_the_same_seed_gives_the_same_bits() -> None:
    one, two = (to_the_end(execution([pick_place(BALL)], seed=7)) for _ in range(2))
    assert one.events == two.events
    for array in ("times", "positions", "orientations"):
        assert getattr(one, array).tobytes() == getattr(two, array).tobytes()
    assert one.grips[PANDA].tobytes() == two.grips[PANDA].tobytes()
    assert to_the_end(execution(seed=8)).positions[0].tobytes() != one.positions[0].tobytes()


def test_settled_things_stay_where_they_are() -> None:
    crowd = replace(SCENE, objects=(*SCENE.objects, "env:cube2", "env:box1", "env:ball2"))
    trace = to_the_end(execution(scene=crowd, timing=Timing(lead=3.0)))
    steps = np.linalg.norm(np.diff(trace.positions, axis=0), axis=2).sum(axis=0)
    travelled = dict(zip(trace.names, steps.tolist(), strict=True))
    assert trace.end > 3.9
    assert all(length < 1e-3 for length in travelled.values()), travelled


def test_a_servo_whose_target_nobody_moves_holds_still() -> None:
    """No controller commands the arm after the last behaviour."""
    trace = to_the_end(execution([pick_place(CUBE)]))
    tool = trace.positions[:, trace.column(PANDA)]
    assert np.linalg.norm(tool[-1] - tool[-20]) < 1e-4


def test_bins_are_loose_and_can_be_pushed() -> None:
    run = execution()
    data, model = run.simulation.data, run.simulation.model
    data.qvel[model.body(BIN).dofadr[0]] = 1.0
    trace = to_the_end(run)
    assert trace.positions[-1, trace.column(BIN), 0] - trace.positions[0, trace.column(BIN), 0] > 0.02


def test_samples_are_taken_at_every_control_tick_and_events_fall_on_them() -> None:
    trace = to_the_end(execution([Call("pick", {"agent": PANDA, "object": CUBE})]))
    assert np.diff(trace.times) == pytest.approx(TICK)
    assert all(np.abs(trace.times - stamp.time).min() == 0.0 for stamp in trace.events)
    assert trace.event_time("t:start") == 0.0
    assert np.linalg.norm(trace.orientations, axis=2) == pytest.approx(1.0)


def test_an_execution_advances_only_as_far_as_asked() -> None:
    run = execution([pick_place()])
    trace = run.advance_until(lambda trace: trace.event_time("t:pick-start") is not None)
    assert names(trace) == ["t:start", "t:pick-start"]
    assert not trace.finished
    size = len(trace.times)
    run.run_behaviour(0)
    assert len(trace.times) == size
    assert len(run.trace.times) > size


def test_only_friction_holds_the_thing() -> None:
    """Two pads that press with 15 N carry 0.30 N of weight from a friction of 0.01 on: 0.02 holds, 0.005 does not."""
    completed: dict[float, int] = {}
    for friction in (0.02, 0.005):
        run = execution([Call("pick", {"agent": PANDA, "object": CUBE})])
        simulation = run.simulation
        simulation.model.pair_friction[:] = friction, friction, 1e-5, 1e-5, 1e-5
        to_the_end(run)
        completed[friction] = run.completed
    assert completed == {0.02: 1, 0.005: 0}


def test_a_gripper_without_friction_loses_the_thing_and_says_so() -> None:
    run = execution([pick_place(CUBE)])
    simulation = run.simulation
    simulation.model.pair_friction[:] = 0.005, 0.005, 1e-5, 1e-5, 1e-5
    trace = to_the_end(run)
    assert run.completed == 0
    assert trace.remark.startswith("gripper lost env:cube1 at ")
    assert names(trace) == ["t:start", "t:pick-start", "t:end"]
    found = judged(run, "located-at", After("t:place-end"), object=CUBE, workspace=BIN_WS)
    assert found.outcome is Outcome.UNKNOWN
    assert found.reason == f"event t:place-end never occurred: {trace.remark}"


def test_a_thing_that_is_torn_away_by_what_it_hits_is_lost_with_this_reason() -> None:
    """Carried at the usual height, a bottle reaches below the rim of a bin, which is too heavy to be pushed away."""
    bottle = "env:bottle1"
    heavy = (ConfigSpec(BIN, "mass", "20"),)
    scene = replace(SCENE, objects=(bottle, BIN, "env:bin2", "env:bench"), agents=("env:ur10",), config=heavy)
    lost = [to_the_end(execution([pick_place(bottle, agent="env:ur10")], scene, seed)).remark for seed in range(1, 6)]
    assert [remark for remark in lost if remark.endswith(f" after {bottle} hit {BIN}")]


def test_a_thing_that_was_moved_away_is_missed() -> None:
    run = execution([pick_place(CUBE)])
    run.advance_until(lambda trace: trace.event_time("t:pick-start") is not None)
    simulation = run.simulation
    simulation.data.qvel[simulation.model.body(CUBE).dofadr[0] + 1] = 2.0
    trace = to_the_end(run)
    assert trace.remark.startswith("gripper missed env:cube1 at ")
    assert "t:pick-end" not in names(trace)


def test_picking_and_placing_can_be_two_behaviours() -> None:
    words = {"agent": PANDA, "object": BALL}
    run = execution([Call("pick", words), Call("place", {**words, "workspace": BENCH_WS})])
    assert names(to_the_end(run)) == ORDER
    assert run.completed == 2
    assert judged(run, "located-at", After("t:place-end"), object=BALL, workspace=BENCH_WS).outcome is Outcome.HOLDS


def test_what_is_only_placed_is_in_the_gripper_from_the_start() -> None:
    run = execution([Call("place", {"agent": PANDA, "object": CUBE, "workspace": BIN_WS})])
    trace = to_the_end(run)
    assert names(trace) == ["t:start", "t:place-start", "t:place-end", "t:end"]
    assert judged(run, "held-by", After("t:start"), object=CUBE, agent=PANDA).outcome is Outcome.HOLDS
    assert judged(run, "located-at", After("t:place-end"), object=CUBE, workspace=BIN_WS).outcome is Outcome.HOLDS


def test_things_are_taken_out_of_a_bin() -> None:
    run = execution([pick_place(CUBE, OTHER_WS)], replace(SCENE, places={CUBE: BIN_WS}), seed=3)
    to_the_end(run)
    assert judged(run, "located-at", Before("t:pick-start"), object=CUBE, workspace=BIN_WS).outcome is Outcome.HOLDS
    assert judged(run, "located-at", After("t:place-end"), object=CUBE, workspace=OTHER_WS).outcome is Outcome.HOLDS


def test_of_two_robots_the_named_one_acts() -> None:
    scene = replace(SCENE, agents=("env:panda1", "env:panda2"))
    run = execution([pick_place(agent="env:panda2")], scene)
    trace = to_the_end(run)
    assert run.completed == 1
    moved = np.ptp(trace.positions, axis=0).max(axis=1)
    assert moved[trace.column("env:panda1")] < 0.01 < 0.3 < moved[trace.column("env:panda2")]


def test_a_scene_without_a_table_runs() -> None:
    scene = replace(SCENE, objects=(CUBE, BIN), workspaces={BIN_WS: (BIN,)}, contains={})
    run = execution([pick_place()], scene)
    trace = to_the_end(run)
    assert run.completed == 1
    assert trace.positions[0, trace.column(CUBE), 2] > TABLE_TOP


def test_an_execution_that_takes_too_long_is_stopped() -> None:
    trace = to_the_end(execution([pick_place()], timing=Timing(timeout=1.0)))
    assert trace.finished
    assert trace.remark == "the execution was stopped after 1 s of simulated time"
    assert trace.end == pytest.approx(1.0, abs=TICK)


def test_a_window_before_an_event_that_is_longer_than_the_time_limit_is_named() -> None:
    trace = to_the_end(execution([pick_place()], timing=Timing(lead=3.0, timeout=1.0)))
    cause = "as a clause is about 3 s before an event: its 'timeout' must be longer than that"
    assert trace.remark == f"the execution was stopped after 1 s of simulated time, {cause}"
    assert "t:pick-start" not in names(trace)


@pytest.mark.parametrize(
    ("call", "remark"),
    [
        (pick_place(BIN, OTHER_WS), "env:bin1 is 0.190 m wide, the gripper opens 0.080 m"),
        (pick_place("env:cube9"), "there is no env:cube9 in the scene"),
        (
            Call("juggle", {"agent": PANDA, "object": CUBE}),
            "no agent of this installation can execute the behaviour 'juggle'",
        ),
    ],
)
def test_a_behaviour_that_cannot_be_executed_is_explained(call: Call, remark: str) -> None:
    trace = to_the_end(execution([call]))
    assert trace.remark == remark
    assert names(trace)[-1] == "t:end"
    assert "t:place-end" not in names(trace)


def test_a_place_that_no_object_carries_is_a_fault_of_the_model() -> None:
    with pytest.raises(SceneError, match="cannot place at 'env:void_ws': nothing in the scene carries that workspace"):
        execution([pick_place(workspace="env:void_ws")])


def test_an_agent_that_the_scene_lacks_is_explained() -> None:
    with pytest.raises(SceneError, match="the scene has no agent 'env:panda7'"):
        execution([pick_place(agent="env:panda7")])


def test_a_simulation_that_breaks_down_ends_with_a_remark() -> None:
    run = execution()
    run.simulation.data.qvel[run.simulation.model.body(CUBE).dofadr[0]] = np.nan
    trace = to_the_end(run)
    assert trace.finished
    cause = f"the free joint of '{CUBE}' moves without bounds"
    assert trace.remark.startswith(f"the simulation became unstable: {cause}, at ")


def test_an_execution_ends_when_its_simulated_time_is_up_and_says_so() -> None:
    run = execution([pick_place(CUBE)], timing=Timing(timeout=2.0))
    trace = to_the_end(run)
    assert trace.finished
    assert trace.end == pytest.approx(2.0, abs=TICK)
    assert "t:pick-start" in names(trace)
    assert trace.remark == "the execution was stopped after 2 s of simulated time"
    found = judged(run, "located-at", After("t:place-end"), object=CUBE, workspace=BIN_WS)
    assert found.outcome is Outcome.UNKNOWN
    assert found.reason == f"event t:place-end never occurred: {trace.remark}"
