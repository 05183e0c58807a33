"""What makes the simulated world one to be trusted: rest, penetration, energy, order of declaration, determinism."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Timing
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.monitor.judge import judge
from robbdd_tools.monitor.time import After
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.world.engine import TICK, mujoco
from robbdd_tools.world.placement import TABLE_TOP
from world.worlds import BALL, BIN, BIN_WS, CUBE, OTHER_WS, PANDA, SCENE, execution, pick_place

pytestmark = pytest.mark.physics
MORE = ("env:cube2", "env:box1", "env:box2", "env:ball2", "env:cube3", "env:cylinder1", "env:bottle1")
FURNITURE = ("env:shelf", "env:tray")
CROWD = replace(SCENE, objects=(*SCENE.objects, *MORE, *FURNITURE), places={"env:cube3": BIN_WS, "env:ball2": OTHER_WS})
SEEDS = range(4)
DRIFT = 1e-4
"""m/s"""
PENETRATION = 1e-3
"""m"""


def to_the_end(run: Execution) -> Trace:
    return run.advance_until(lambda _: False)


def penetration(run: Execution) -> float:
    """Return the largest penetration (m); sleeping bodies have no contacts, so contacts are computed again."""
    model = run.simulation.model
    data = mujoco.MjData(model)
    data.qpos[:] = run.simulation.data.qpos
    mujoco.mj_forward(model, data)
    assert data.ncon > sum(thing.free for thing in run.simulation.world.cast.objects.values())
    return -float(data.contact.dist.min())


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("asleep", [True, False])
def test_things_at_rest_stay_at_rest(seed: int, asleep: bool) -> None:
    """The engine puts what rests to sleep; it has to rest without that, too."""
    run = execution(scene=CROWD, seed=seed, timing=Timing(lead=2.0))
    if not asleep:
        run.simulation.model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    trace = to_the_end(run)
    moved = np.linalg.norm(trace.positions[-1] - trace.positions[0], axis=1) / trace.end
    assert dict(zip(trace.names, moved.tolist(), strict=True)).keys() >= {*MORE, *FURNITURE}
    assert moved.max() < DRIFT, trace.names[int(moved.argmax())]


@pytest.mark.parametrize("seed", SEEDS)
def test_settled_things_are_not_inside_one_another(seed: int) -> None:
    assert penetration(execution(scene=CROWD, seed=seed)) < PENETRATION


def test_a_thing_that_was_set_down_is_at_rest_and_not_inside_anything() -> None:
    run = execution([pick_place(CUBE)])
    trace = to_the_end(run)
    late = trace.positions[trace.times > trace.end - 0.3]
    assert np.linalg.norm(late[-1] - late[0], axis=1).max() / 0.3 < DRIFT
    assert penetration(run) < PENETRATION


@pytest.mark.parametrize("thing", [BALL, CUBE, "env:cylinder1", "env:bottle1"])
def test_a_falling_thing_gains_no_energy(thing: str) -> None:
    """Kinetic plus potential energy of an object dropped from 0.25 m, at the end of every step."""
    simulation = execution(scene=replace(SCENE, objects=(thing, "env:bench"), workspaces={}, contains={})).simulation
    model, data = simulation.model, simulation.data
    body = model.body(thing)
    place, speed = int(model.jnt_qposadr[body.jntadr[0]]), int(body.dofadr[0])
    data.qpos[place : place + 7] = (0.45, 0.0, TABLE_TOP + 0.25, 0.9238795, 0.3826834, 0.0, 0.0)
    data.qvel[:] = 0.0
    mujoco.mj_forward(model, data)
    energies: list[float] = []
    for _ in range(round(1.5 / TICK) * 8):
        mujoco.mj_step(model, data)
        linear, angular = data.qvel[speed : speed + 3], data.qvel[speed + 3 : speed + 6]
        kinetic = 0.5 * float(body.mass[0] * linear @ linear + (body.inertia * angular) @ angular)
        energies.append(kinetic + 9.81 * float(body.mass[0] * data.qpos[place + 2]))
    drop = 9.81 * float(body.mass[0]) * 0.2
    assert max(energies) < energies[0] + 0.001 * drop
    assert energies[-1] < energies[0] - 0.9 * drop


@pytest.mark.parametrize("agent", ["env:panda", "env:kinova1", "env:ur10"])
@pytest.mark.parametrize("goal", ["env:shelf_lower_ws", "env:shelf_upper_ws", "env:tray_ws"])
def test_a_thing_is_placed_on_a_board_and_on_a_tray(agent: str, goal: str) -> None:
    """A workspace that names a board is the space above that board alone."""
    carriers = {f"env:shelf_{board}_ws": ("env:shelf",) for board in ("lower", "upper")} | {
        "env:tray_ws": ("env:tray",)
    }
    thing = "env:cylinder1"
    scene = replace(SCENE, objects=(thing, "env:bench", *FURNITURE), agents=(agent,), workspaces=carriers, contains={})
    run = execution([pick_place(thing, goal, agent)], scene, seed=2)
    trace = to_the_end(run)
    assert not trace.remark
    predicate, placed = load_catalog().predicates["located-at"], After("t:end")
    words = {"object": thing}
    inside = {ws: judge(predicate, {**words, "workspace": ws}, placed, trace, run.regions) for ws in carriers}
    assert [ws for ws, verdict in inside.items() if verdict.outcome is Outcome.HOLDS] == [goal]
    assert penetration(run) < PENETRATION


@pytest.mark.parametrize("agent", ["env:panda", "env:kinova1", "env:ur10"])
def test_a_tall_thing_is_lifted_above_a_high_board_before_it_travels(agent: str) -> None:
    """What hangs under the tool reaches down to the board when the tool travels at its usual height."""
    thing, goal = "env:bottle1", "env:shelf_upper_ws"
    objects, places = (thing, "env:bench", "env:shelf"), {goal: ("env:shelf",)}
    scene = replace(SCENE, objects=objects, agents=(agent,), workspaces=places, contains={})
    trace = to_the_end(execution([pick_place(thing, goal, agent)], scene, seed=1))
    assert not trace.remark
    shelf, bottle = (trace.positions[:, trace.column(name)] for name in ("env:shelf", thing))
    assert np.linalg.norm(shelf[-1] - shelf[0]) < 1e-3
    assert bottle[-1, 2] == pytest.approx(TABLE_TOP + 0.12 + 0.06, abs=1e-3)


def test_the_order_in_which_objects_are_declared_does_not_matter() -> None:
    straight = to_the_end(execution([pick_place(BALL)], CROWD))
    turned = to_the_end(execution([pick_place(BALL)], replace(CROWD, objects=CROWD.objects[::-1])))
    assert straight.names == turned.names
    assert straight.events == turned.events
    assert straight.positions.tobytes() == turned.positions.tobytes()


def test_the_same_seed_gives_the_same_bits_in_a_crowd() -> None:
    one, two = (to_the_end(execution([pick_place(CUBE)], CROWD, seed=3)) for _ in range(2))
    assert one.events == two.events
    assert one.positions.tobytes() == two.positions.tobytes()
    assert one.grips[PANDA].tobytes() == two.grips[PANDA].tobytes()


def test_building_a_world_warns_of_nothing() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert execution(scene=replace(SCENE, agents=(PANDA, "env:ur10"))).simulation.data.body(BIN).xpos[2] > 0.0
