"""Contact forces: every physics step counts, gripped parts belong to the agent, resting exerts no force."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.monitor.verdict import Outcome, Verdict
from robbdd_tools.protocol.specs import ConfigSpec
from robbdd_tools.traces.codec import Evidence, pack, unpack
from robbdd_tools.world.contact_forces import ContactForces
from robbdd_tools.world.engine import SUBSTEPS, TICK, TIMESTEP, mujoco
from robbdd_tools.world.simulation import Simulation
from world.worlds import BALL, BENCH_WS, BIN, CUBE, PANDA, SCENE, execution, pick_place

pytestmark = pytest.mark.physics
BENCH = "env:bench"
UNTOUCHED = f'"{PANDA}" does not collide "{BENCH_WS}" from "t:start" until "t:end"'
FALLING = f"""\
<mujoco>
  <option timestep="{TIMESTEP}" integrator="implicitfast" cone="elliptic"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="arm/fist" pos="0 0 {{height}}">
      <freejoint/>
      <geom type="sphere" size="0.05" mass="2" solref="0.005 1"/>
    </body>
    <body name="case"/>
    <body name="{{name}}" pos="0 0 {{part}}">
      <freejoint/>
      <geom type="box" size="0.05 0.05 0.05" mass="3"/>
    </body>
  </worldbody>
