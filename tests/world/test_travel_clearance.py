"""The highest shape below the path of a carried object, in a world that is not stepped."""

from __future__ import annotations

from math import cos, pi, sin

import pytest

from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.motion import ToolPose
from robbdd_tools.world.placement import TABLE_TOP
from robbdd_tools.world.simulation import Simulation
from robbdd_tools.world.travel_clearance import height_over
from world.worlds import BENCH_WS, BIN, BIN_WS, CUBE, PANDA

SCENE = SceneSpec(
    objects=(CUBE, BIN, "env:bench"),
    agents=(PANDA,),
    workspaces={BENCH_WS: ("env:bench",), BIN_WS: (BIN,)},
    contains={BENCH_WS: (BIN_WS,)},
)
RIM = TABLE_TOP + 0.15
"""Height (m, world frame) of the bin's rim."""


def highest(start: tuple[float, float], goal: tuple[float, float], turn: float = 0.0, tilt: float = 0.0) -> float:
    """Return the height (m, world frame) below a path, with the bin 0.5 m ahead of the base.

    ``start`` and ``goal`` are radius (m) and bearing (rad), ``turn`` and ``tilt`` (rad) those of the bin.
    """
    simulation = Simulation(build_world(SCENE, 1))
    for name, place, angle, axis in ((CUBE, (0.0, 3.0, 0.2), 0.0, 3), (BIN, (0.5, 0.0, TABLE_TOP + 0.075), turn, 3)):
        address = simulation.model.jnt_qposadr[simulation.model.body(name).jntadr[0]]
        simulation.data.qpos[address : address + 3] = place
        simulation.data.qpos[address + 3 : address + 7] = [cos(angle / 2), 0.0, 0.0, 0.0]
        simulation.data.qpos[address + axis + 3] = sin(angle / 2)
        if tilt and name == BIN:
            simulation.data.qpos[address + 3 : address + 7] = [cos(tilt / 2), sin(tilt / 2), 0.0, 0.0]
    mujoco.mj_kinematics(simulation.model, simulation.data)
    robot = simulation.robots[PANDA]
    poses = (ToolPose(radius, bearing, 0.1, 0.0) for radius, bearing in (start, goal))
    return height_over(simulation, robot, CUBE, *poses) + robot.base.position[2]


def test_the_rim_of_a_bin_below_the_path_counts() -> None:
    assert highest((0.5, 0.8), (0.5, -0.8)) == pytest.approx(RIM, abs=1e-3)


def test_beside_the_bin_only_the_table_is_below() -> None:
    assert highest((0.5, 0.8), (0.5, 1.0)) == pytest.approx(TABLE_TOP, abs=1e-3)


def test_the_bin_counts_as_it_is_turned() -> None:
    # A path at a radius of 0.66 m passes the bin on its long side and crosses the end of a turned one.
    path = ((0.66, 0.2), (0.66, -0.2))
    found = {round(highest(*path, turn), 2) for turn in (0.0, pi / 2)}
    assert found == {round(TABLE_TOP, 2), round(RIM, 2)}


def test_a_tilted_bin_is_taller() -> None:
    assert highest((0.5, 0.8), (0.5, -0.8), tilt=0.5) > RIM + 0.03
