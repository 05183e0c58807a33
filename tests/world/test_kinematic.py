"""The kinematic world: things move as commanded, and clauses about contacts are unknown."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import After, During
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Cause, Outcome, Verdict
from robbdd_tools.monitor.without_physics import KINEMATIC, NO_CONTACTS
from robbdd_tools.protocol.specs import NO_PHYSICS, ConfigSpec, SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.kinematic import KinematicSimulation
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.simulator import Simulator
from world.worlds import BALL, BENCH_WS, BIN, BIN_WS, CUBE, PANDA, SCENE, pick_place, scenario

pytestmark = pytest.mark.physics
DRAWER, DRAWER_WS = "env:drawer", "env:drawer_ws"


def executed(*calls: Call, scene: SceneSpec = SCENE, seed: int = 1) -> tuple[Execution, Trace]:
    run = Execution(replace(scenario(scene, seed), world=KINEMATIC), calls)
    trace = run.advance_until(lambda _: False)
    return run, replace(run.complete(trace), settings=run.course.settings)


def judged(run: Execution, trace: Trace, predicate: str, **words: str) -> Verdict:
    time = During("t:pick-end", "t:end") if predicate.startswith("does") else After("t:place-end")
    return judge(load_catalog().predicates[predicate], words, time, trace, run.regions)


@pytest.mark.parametrize("agent", [PANDA, "env:ur10"])
@pytest.mark.parametrize("thing", [CUBE, BALL])
def test_an_object_moves_with_the_gripper_and_stays_where_it_is_released(agent: str, thing: str) -> None:
    run, trace = executed(pick_place(thing, BIN_WS, agent), scene=replace(SCENE, agents=(agent,)))
    assert run.completed == 1
    assert [stamp.name for stamp in trace.events][1:-1] == [
        "t:pick-start",
        "t:pick-end",
        "t:place-start",
        "t:place-end",
    ]
    found = judged(run, trace, "located-at", object=thing, workspace=BIN_WS)
    assert found.outcome is Outcome.HOLDS
    low = trace.positions[-1, trace.column(thing), 2] - trace.positions[0, trace.column(BIN), 2]
    assert trace.positions[:, trace.column(thing), 2].max() > 0.25
    assert low < 0.0
    assert np.ptp(trace.positions[:, trace.column(BIN)], axis=0).max() == 0.0


@pytest.mark.parametrize(
    ("predicate", "words"),
    [
        ("held-by", {"object": CUBE, "agent": PANDA}),
        ("does-not-collide", {"agent": PANDA, "target": BIN_WS}),
        ("does-not-collide", {"agent": PANDA, "target": BENCH_WS}),
        ("does-not-drop", {"agent": PANDA, "object": CUBE}),
        ("is-at-rest", {"object": CUBE}),
        ("touches", {"one": CUBE, "other": BIN}),
        ("does-not-touch", {"one": CUBE, "other": BIN}),
        ("object-does-not-collide", {"one": CUBE, "other": BIN}),
    ],
)
def test_clauses_about_contacts_are_unknown(predicate: str, words: dict[str, str]) -> None:
    run, trace = executed(pick_place())
    found = judged(run, trace, predicate, **words)
    assert (found.outcome, found.cause, found.reason) == (Outcome.UNKNOWN, Cause.UNOBSERVED, NO_CONTACTS)


def test_a_drawer_follows_its_handle_and_takes_the_part_along() -> None:
    scene = SceneSpec(
        objects=(CUBE, DRAWER, "env:bench"),
        agents=(PANDA,),
        workspaces={BENCH_WS: ("env:bench",), DRAWER_WS: (DRAWER,)},
        contains={BENCH_WS: (DRAWER_WS,)},
    )
    run, trace = executed(
        Call("open", {"agent": PANDA, "object": DRAWER}),
        pick_place(CUBE, DRAWER_WS),
        Call("close", {"agent": PANDA, "object": DRAWER}),
        scene=scene,
    )
    assert run.completed == 3
    record = trace.openings[DRAWER]
    assert not isinstance(record, str)
    assert record.positions.max() > 0.9 * 0.16
    assert record.positions[-1] == pytest.approx(0.0, abs=1e-3)
    carrier, _ = run.regions[DRAWER_WS][0]
    placed = trace.last_at_or_before(trace.event_time("t:place-end") or 0.0)
    apart = trace.positions[:, trace.column(CUBE)] - trace.positions[:, trace.column(carrier)]
    assert apart[-1] == pytest.approx(apart[placed], abs=1e-6)


def test_the_same_seed_gives_the_same_bytes_and_a_state_can_be_restored() -> None:
    (run, trace), (_, again) = executed(pick_place()), executed(pick_place())
    assert trace.positions.tobytes() == again.positions.tobytes()
    first = run.state_at(0.0)
    run.simulation.restore(first)
    assert run.simulation.state.tobytes() == first.tobytes()
    assert run.simulation.pose(CUBE)[0] == pytest.approx(trace.positions[0, trace.column(CUBE)], abs=1e-9)


@pytest.mark.parametrize(
    ("scene", "call", "reason"),
    [
        (replace(SCENE, objects=(*SCENE.objects, "env:belt")), pick_place(), "a conveyor needs physics"),
        (replace(SCENE, config=(ConfigSpec(CUBE, "drop_height", "0.15 0.2"),)), pick_place(), "'drop_height' needs"),
        (SCENE, Call("push", {"agent": PANDA, "object": CUBE, "workspace": BIN_WS}), "'push' needs physics"),
    ],
)
def test_what_needs_physics_is_refused(scene: SceneSpec, call: Call, reason: str) -> None:
    with pytest.raises(SceneError, match=reason):
        executed(call, scene=scene)


def test_both_worlds_fit_the_door() -> None:
    world = build_world(SCENE, 1)
    worlds: tuple[Simulator, ...] = Simulation(world), KinematicSimulation(world)
    assert [one.has_physics for one in worlds] == [True, False]
    for one in worlds:
        one.settle()
        one.tick()
        assert one.time == 0.016


def test_results_say_that_there_is_no_physics() -> None:
    assert replace(scenario(), world=KINEMATIC).choices == (NO_PHYSICS,)
    assert scenario().choices == ()
