"""Measurements for users' behaviours: velocities, contact forces, joints, gravity, tools in any orientation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, Origin
from robbdd_tools.catalog.own_behaviour import BehaviourFailed, World
from robbdd_tools.protocol.specs import ExecutionSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.engine import TICK
from robbdd_tools.world.errors import SimulationError
from robbdd_tools.world.kinematic import KinematicSimulation
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.user_behaviour import AgentWorld
from world.worlds import BIN, BIN_WS, CUBE, PANDA, SCENE, pick_place, scenario

BENCH = "env:bench"
DRAWER = replace(SCENE, objects=(*SCENE.objects, "env:drawer1"), agents=(PANDA, "env:kinova"))


def begun(kind: type[Simulation] = Simulation, agent: str = PANDA) -> tuple[Simulation, AgentWorld]:
    simulation = kind(build_world(DRAWER, 1))
    simulation.settle()
    return simulation, AgentWorld(simulation, agent, lambda _: None)


@pytest.mark.physics
def test_a_falling_object_has_the_velocity_that_gravity_gives_it() -> None:
    simulation, world = begun()
    state = simulation.state
    address = simulation.model.jnt_qposadr[simulation.model.body(CUBE).jntadr[0]]
    state[address + 2] += 0.3
    simulation.restore(state)
    for _ in range(6):
        simulation.tick()
    linear, around = world.velocity(CUBE)
    assert world.gravity == pytest.approx([0.0, 0.0, -9.81])
    # The engine's velocity is that of its last step of 2 ms.
    assert linear == pytest.approx(world.gravity * 6 * TICK, abs=0.03)
    assert around == pytest.approx(np.zeros(3), abs=1e-6)
    assert world.velocity(BIN)[0] == pytest.approx(np.zeros(3), abs=1e-3)


@pytest.mark.physics
def test_a_spinning_object_turns_about_its_axis() -> None:
    simulation, world = begun()
    state = simulation.state
    joint = simulation.model.body(CUBE).jntadr[0]
    state[simulation.model.jnt_qposadr[joint] + 2] += 0.3
    simulation.restore(state)
    simulation.data.qvel[simulation.model.jnt_dofadr[joint] + 5] = 4.0
    simulation.tick()
    assert world.velocity(CUBE)[1] == pytest.approx([0.0, 0.0, 4.0], abs=0.05)


@pytest.mark.parametrize("kind", [Simulation, KinematicSimulation])
def test_the_velocities_of_joints_are_those_of_the_arm(kind: type[Simulation]) -> None:
    simulation, world = begun(kind)
    goal = world.joints
    assert world.joint_velocities == pytest.approx(np.zeros(7), abs=0.05)
    for _ in range(40):
        goal[0] += 0.5 * TICK
        world.command(goal, 1.0)
        simulation.tick()
    assert world.joint_velocities[0] == pytest.approx(0.5, abs=0.05)
    lower, upper = world.joint_limits
    assert ((lower < world.joints) & (world.joints < upper)).all()


@pytest.mark.physics
def test_a_hand_that_presses_on_the_table_feels_it(tmp_path: Path) -> None:
    """The behaviour of docs/simulation.md."""
    text = (Path(__file__).parents[2] / "docs" / "simulation.md").read_text(encoding="utf-8")
    code = text[text.index("class Press:") :].partition("```")[0]
    imports = "from robbdd_tools.catalog.own_behaviour import BehaviourFailed\nimport numpy as np\n"
    (tmp_path / "press_on_the_table.py").write_text(imports + code.replace('"lab:', '"env:'), encoding="utf-8")
    origin = Origin(str(tmp_path / "run.bddx"), 5, 3)
    own = Implementation("x:own", "python", "press_on_the_table:Press", origin)
    spec = replace(scenario(), execution=ExecutionSpec("x:run", "x:run", own))
    pressing = Execution(spec, [pick_place(CUBE, BIN_WS, PANDA)])
    felt: list[float] = []
    simulation = pressing.simulation
    simulation.watchers.append(lambda: felt.append(simulation.contact_force(PANDA, BENCH)))
    assert pressing.run_behaviour(0), pressing.trace.remark
    assert 5.0 < max(felt) < 140.0, "less than what does not collide allows"
    assert min(felt) == 0.0


def test_joints_of_other_agents_and_of_things_are_known() -> None:
    simulation, world = begun()
    other = simulation.robots["env:kinova"]
    assert world.joints_of("env:kinova") == pytest.approx(simulation.joint_positions(other))
    assert world.joints_of("env:drawer1").shape == (1,)
    for name in (CUBE, "env:nothing"):
        with pytest.raises(KeyError, match="no agent, and no thing that opens"):
            world.joints_of(name)


def test_unknown_names_are_told() -> None:
    _, world = begun()
    with pytest.raises(KeyError, match="there is no 'env:nothing' in the scene; it has"):
        world.velocity("env:nothing")
    with pytest.raises(KeyError, match="there is no 'env:nothing' in the scene; it has"):
        world.force(PANDA, "env:nothing")


def test_the_kinematic_world_has_velocities_but_no_forces() -> None:
    _, world = begun(KinematicSimulation)
    assert world.velocity(CUBE)[0] == pytest.approx(np.zeros(3))
    with pytest.raises(SimulationError, match="the kinematic world has no forces"):
        world.force(PANDA, CUBE)


@pytest.mark.parametrize("agent", [PANDA, "env:kinova"])
def test_a_tool_has_any_orientation(agent: str) -> None:
    simulation, world = begun(agent=agent)
    place, present = world.tool
    tilt = np.radians(40.0)
    about = np.array([[np.cos(tilt), 0.0, np.sin(tilt)], [0.0, 1.0, 0.0], [-np.sin(tilt), 0.0, np.cos(tilt)]])
    wanted = about @ present
    goal = world.solve(place, rotation=wanted)
    robot = simulation.robots[agent]
    simulation.data.qpos[robot.joints] = goal
    simulation.record()
    assert world.tool[0] == pytest.approx(place, abs=1e-3)
    assert world.tool[1] == pytest.approx(wanted, abs=1e-3)


def test_a_matrix_that_is_no_rotation_is_refused() -> None:
    world: World = begun()[1]
    for wrong in (np.ones((3, 3)), np.diag([1.0, 1.0, -1.0]), np.full((3, 3), np.nan), np.eye(2)):
        with pytest.raises(ValueError, match="rotation must be a rotation matrix"):
            world.solve(np.array([0.4, 0.0, 0.3]), rotation=wrong)
    with pytest.raises(BehaviourFailed, match="cannot reach"):
        world.solve(np.array([4.0, 0.0, 0.3]), rotation=np.eye(3))
