"""The paper's set-up: objects dropped at random heights and orientations, and a cup that pulls from a distance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robbdd_tools.protocol.specs import ConfigSpec, SceneSpec
from robbdd_tools.world.composition import World, build_world
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.simulation import Simulation
from world.worlds import BALL, BIN, CUBE, OTHER_BIN, PANDA, SCENE

pytestmark = pytest.mark.physics
MANY = tuple(f"env:cube{number}" for number in range(8))
LOW, HIGH = 0.3, 0.4


def dropped(seed: int = 1, target: str = PANDA, objects: tuple[str, ...] = (CUBE, BALL)) -> World:
    others = tuple(name for name in SCENE.objects if name not in (CUBE, BALL))
    scene: SceneSpec = replace(
        SCENE, objects=(*objects, *others), config=(ConfigSpec(target, "drop_height", f"{LOW} {HIGH}"),)
    )
    return build_world(scene, seed)


def test_objects_start_between_the_heights_in_orientations_of_all_kinds() -> None:
    poses = [dropped(seed).poses[CUBE] for seed in range(40)]
    heights = [pose.position[2] for pose in poses]
    assert LOW <= min(heights) < LOW + 0.02
    assert HIGH - 0.02 < max(heights) <= HIGH
    tilts = [abs(1 - 2 * (pose.rotation[1] ** 2 + pose.rotation[2] ** 2)) for pose in poses]
    assert min(tilts) < 0.1, "some lie on their side"
    assert max(tilts) > 0.9, "some are upright"


def test_only_the_object_that_is_configured_is_dropped() -> None:
    poses = dropped(target=BALL).poses
    assert poses[BALL].position[2] >= LOW
    assert poses[CUBE].position[2] < 0.15


def test_dropped_objects_keep_no_clearance_but_are_not_inside_each_other() -> None:
    nearest = np.inf
    for seed in range(20):
        poses = dropped(seed, objects=MANY).poses
        places = np.array([poses[name].position for name in MANY])
        gaps = np.linalg.norm(places[:, None] - places[None], axis=2) + np.eye(len(MANY))
        assert gaps.min() > 0.0315, "cubes of 31.5 mm"
        flat = np.linalg.norm((places[:, None] - places[None])[..., :2], axis=2) + np.eye(len(MANY))
        nearest = min(nearest, flat.min())
    assert nearest < 0.04, "those of a laid-out scene are at least 85 mm apart"


def test_nothing_is_dropped_into_a_bin_even_if_its_range_has_one() -> None:
    middle = dropped().poses[BIN].position
    area = f"{middle[0] - 0.15} {middle[0] + 0.15} {middle[1] - 0.25} {middle[1] + 0.25}"
    config = (ConfigSpec(CUBE, "position_range", area), ConfigSpec(CUBE, "drop_height", f"{LOW} {HIGH}"))
    for seed in range(40):
        poses = build_world(replace(SCENE, config=config), seed).poses
        apart = [np.subtract(poses[CUBE].position, poses[name].position)[:2] for name in (BIN, OTHER_BIN)]
        assert min(np.abs(gap).max() for gap in apart) > 0.09


def test_they_fall_and_come_to_rest_before_the_scenario_starts() -> None:
    simulation = Simulation(dropped())
    simulation.settle()
    assert simulation.pose(CUBE)[0][2] == pytest.approx(0.116, abs=0.002)


def test_the_same_seed_drops_them_in_the_same_way() -> None:
    assert dropped(3).poses == dropped(3).poses
    assert dropped(3).poses != dropped(4).poses


def test_a_cup_pulls_from_the_attach_distance_and_no_farther() -> None:
    assert pulled(distance=0.01, gap=0.008)
    assert not pulled(distance=0.01, gap=0.014)
    assert not pulled(distance=0.0, gap=0.008)


def pulled(distance: float, gap: float) -> bool:
    """Whether a cup lifts a cube whose top is below it by a gap (m)."""
    config = (ConfigSpec("env:ur10", "attach_distance", str(distance)),)
    scene = replace(SCENE, agents=("env:ur10",), config=config)
    simulation = Simulation(build_world(scene, 1))
    robot = simulation.robots["env:ur10"]
    simulation.settle()
    cube = simulation.model.body(CUBE)
    start = int(simulation.model.jnt_qposadr[cube.jntadr[0]])
    tool = simulation.data.site_xpos[robot.tool].copy()
    axis = simulation.data.site_xmat[robot.tool].reshape(3, 3)[:, 2]
    assert axis[2] < -0.99
    simulation.data.qpos[start : start + 7] = [*(tool - [0.0, 0.0, gap + 0.01575]), 1.0, 0.0, 0.0, 0.0]
    simulation.data.qvel[:] = 0.0
    for _ in range(20):
        simulation.command(robot, np.array(robot.model.home), robot.model.gripper_closed)
        simulation.tick()
    return simulation.holds("env:ur10", CUBE) and simulation.pose(CUBE)[0][2] > tool[2] - 0.03


def test_fingers_have_no_attach_distance() -> None:
    scene = replace(SCENE, config=(ConfigSpec(PANDA, "attach_distance", "0.01"),))
    with pytest.raises(
        SceneError, match="'env:panda' has no attach_distance: it applies to an agent with a suction cup"
    ):
        build_world(scene, 1)
