"""Arms hang from ceilings, lean, and are fixed to walls: their tools point down all the same."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Implementation, ModelSource, Realisation
from robbdd_tools.protocol.specs import ExecutionSpec
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.tilted_base import rotation_of, upright_part
from world import strangers
from world.arms import MJCF
from world.arms_from_files import ARM, source
from world.scene_instances import instance, link
from world.worlds import BIN_WS, CUBE, SCENE, pick_place, scenario

HALF = 0.5**0.5
FOOT, FRAME = "x:g.foot", "x:g.foot.base"
HANGING = (0.0, 1.0, 0.0, 0.0)
ON_WALL = (HALF, 0.0, HALF, 0.0)
LEANING = (cos(pi / 12), 0.0, sin(pi / 12), 0.0)


def hung(model: ModelSource, position: tuple[float, ...], turn: tuple[float, ...]) -> Execution:
    """Return the execution in which an arm on a base at a pose moves the cube into the bin."""
    placed = replace(model, bodies=((FOOT, "foot"),))
    cell = instance(link(FRAME, position, turn=turn), elements=(Realisation(ARM, (placed,)),))
    run = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), cell)
    spec = replace(scenario(replace(SCENE, agents=(ARM,)), 1), execution=run)
    return Execution(spec, [pick_place(CUBE, BIN_WS, ARM)])


def catalog(name: str) -> ModelSource:
    return ModelSource(f"x:{name}", "mjcf", "catalog", name)


@pytest.mark.physics
@pytest.mark.parametrize(
    ("text", "position", "turn"),
    [
        (MJCF, (0.2, 0.1, 1.25), HANGING),
        (strangers.SIX, (0.2, 0.1, 1.15), HANGING),
        (strangers.SIX, (-0.1, 0.0, 0.3), LEANING),
        ("", (0.1, 0.1, 1.15), HANGING),
    ],
    ids=["five axes", "six axes", "leaning", "Panda"],
)
def test_arms_pick_and_place_from_a_tilted_base(
    tmp_path: Path, text: str, position: tuple[float, ...], turn: tuple[float, ...]
) -> None:
    run = hung(source(tmp_path, text) if text else catalog("franka-panda"), position, turn)
    assert run.run_behaviour(0), run.trace.remark
    (cube, _), (container, _) = run.simulation.pose(CUBE), run.simulation.pose("env:bin1")
    assert abs(cube[:2] - container[:2]).max() < 0.15


@pytest.mark.parametrize("turn", [HANGING, ON_WALL, LEANING])
def test_the_simulated_arm_is_where_its_kinematics_say(tmp_path: Path, turn: tuple[float, ...]) -> None:
    run = hung(source(tmp_path, strangers.SIX), (0.1, 0.2, 0.9), turn)
    robot = run.simulation.robots[ARM]
    place, axes = arm_of(robot.model).forward(np.array(robot.model.home))
    c, s = cos(robot.base.yaw), sin(robot.base.yaw)
    about = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    tool, turned = run.simulation.tool(robot)
    # The servos of the file let the arm sag a little until the clock starts.
    assert tool == pytest.approx(about @ place + robot.base.position, abs=0.02)
    assert turned == pytest.approx(about @ axes, abs=0.05)
    assert turned[2, 2] < -0.99, "the tool points down"


def test_a_hanging_arm_has_no_pedestal(tmp_path: Path) -> None:
    def columns(turn: tuple[float, ...]) -> list[str]:
        model = hung(source(tmp_path, strangers.SIX), (0.1, 0.2, 1.2), turn).simulation.model
        return [name for body in range(model.nbody) if (name := model.body(body).name).endswith("column")]

    assert len(columns((1.0, 0.0, 0.0, 0.0))) == 1
    assert columns(HANGING) == []


@pytest.mark.parametrize(("turn", "yaw"), [(HANGING, 0.0), (ON_WALL, 0.0), (LEANING, 0.0), ((0.0, 0.0, 1.0, 0.0), pi)])
def test_ahead_is_where_the_base_points_to(turn: tuple[float, float, float, float], yaw: float) -> None:
    base, tilt = upright_part(Pose((1.0, 2.0, 1.234), 0.3, turn))
    assert tilt is not None
    assert (base.position, base.rotation, tilt.height) == ((1.0, 2.0, 1.234), (), 1.23)
    assert abs(base.yaw) == pytest.approx(yaw)
    back = np.array(rotation_of(base.yaw, tilt.rotation))
    assert abs(back @ np.array(turn)) == pytest.approx(1.0)


def test_a_robot_that_drives_stands_upright() -> None:
    placed = replace(catalog("mobile-panda"), bodies=((FOOT, "foot"),))
    cell = instance(link(FRAME, (0.0, 0.0, 1.0), turn=HANGING), elements=(Realisation(ARM, (placed,)),))
    with pytest.raises(SceneError, match="drives on the floor, so its base cannot be tilted"):
        build_world(replace(SCENE, agents=(ARM,)), 1, instance=cell)
