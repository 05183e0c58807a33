"""A robot collides with itself and its pedestal; parts that are always close to each other do not count."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.monitor.trace import EventStamp, Trace
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.world.arm_kinematics import Unreachable, arm_of
from robbdd_tools.world.clearance import Clearance
from robbdd_tools.world.mobile_base import base_of
from robbdd_tools.world.motion import ToolPose, frame_of
from robbdd_tools.world.reaching import Obstruction
from robbdd_tools.world.robot_specs import load_robot
from robbdd_tools.world.robots_in_world import COLUMN
from robbdd_tools.world.self_collision import name_bodies, pairs_apart
from world.worlds import CUBE, PANDA, execution, pick_place

if TYPE_CHECKING:
    from collections.abc import Sequence

pytestmark = pytest.mark.physics
HOME = (0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785)
INTO_ITSELF = (0.0, -1.7, 0.0, -3.05, 0.0, 0.3, 0.785)
"""Joint positions (rad) at which the hand is in the lower arm."""


def moved(run: Execution, goal: Sequence[float], ticks: int = 120) -> Trace:
    """Drive the arm to joint positions (rad) and return the trace."""
    simulation, robot = run.simulation, run.simulation.robots[PANDA]
    start = np.array(HOME)
    for tick in range(ticks):
        share = min(1.0, 2 * tick / ticks)
        simulation.command(robot, start + share * (np.array(goal) - start), robot.model.gripper_open)
        simulation.tick()
    stamps = (EventStamp("t:start", 0.0), EventStamp("t:end", simulation.time))
    return run.complete(simulation.trace(stamps, True, ""))


def test_an_arm_hits_the_column_that_it_stands_on() -> None:
    model = execution().simulation.model
    column = model.body(f"{PANDA}/{COLUMN}").geomadr[0]
    hand = model.geom_bodyid == model.body(f"{PANDA}/hand").id
    assert (model.geom_contype[hand] & model.geom_conaffinity[column]).all()
    excluded = {int(signature) for signature in model.exclude_signature}
    ids = [model.body(f"{PANDA}/{name}").id for name in (COLUMN, "link3")]
    assert (min(ids) << 16) + max(ids) not in excluded
    assert (model.body(f"{PANDA}/link2").id << 16) + model.body(f"{PANDA}/{COLUMN}").id in excluded


def test_an_arm_that_is_driven_into_itself_touches_itself() -> None:
    run = execution()
    trace = moved(run, INTO_ITSELF)
    assert [(one.agent, one.other) for one in trace.contacts] == [(PANDA, PANDA)]
    clause = read_clause(f'"{PANDA}" does not collide "{PANDA}" from "t:start" until "t:end"')
    found = decide(clause, trace, run.regions, {"t:start", "t:end"})
    peak = float(trace.forces[PANDA, PANDA].max())
    assert peak > 1.0
    assert (found.robustness, found.unit) == (pytest.approx(140.0 - peak), "N")


def test_ordinary_work_touches_neither_the_arm_nor_its_column() -> None:
    run = execution([pick_place()])
    trace = run.complete(run.advance_until(lambda _: False))
    assert not trace.remark
    assert (PANDA, PANDA) not in trace.forces
    clause = read_clause(f'"{PANDA}" does not collide "{PANDA}" from "t:start" until "t:end"')
    assert decide(clause, trace, run.regions, {"t:start", "t:end"}).outcome is Outcome.HOLDS


def test_postures_in_which_the_arm_is_in_itself_are_not_clear() -> None:
    simulation = execution().simulation
    clearance = Clearance(simulation, simulation.robots[PANDA], CUBE, simulation.data)
    assert clearance.depth(np.array(HOME)) == 0.0
    assert clearance.depth(np.array(INTO_ITSELF)) > 0.005
    assert clearance.hit(np.array(INTO_ITSELF)).owner == "itself"


def test_a_posture_in_the_table_names_the_table() -> None:
    simulation = execution().simulation
    robot = simulation.robots[PANDA]
    down = arm_of(robot.model).solve(np.array(HOME), *frame_of(ToolPose(0.5, 0.0, -0.1, 0.0)))
    hit = Clearance(simulation, robot, CUBE, simulation.data).hit(down)
    assert hit.owner == "env:bench"
    assert str(Obstruction(touched={hit.owner: None})) == ": the arm would touch env:bench"


def test_of_several_poses_out_of_reach_the_nearest_is_named() -> None:
    reason = Obstruction()
    assert str(reason) == ""
    for place, turn in ((0.2, 0.0), (0.0, 0.0349), (0.05, 0.1)):
        reason.note(Unreachable(place, turn))
    assert str(reason) == ": its tool stays turned 2.0° away"
    assert str(Unreachable(0.0, 0.0004)) == "turned less than 0.1° away"


@pytest.mark.parametrize("name", list(load_catalog().robots))
def test_neighbours_and_the_parts_of_a_gripper_are_left_out_and_nothing_else(name: str) -> None:
    robot = load_catalog().robots[name]
    child = load_robot(robot)
    name_bodies(child)
    apart, beside = pairs_apart(child, robot)
    bodies = [str(body.name) for body in child.bodies[1:]]
    foot = bodies.index(str(child.joint(robot.joints[0]).parent.name)) - 1
    links = bodies[foot : foot + len(robot.joints) + 1]
    chain = list(pairwise(links)) + list(zip(links, links[2:], strict=False))
    assert set(chain) <= set(apart)
    far = [(one, other) for i, one in enumerate(links) for other in links[i + 3 :]]
    assert not set(far) & set(apart)
    # Only fixed arms have a pedestal that they could touch.
    assert beside == ([] if base_of(robot) else links[:3])
