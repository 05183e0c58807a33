"""An arm that something stops on its way has not placed its part, wherever it would let go of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from world.scene_instances import catalog, file, instance, link
from world.worlds import BIN, BIN_WS, CUBE, PANDA, pick_place, scenario

pytestmark = pytest.mark.physics

GEOM = '<geom type="box" size=".2 .02 {0}" pos="0 0 {0}"/>'
WALL = f'<mujoco><worldbody><body name="wall">{GEOM}</body></worldbody></mujoco>'


def across_a_wall(folder: Path, half_height: float) -> Execution:
    """Return an execution in which a wall stands on the table between the cube and the bin."""
    scene = SceneSpec((CUBE, BIN, "env:bench", "env:wall"), (PANDA,), {BIN_WS: (BIN,)}, {})
    wall = file(folder, "env:wall", WALL.format(half_height), ("x:g.wall", "wall"))
    links = (link("x:g.cube.mid", (0.5, -0.1, 0.116)), link("x:g.wall.foot", (0.5, 0.17, 0.1)))
    links += (link("x:g.bin.foot", (0.5, 0.38, 0.1)),)
    elements = (catalog(PANDA, "franka-panda"), catalog(CUBE, "cube", "x:g.cube"), catalog(BIN, "bin", "x:g.bin"), wall)
    built_in = Implementation("x:own", "catalog", "pick-place")
    spec = ExecutionSpec("x:run", "x:run", built_in, instance(*links, elements=elements))
    return Execution(replace(scenario(scene, 1), execution=spec), [pick_place(CUBE, BIN_WS)])


def test_a_part_that_cannot_be_carried_over_a_wall_is_not_placed(tmp_path: Path) -> None:
    run = across_a_wall(tmp_path, 0.35)
    assert not run.run_behaviour(0)
    assert "env:panda did not arrive: its tool is " in run.trace.remark
    assert run.trace.remark.endswith(" mm away: on its way, the arm touched env:wall")
    assert "place-end" not in {stamp.name for stamp in run.trace.events}


def test_a_low_wall_stops_nothing(tmp_path: Path) -> None:
    run = across_a_wall(tmp_path, 0.01)
    assert run.run_behaviour(0), run.trace.remark
