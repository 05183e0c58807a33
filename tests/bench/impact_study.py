"""``python -m tests.bench.impact_study [FILE.svg]``: peak force and impulse of a blow on a fixed table, by speed.

Each arm comes down vertically on the table at a constant speed with its gripper closed. Either it is stopped one
control tick after the touch, or it is driven on to 20 mm below the place of the touch, as by a controller that notices
nothing. The figures and the plot are for ``docs/simulation.md``.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent))

from bench.chart import Series, scatter
from robbdd_tools.catalog.predicates.does_not_collide import FORCE_LIMIT
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.engine import TICK, mujoco
from robbdd_tools.world.motion import frame_of, tool_pose
from robbdd_tools.world.placement import TABLE_TOP
from robbdd_tools.world.robot import Robot
from robbdd_tools.world.simulation import Simulation
from world.worlds import BENCH_WS, SCENE

AGENTS = ("env:panda", "env:kinova", "env:ur10")
SPEEDS = (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.35, 0.5)
BENCH = "env:bench"
PLACE = (0.5, 0.0)
"""Position of the impact, m."""
ABOVE = 0.12
"""Height of the tool above the table at the start, m."""
DRIVEN_ON = 0.02
"""Distance that a controller without contact detection continues, m."""
BLOW = 0.05
"""Time after the touch over which the impulse is taken, s."""
WATCHED = 0.5
"""Time after the touch that is simulated, s."""


@dataclass(frozen=True)
class Impact:
    """Speed before the touch (m/s), largest force (N), impulse within ``BLOW`` (N s), the arm's effective mass (kg)."""

    speed: float
    peak: float
    impulse: float
    mass: float


def effective_mass(simulation: Simulation, robot: Robot) -> float:
    """Return the mass (kg) that resists a vertical push at the tool: 1 / (J M⁻¹ Jᵀ), rotors included."""
    model, data = simulation.model, simulation.data
    mujoco.mj_forward(model, data)
    jacobian = np.zeros((3, model.nv))
    mujoco.mj_jacSite(model, data, jacobian, None, robot.tool)
    solved = np.zeros((1, model.nv))
    mujoco.mj_solveM(model, data, solved, jacobian[2:3])
    return float(1.0 / (jacobian[2] @ solved[0]))


def strike(agent: str, speed: float, driven_on: float = 0.0) -> Impact:
    """Move an arm down onto the table at a speed (m/s) of the tool and return the forces on the table."""
    scene = replace(SCENE, objects=(BENCH,), agents=(agent,), workspaces={BENCH_WS: (BENCH,)}, contains={})
    simulation = Simulation(build_world(scene, 1))
    robot = simulation.robots[agent]
    arm = arm_of(robot.model)
    closed = robot.model.gripper_closed

    def at(height: float, seed: np.ndarray) -> np.ndarray:
        where, rotation = frame_of(tool_pose(robot.base, np.array([*PLACE, TABLE_TOP + height]), 0.0))
        return arm.solve(seed, where, rotation)

    joints = at(ABOVE, arm.home)
    simulation.data.qpos[robot.joints] = simulation.data.act[robot.targets] = joints
    for _ in range(60):
        simulation.command(robot, joints, closed)
        simulation.tick()
    simulation.restart()
    height, touched, remaining = ABOVE, 0, driven_on
    mass = effective_mass(simulation, robot)
    heights = [float(simulation.data.site_xpos[robot.tool][2])]
    before = joints
    while not touched or simulation.ticks - touched < WATCHED / TICK:
        step = speed * TICK if not touched else min(speed * TICK, remaining)
        remaining -= step if touched else 0.0
        height -= step
        joints = at(height, joints)
        # Servos lag because of their damping; the lead compensates for it, as in the catalog's behaviours.
        simulation.command(robot, joints + robot.lead * (joints - before) / TICK, closed)
        before = joints
        simulation.tick()
        heights.append(float(simulation.data.site_xpos[robot.tool][2]))
        if not touched and simulation.forces.peaks(simulation.ticks + 1):
            touched = simulation.ticks
    rows = simulation.ticks + 1
    force, impulse = simulation.forces.peaks(rows)[agent, BENCH], simulation.forces.impulses(rows)[agent, BENCH]
    blow = slice(touched, touched + round(BLOW / TICK) + 1)
    reached = (heights[touched - 3] - heights[touched - 1]) / (2 * TICK)
    return Impact(reached, float(force.max()), float(impulse[blow].sum()), mass)


def main(picture: Path | None) -> None:
    """Print the table of the study and draw its plot."""
    series: list[Series] = []
    print("| arm, effective mass | speed | stopped: peak, impulse | driven on: peak, impulse |")
    print("|---|---|---|---|")
    for agent in AGENTS:
        stopped = [strike(agent, speed) for speed in SPEEDS]
        driven = [strike(agent, speed, DRIVEN_ON) for speed in SPEEDS]
        for speed, one, on in zip(SPEEDS, stopped, driven, strict=True):
            print(
                f"| {agent.removeprefix('env:')}, {one.mass:.1f} kg | {speed:g} m/s | {one.peak:.0f} N, "
                f"{one.impulse:.1f} N s | {on.peak:.0f} N, {on.impulse:.1f} N s |"
            )
        name = agent.removeprefix("env:")
        series.append(Series(f"{name}, stopped", [(one.speed, one.peak) for one in stopped]))
        series.append(Series(f"{name}, driven on", [(one.speed, one.peak) for one in driven], hollow=True))
    if picture is not None:
        lines = ((FORCE_LIMIT, f"{FORCE_LIMIT:.0f} N, ISO/TS 15066"),)
        picture.write_text(scatter(series, "speed of the tool, m/s", "peak force, N", lines), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
