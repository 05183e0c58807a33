"""Arms that are not needed are out of the way of the others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.agent.idle_arms import IdleArms
from world.worlds import BENCH_WS, BIN_WS, CUBE, OTHER_WS, PANDA, SCENE, scenario

UR10, KINOVA = "env:ur10", "env:kinova"
EVENTS = {
    "t:a-lifted": "t:a pick-end",
    "t:a-end": "t:a place-end",
    "t:b-start": "t:b pick-start",
    "t:b-end": "t:b place-end",
}


def bring(agent: str, workspace: str, part: str) -> Call:
    arguments = {"agent": agent, "object": CUBE, "workspace": workspace}
    return Call("pick-place", arguments, part, iteration=1)


def executed(agents: tuple[str, ...], *calls: Call, seed: int = 1) -> Execution:
    run = Execution(scenario(replace(SCENE, agents=agents), seed, events=EVENTS), calls)
    run.advance_until(lambda _: False)
    return run


def times(run: Execution) -> dict[str, float]:
    return {stamp.name: stamp.time for stamp in run.trace.events}


def moved(run: Execution, agent: str, start: float, end: float) -> float:
    """Return the distance (m) between the places of an agent's tool at two times."""
    column, trace = run.trace.column(agent), run.trace
    first, last = (trace.last_at_or_before(time + 1e-6) for time in (start, end))
    return float(np.linalg.norm(trace.positions[last, column] - trace.positions[first, column]))


@pytest.mark.physics
@pytest.mark.parametrize(
    ("giver", "taker", "meanwhile"), [(PANDA, KINOVA, False), (KINOVA, PANDA, True), (UR10, PANDA, False)]
)
def test_one_arm_takes_what_another_one_has_put_down(giver: str, taker: str, meanwhile: bool) -> None:
    taking = bring(taker, OTHER_WS, "t:b")
    if meanwhile:
        taking = replace(taking, is_meanwhile=True, awaited=("t:a-end",))
    run = executed((giver, taker), bring(giver, BENCH_WS, "t:a"), taking)
    assert run.completed == 2
    assert times(run)["t:a-end"] < times(run)["t:b-start"]
    assert not [one for one in run.complete(run.trace).contacts if {one.agent, one.other} == {giver, taker}]


@pytest.mark.physics
def test_an_arm_waits_beside_the_table_until_it_is_needed() -> None:
    run = executed((PANDA, UR10), bring(PANDA, BENCH_WS, "t:a"), bring(UR10, OTHER_WS, "t:b"))
    trace, found = run.trace, times(run)
    rows = [trace.last_at_or_before(found[name]) for name in ("t:a-lifted", "t:b-start")]
    for row, agent in zip(rows, (UR10, PANDA), strict=True):
        base = run.simulation.robots[agent].base.position
        ahead, aside, _ = np.abs(trace.positions[row, trace.column(agent)] - base)
        assert ahead < 0.02
        assert aside > 0.25


@pytest.mark.physics
def test_an_arm_stays_where_it_is_if_no_other_one_is_needed() -> None:
    run = executed((PANDA,), bring(PANDA, BIN_WS, "t:a"))
    end = times(run)["t:a-end"]
    assert moved(run, PANDA, end + 0.2, run.trace.end) < 1e-3


@pytest.mark.physics
def test_an_arm_that_holds_something_stays_where_it_is() -> None:
    pick = Call("pick", {"agent": PANDA, "object": CUBE}, "t:a", iteration=1)
    other = replace(bring(UR10, OTHER_WS, "t:b"), arguments={"agent": UR10, "object": "env:ball1", "workspace": BIN_WS})
    run = executed((PANDA, UR10), pick, other, seed=2)
    assert run.completed == 2
    assert moved(run, PANDA, times(run)["t:a-lifted"], run.trace.end) < 0.01


@pytest.mark.physics
def test_a_failed_grip_names_what_the_arm_has_touched_on_its_way(monkeypatch: pytest.MonkeyPatch) -> None:
    def stay(*_: object) -> None:
        pass

    monkeypatch.setattr(IdleArms, "park_all", stay)
    run = executed((PANDA, KINOVA), bring(PANDA, BENCH_WS, "t:a"), bring(KINOVA, OTHER_WS, "t:b"), seed=2)
    assert run.failure(1).startswith("gripper missed env:cube1 at ")
    assert run.failure(1).endswith("arm touches env:panda")


def test_idle_arms_move_once_in_a_tick_until_they_have_arrived() -> None:
    ticks: list[str] = []

    def park(agent: str) -> Iterator[None]:
        for _ in range(2):
            ticks.append(agent)
            yield

    arms = IdleArms(("a", "b", "c"), park)
    arms.park_all(("c",))
    assert ticks == []
    assert arms.move(1)
    assert arms.move(1)
    assert ticks == ["a", "b"]
    arms.begin(["b"])
    assert arms.move(2)
    assert not arms.move(3)
    assert ticks == ["a", "b", "a"]
    arms.end(["b"])
    arms.park_all()
    assert arms.are_moving
    arms.move(4)
    assert ticks[3:] == ["c", "b"]
