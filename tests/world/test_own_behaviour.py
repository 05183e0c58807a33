"""Users' own behaviours: executed, their events recorded, their errors attributed to them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, Origin
from robbdd_tools.monitor.without_physics import KINEMATIC
from robbdd_tools.protocol.specs import ExecutionSpec
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from world.worlds import BIN_WS, CUBE, PANDA, pick_place, scenario

NOD = """
class Nod:
    def reset(self, world, behaviour, arguments):
        self.world, self.left, self.start = world, 30, world.joints
        self.told = (behaviour, dict(arguments))
        world.emit("pick-start")

    def step(self):
        goal = self.start.copy()
        goal[5] += 0.1
        self.world.command(self.start + (goal - self.start) * min(1.0, (31 - self.left) / 25), 1.0)
        self.left -= 1
        if self.left == 10:
            self.world.emit("pick-end")
        if not self.left:
            self.world.emit("place-start")
            self.world.emit("place-end")
        return not self.left
"""
counter = iter(range(1000))


def run(folder: Path, code: str, attribute: str = "Nod", kind: str = "python", world: str = "") -> Execution:
    module = f"own_behaviour_{next(counter)}"
    (folder / f"{module}.py").write_text(code, encoding="utf-8")
    origin = Origin(str(folder / "run.bddx"), 5, 3)
    name = f"{module}:{attribute}" if kind == "python" else attribute
    execution = ExecutionSpec("x:run", "x:run", Implementation("x:own", kind, name, origin))
    spec = replace(scenario(), execution=execution, world=world)
    return Execution(spec, [pick_place(CUBE, BIN_WS, PANDA)])


@pytest.mark.physics
def test_a_behaviour_moves_the_arm_and_stamps_its_events(tmp_path: Path) -> None:
    execution = run(tmp_path, NOD)
    robot = execution.simulation.robots[PANDA]
    start = execution.simulation.joint_positions(robot).copy()
    assert execution.run_behaviour(0), execution.trace.remark
    assert execution.simulation.joint_positions(robot)[5] - start[5] == pytest.approx(0.1, abs=0.01)
    names = [stamp.name for stamp in execution.trace.events]
    assert names[:5] == ["t:start", "t:pick-start", "t:pick-end", "t:place-start", "t:place-end"]
    times = [stamp.time for stamp in execution.trace.events]
    assert times == sorted(times)


@pytest.mark.physics
@pytest.mark.parametrize(
    ("code", "words"),
    [
        (
            NOD.replace("self.left -= 1", "self.left -= none"),
            r"failed: NameError: .*own_behaviour_\d+\.py:12\) at",
        ),
        (NOD.replace("world.joints", "world.knees"), r"AttributeError: .*knees.*own_behaviour_\d+\.py:4\)"),
        (
            NOD.replace('"pick-end"', '"pick-over"'),
            r"ValueError: 'pick-place' has no event 'pick-over': it emits pick-start, pick-end, .*:14\)",
        ),
        ("class Other: pass", r"run\.bddx:5:3: the Python module own_behaviour_\d+ has no function 'Nod'"),
        ("import no_such_module_at_all", r"run\.bddx:5:3: .* failed: ModuleNotFoundError"),
    ],
)
def test_an_error_in_the_code_is_told_as_the_users(tmp_path: Path, code: str, words: str) -> None:
    execution = run(tmp_path, code)
    assert not execution.run_behaviour(0)
    assert re.search(words, execution.broken), execution.broken
    # Later events are unknown: the scenario does not finish.
    assert "t:end" not in [stamp.name for stamp in execution.trace.events]


@pytest.mark.physics
def test_an_event_of_another_behaviour_may_be_emitted_and_concerns_no_clause(tmp_path: Path) -> None:
    execution = run(tmp_path, NOD.replace('world.emit("place-start")', 'world.emit("push-start")'))
    assert execution.run_behaviour(0), execution.trace.remark


@pytest.mark.physics
@pytest.mark.parametrize(
    ("call", "words"),
    [
        ("command(self.start * float('nan'), 1.0)", r"ValueError: joints must be 7 finite numbers, not .*nan"),
        ("command(self.start + float('inf'), 1.0)", r"ValueError: joints must be 7 finite numbers, not .*inf"),
        ("command(self.start[:3], 1.0)", "ValueError: joints must be 7 finite numbers"),
        ("command(self.start, float('nan'))", "ValueError: opening must be a number from 0 to 1, not nan"),
        ("solve([0.5, float('nan'), 0.3])", "ValueError: position must be 3 finite numbers, not .*nan"),
        ("solve([0.5, 0.1, 0.3], float('inf'))", "ValueError: closing must be a finite number, not inf"),
    ],
)
def test_numbers_that_are_none_end_the_behaviour_with_a_reason(tmp_path: Path, call: str, words: str) -> None:
    execution = run(tmp_path, NOD.replace("self.left -= 1", f"self.left -= 1; self.world.{call}"))
    assert not execution.run_behaviour(0)
    assert re.search(words, execution.broken), execution.broken
    assert np.isfinite(execution.trace.positions).all()


@pytest.mark.physics
@pytest.mark.parametrize("world", ["", KINEMATIC])
def test_joints_never_move_faster_than_their_limits_whatever_is_commanded(tmp_path: Path, world: str) -> None:
    goal = "goal += [-1.0, 0.5, 0.5, 0.5, -1.0, 0.5, 1.0]; self.world.command(goal, 1.0)"
    jump = NOD.replace("goal[5] += 0.1", goal).replace("self.world.command(self.start + ", "(self.start + ")
    execution = run(tmp_path, jump.replace("(31 - self.left) / 25), 1.0)", "1.0))"), world=world)
    robot, limits = execution.simulation.robots[PANDA], np.array([2.175] * 4 + [2.61] * 3)
    fastest = np.zeros(7)

    def measure() -> None:
        fastest[:] = np.maximum(fastest, np.abs(execution.simulation.joint_velocities(robot)))

    execution.simulation.watchers.append(measure)
    assert execution.run_behaviour(0), execution.broken
    assert (fastest < 1.02 * limits).all(), fastest
    assert (fastest > 0.9 * limits).all(), fastest


@pytest.mark.physics
@pytest.mark.parametrize("world", ["", KINEMATIC])
@pytest.mark.parametrize(
    ("change", "what"),
    [
        ("data.qpos[-7:-4] = [0.5, 0.0, 0.5]", "qpos"),
        ("data.qvel[-6:-3] = [0.0, 0.0, 3.0]", "qvel"),
        ("data.xfrc_applied[-1] = 1.0", "xfrc_applied"),
        ("model.geom_friction[:] = 2.0", "geom_friction"),
        ("model.opt.gravity[:] = 0.0", "gravity"),
        ("model.opt.disableflags |= 64", "disableflags"),
        ("model.opt.timestep = 1e-4", "timestep"),
        ("model.dof_armature[:] = 9.0", "dof_armature"),
        ("data.time = 9.0", "time"),
    ],
)
def test_a_behaviour_that_changes_the_simulation_itself_leaves_its_clauses_unknown(
    tmp_path: Path, world: str, change: str, what: str
) -> None:
    execution = run(
        tmp_path, NOD.replace("self.left -= 1", f"self.left -= 1; self.world._simulation.{change}"), world=world
    )
    assert not execution.run_behaviour(0)
    words = (
        rf"own_behaviour_\d+:Nod has changed the simulation itself \({what}\): it may only move its arm, by 'command'"
    )
    assert re.search(words, execution.broken), execution.broken


@pytest.mark.physics
def test_a_behaviour_that_lets_the_engine_call_its_code_leaves_its_clauses_unknown(tmp_path: Path) -> None:
    code = "import mujoco\n" + NOD.replace(
        "self.left -= 1", "self.left -= 1; mujoco.set_mjcb_passive(lambda model, data: None)"
    )
    execution = run(tmp_path, code)
    try:
        assert not execution.run_behaviour(0)
    finally:
        mujoco.set_mjcb_passive(None)
    assert "has changed the simulation itself (mjcb_passive)" in execution.broken


@pytest.mark.physics
def test_a_behaviour_that_says_that_it_failed_has_failed(tmp_path: Path) -> None:
    code = "from robbdd_tools.catalog.own_behaviour import BehaviourFailed\n" + NOD.replace(
        "self.left -= 1", "raise BehaviourFailed('the door is locked')"
    )
    execution = run(tmp_path, code)
    assert not execution.run_behaviour(0)
    assert execution.broken == ""
    assert "the door is locked at 0.5" in execution.advance_until(lambda trace: trace.finished).remark


def test_what_this_installation_cannot_execute_is_said(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"run\.bddx:5:3: the ROS action '/pick' is not available in simulation"):
        run(tmp_path, "", "/pick", "ros-action")
    with pytest.raises(SceneError, match=r"'place' of the catalog does not execute 'pick-place'"):
        run(tmp_path, "", "place", "catalog")