</mujoco>
"""


class Falling:
    """A fist of 2 kg that falls onto the floor, or onto a part of 3 kg."""

    def __init__(self, height: float, part: float = 5.0, name: str = "part") -> None:
        self.model: Any = mujoco.MjModel.from_xml_string(FALLING.format(height=height, part=part, name=name))
        self.data: Any = mujoco.MjData(self.model)
        self.forces = ContactForces(self.model, ["arm"], ["case", name], [])
        self.touching: list[bool] = []

    def run(self, samples: int, held: tuple[str, ...] = ()) -> None:
        for _ in range(samples):
            for _ in range(SUBSTEPS):
                mujoco.mj_step(self.model, self.data)
                self.forces.measure(self.data)
            self.touching.append(bool(self.data.ncon))
            self.forces.record(self.data, {"arm": list(held)})


def test_the_impulse_of_a_blow_is_the_change_of_momentum() -> None:
    falling = Falling(height=0.25)
    falling.run(40)
    before = np.sqrt(2 * 9.81 * 0.2)
    rest = 40 * SUBSTEPS * TIMESTEP - np.sqrt(2 * 0.2 / 9.81)
    total = float(falling.forces.impulses(40)["arm", "floor"].sum())
    assert total == pytest.approx(2 * before + 2 * 9.81 * rest, rel=0.03)


def test_a_blow_that_is_over_within_a_sample_is_not_missed() -> None:
    falling = Falling(height=0.25)
    falling.model.geom_solref[:] = (0.002, 0.2)
    falling.run(14)
    peaks = falling.forces.peaks(14)["arm", "floor"]
    hit = int(np.argmax(peaks))
    assert peaks[hit] > 500.0
    assert not falling.touching[hit]
    assert not falling.touching[hit - 1]


def test_what_an_agent_grips_strikes_for_it_and_its_weight_does_not_count() -> None:
    standing = Falling(height=3.0, part=0.05)
    standing.run(10)
    standing.forces.clear()
    standing.run(10, held=("part",))
    assert standing.forces.peaks(10).get(("arm", "floor"), np.zeros(10)).max() < 0.01
    dropped = Falling(height=3.0, part=0.15)
    dropped.run(20, held=("part",))
    peaks = dropped.forces.peaks(20)
    assert peaks["arm", "floor"].max() > 100.0
    assert ("arm", "part") not in peaks


@pytest.mark.parametrize(("press", "listed"), [(100.0, 0), (500.0, 1)])
def test_a_part_that_is_rammed_into_what_it_stands_on_is_listed(press: float, listed: int) -> None:
    standing = Falling(height=3.0, part=0.05)
    standing.run(10)
    standing.forces.clear()
    standing.run(2)
    standing.run(2, held=("part",))
    standing.data.xfrc_applied[standing.model.body("part").id, 2] = -press
    standing.run(10, held=("part",))
    assert standing.forces.peaks(14)["arm", "floor"].max() == pytest.approx(press, rel=0.2)
    found = standing.forces.contacts(np.arange(14.0))
    assert [(one.part, one.other) for one in found] == [("part", "floor")] * listed


def test_what_a_gripped_part_hits_is_told_apart_from_what_it_was_picked_up_from() -> None:
    standing = Falling(height=3.0, part=0.05)
    standing.run(10)
    standing.run(10, held=("part",))
    assert standing.forces.hit_since(0, "part") == ()
    dropped = Falling(height=30.0, part=0.15)
    dropped.run(40, held=("part",))
    assert dropped.forces.hit_since(0, "part") == ("floor",)
    assert dropped.forces.hit_since(0, "arm") == ()
    dropped.run(20, held=("part",))
    assert dropped.forces.hit_since(40, "part") == ()


def test_a_blow_on_a_moving_part_counts_for_the_object_that_it_belongs_to() -> None:
    falling = Falling(height=0.5, part=0.2, name="case/lid")
    falling.run(20)
    peaks = falling.forces.peaks(20)
    assert peaks["arm", "case/lid"].max() > 100.0
    assert np.array_equal(peaks["arm", "case"], peaks["arm", "case/lid"])
    assert falling.forces.touched_since(0, "arm") == ("case/lid",)


def test_what_fingers_press_on_what_they_grip_is_measured() -> None:
    run = execution([pick_place()])
    trace = run.complete(run.advance_until(lambda trace: trace.event_time("t:pick-end") is not None))
    assert trace.forces[PANDA, CUBE][-1] == pytest.approx(30.0, rel=0.05)
    assert trace.impulses[PANDA, CUBE][-1] == pytest.approx(30.0 * TICK, rel=0.05)


def press_on_the_bench(run: Execution, depth: float) -> Trace:
    """Drive the tool from above the bench to a place below its top by ``depth`` (m), and return the trace."""
    simulation = run.simulation
    robot = simulation.robots[PANDA]
    simulation.data.qpos[robot.joints] = simulation.data.act[robot.targets] = np.array(
        (0.0, 0.4, 0.0, -2.0, 0.0, 2.4, 0.785)
    )
    simulation.restart()
    lowered = np.array((0.0, 0.4 + depth, 0.0, -2.0, 0.0, 2.4, 0.785))
    for _ in range(60):
        simulation.command(robot, lowered, robot.model.gripper_closed)
        simulation.tick()
    events = (EventStamp("t:start", 0.0), EventStamp("t:end", simulation.time))
    return run.complete(simulation.trace(events, True, ""))


def judged(run: Execution, trace: Trace, sentence: str = UNTOUCHED) -> Verdict:
    return decide(read_clause(sentence), trace, run.regions, {"t:start", "t:end"})


def test_a_blow_on_a_fixed_table_is_a_collision_in_the_world_and_in_its_stored_trace() -> None:
    run = execution()
    trace = press_on_the_bench(run, 0.5)
    found = judged(run, trace)
    assert (found.outcome, found.unit) == (Outcome.VIOLATED, "N")
    assert found.robustness is not None
    assert found.robustness < -140.0
    assert judged(run, unpack(pack(Evidence(trace, run.regions))).trace) == found


def test_of_a_trace_without_forces_a_fixed_target_is_unknown() -> None:
    run = execution()
    trace = press_on_the_bench(run, 0.5)
    older = replace(trace, forces={}, impulses={}, watched=(), contacts=())
    assert judged(run, older).reason == f"the trace has no record of 'contact forces of {PANDA} on {BENCH}'"


def test_carrying_and_placing_never_count_as_a_collision_with_the_table() -> None:
    for thing, workspace in ((CUBE, BENCH_WS), (BALL, BENCH_WS), (CUBE, "env:bin1_ws")):
        run = execution([pick_place(thing, workspace)])
        trace = run.complete(run.advance_until(lambda _: False))
        assert not trace.remark
        found = judged(run, trace)
        assert found.outcome is Outcome.HOLDS
        assert found.robustness is not None
        assert found.robustness > 120.0


def test_a_heavy_part_that_is_gripped_where_it_stands_presses_on_nothing() -> None:
    run = execution([pick_place()], replace(SCENE, config=(ConfigSpec(CUBE, "mass", "40"),)))
    trace = run.complete(run.advance_until(lambda _: False))
    assert "lost" in trace.remark or "hold" in trace.remark
    assert judged(run, trace).outcome is Outcome.HOLDS


def test_a_limit_of_its_own_takes_the_place_of_the_default() -> None:
    run = execution([pick_place()], replace(SCENE, config=(ConfigSpec(BENCH, "force_limit", "0.1"),)))
    trace = run.complete(run.advance_until(lambda _: False))
    peak = float(trace.forces[PANDA, BENCH].max()) if (PANDA, BENCH) in trace.forces else 0.0
    found = judged(run, trace)
    assert found.robustness == pytest.approx(0.1 - peak)


def contacts_of(simulation: Simulation, trace: Trace) -> list[tuple[str, str, str]]:
    assert simulation.forces.agents == trace.watched
    return [(one.agent, one.part, one.other) for one in trace.contacts]


def test_contacts_are_listed_but_those_with_what_is_gripped_and_what_that_stands_on() -> None:
    run = execution([pick_place()])
    trace = run.complete(run.advance_until(lambda _: False))
    assert trace.forces[PANDA, CUBE].max() > 0.0
    assert contacts_of(run.simulation, trace) == []
    pressing = execution()
    found = press_on_the_bench(pressing, 0.5)
    assert contacts_of(pressing.simulation, found) == [(PANDA, "", BENCH)]
    (contact,) = found.contacts
    assert contact.peak == found.forces[PANDA, BENCH].max()
    assert contact.impulse == pytest.approx(found.impulses[PANDA, BENCH].sum())
    assert found.times[int(np.argmax(found.forces[PANDA, BENCH]))] == contact.peak_time
    assert BIN not in {one.other for one in found.contacts}
