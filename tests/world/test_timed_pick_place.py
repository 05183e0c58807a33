"""The behaviour that the paper tested: phases of fixed times, a tool that never turns, and no check of anything."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from robbdd_tools.agent.behaviour_calls import Call
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.catalog.timetables import PANDA as PANDA_TIMES
from robbdd_tools.catalog.timetables import STEPS_PER_SECOND, UR10, timetable_of
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec, SceneSpec
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import SceneError
from world.worlds import BIN_WS, CUBE, PANDA, SCENE, pick_place, scenario

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

pytestmark = pytest.mark.physics


def timed(scene: SceneSpec = SCENE, seed: int = 1, call: Call | None = None, agent: str = PANDA) -> Execution:
    implementation = Implementation("x:own", "catalog", "timed-pick-place", None)
    spec = replace(scenario(scene, seed), execution=ExecutionSpec("x:run", "x:run", implementation))
    return Execution(spec, [call or pick_place(CUBE, BIN_WS, agent)])


def finished(run: Execution) -> Execution:
    run.advance_until(lambda trace: trace.event_time("t:end") is not None)
    return run


def seconds(first: int, last: int) -> float:
    """The duration of some phases of the Panda, each at least one control tick."""
    shares = PANDA_TIMES.shares[first : last + 1]
    return sum(max(1, round(1 / share / STEPS_PER_SECOND / TICK)) * TICK for share in shares)


def poses(run: Execution, name: str) -> tuple[FloatArray, FloatArray]:
    """Positions (n, 3) m and orientations (n, 4) of an element in all samples."""
    trace = run.trace
    column = trace.column(name)
    return trace.positions[:, column], trace.orientations[:, column]


def test_the_events_follow_the_timetable() -> None:
    trace = finished(timed()).trace
    start, end, cross, over = (
        trace.event_time(f"t:{name}") for name in ("pick-start", "pick-end", "place-start", "place-end")
    )
    assert None not in (start, end, over)
    assert end == cross
    assert (end or 0) - (start or 0) == pytest.approx(seconds(0, 4))
    assert (over or 0) - (cross or 0) == pytest.approx(seconds(5, 9))


def test_the_tool_points_down_and_never_turns() -> None:
    run = finished(timed())
    _, turns = poses(run, PANDA)
    since = run.trace.first_at_or_after(run.trace.event_time("t:pick-start") or 0.0) + 60
    apart = 1.0 - np.abs(turns[since:] @ turns[since])
    assert apart.max() < 1e-4


def test_it_releases_the_part_in_the_bin() -> None:
    run = finished(timed())
    bin_at, cube_at = (poses(run, name)[0][-1] for name in ("env:bin1", CUBE))
    assert np.abs(cube_at - bin_at)[:2].max() < 0.1
    assert run.trace.remark == ""


def moved_during(time: float) -> FloatArray:
    """Where the part is at last, (3,) m, if it is put 6 cm aside at a time (s) of the behaviour."""
    run = timed()
    simulation = run.simulation
    seat = int(simulation.model.jnt_qposadr[simulation.model.body(CUBE).jntadr[0]])

    def move() -> None:
        start = run.trace.event_time("t:pick-start")
        if start is not None and simulation.data.time >= start + time:
            simulation.data.qpos[seat + 1] += 0.06
            simulation.watchers.clear()

    simulation.watchers.append(move)
    return poses(finished(run), CUBE)[0][-1]


def test_the_place_of_the_part_is_read_until_the_tool_is_down() -> None:
    goal = poses(finished(timed()), "env:bin1")[0][-1]
    assert np.abs(moved_during(seconds(0, 0) * 0.5) - goal)[:2].max() < 0.1, "in the bin"
    assert np.abs(moved_during(seconds(0, 0) + 0.2) - goal)[:2].max() < 0.1, "in the bin"
    assert np.abs(moved_during(seconds(0, 1) + 0.01) - goal)[:2].max() > 0.15, "missed by the fingers"


def test_a_part_that_is_out_of_reach_is_no_failure_of_the_behaviour() -> None:
    far = replace(SCENE, config=(ConfigSpec(CUBE, "position_range", "0.8 0.84 -0.1 0.1"),))
    run = finished(timed(far))
    assert run.trace.remark == ""
    assert run.trace.event_time("t:place-end") is not None
    assert poses(run, CUBE)[0][-1] == pytest.approx(poses(run, CUBE)[0][0], abs=0.02)


def test_the_tool_follows_at_most_at_the_configured_speed() -> None:
    def fastest(scene: SceneSpec) -> float:
        positions, _ = poses(finished(timed(scene)), PANDA)
        return float(np.linalg.norm(np.diff(positions, axis=0), axis=1).max() / TICK)

    usual, faster = fastest(SCENE), fastest(replace(SCENE, config=(ConfigSpec(PANDA, "follow_speed", "0.6"),)))
    assert 0.8 * PANDA_TIMES.follow_speed < usual < 1.2 * PANDA_TIMES.follow_speed
    assert 0.8 * 0.6 < faster < 1.2 * 0.6


def test_arms_without_a_timetable_of_their_own_have_the_general_one() -> None:
    assert timetable_of("kinova-gen3").shares[5] == 0.001
    assert timetable_of("ur10") is UR10


def test_it_does_not_execute_picking_alone() -> None:
    with pytest.raises(SceneError, match="'timed-pick-place' of the catalog does not execute 'pick'"):
        timed(call=Call("pick", {"agent": PANDA, "object": CUBE}))
