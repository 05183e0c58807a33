"""Several agents that are the arms of one robot share what carries them; each moves its own arm."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit import ROOT
from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import ArmModel, Implementation, ModelSource, Origin, Realisation
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.composition import World
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.motion import frame_of
from robbdd_tools.world.overlaps import refuse_overlaps
from robbdd_tools.world.parking import parking_pose
from world.arms import MJCF
from world.arms_from_files import source
from world.arms_of_others import FOLDER
from world.scene_instances import instance, link
from world.test_mounted_gripper import BARE, GRIPPER, mounted
from world.worlds import BIN, BIN_WS, CUBE, SCENE, pick_place, scenario

LEFT, RIGHT = "env:left", "env:right"
TORSO = "left+right"
BARE_OF_SIX = BARE.replace('<joint name="elbow"', '<joint name="twist" axis="0 0 1" range="-3 3"/><joint name="elbow"')
"""An arm of six joints without a gripper: one with fewer counts as a finger, a wheel or a head."""


def two_arms(beside: float, arm: str = MJCF) -> str:
    """Return a file with a torso that carries two arms beside its middle (m), and a post behind the left one."""
    both = mujoco.MjSpec()
    torso = both.worldbody.add_body(name="torso")
    torso.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.05, 0.3, 0.02], pos=[-0.1, 0.0, 0.02])
    torso.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.03, 0.1, 0.2], pos=[-0.62, 0.35, 0.2])
    for prefix, aside in (("l_", beside), ("r_", -beside)):
        both.attach(mujoco.MjSpec.from_string(arm), prefix=prefix, frame=torso.add_frame(pos=[0.0, aside, 0.0]))
    model = both.compile()
    key = f'<keyframe><key name="rest" qpos="{" ".join(["0"] * model.nq)}"/></keyframe>'
    apart = '<contact><exclude body1="r_hand" body2="l_hand"/></contact>'
    return str(both.to_xml()).replace("</mujoco>", f"{apart}{key}</mujoco>")


def begun(
    folder: Path,
    tools: tuple[str, str] = ("l_hand", "r_hand"),
    aside: float = 0.0,
    beside: float = 0.25,
    flanges: tuple[str, str] | None = None,
    **calls: str,
) -> Execution:
    """Return an execution with two agents of one file; the second one's base is ``aside`` (m) to the right.

    With ``flanges``, the arms have no grippers, and the same gripper is mounted on each flange.
    """
    (folder / "fingers.xml").write_text(GRIPPER, encoding="utf-8")
    arms = [ArmModel(tool=tool) for tool in tools] if flanges is None else [mounted(on=flange) for flange in flanges]
    text = two_arms(beside, MJCF if flanges is None else BARE_OF_SIX)
    elements = tuple(
        Realisation(
            name,
            (
                replace(
                    source(folder, text, arm),
                    iri=f"x:{place}",
                    bodies=((f"x:g.{place}", "torso"),),
                ),
            ),
        )
        for name, arm, place in ((LEFT, arms[0], "one"), (RIGHT, arms[1], "two"))
    )
    places = (link("x:g.one.base", (0.0, 0.0, 0.15)), link("x:g.two.base", (0.0, -aside, 0.15)))
    run = ExecutionSpec(
        "x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance(*places, elements=elements)
    )
    spec = replace(scenario(replace(SCENE, agents=(LEFT, RIGHT)), 1), execution=run)
    return Execution(spec, [pick_place(CUBE, BIN_WS, agent) for agent in calls.values()])


def shaped(world: World) -> Counter[str]:
    """Count the shapes of each agent, and of what carries them."""
    bodies = world.model.geom_bodyid
    names = [str(world.model.body(int(body)).name).partition("/") for body in bodies]
    return Counter(prefix for prefix, slash, _ in names if slash)


def test_the_arms_have_one_torso_and_start_apart(tmp_path: Path) -> None:
    simulation = begun(tmp_path).simulation
    found = shaped(simulation.world)
    alone = shaped(begun(tmp_path, aside=2.0).simulation.world)
    assert found[LEFT] == found[RIGHT]
    # The torso's two shapes, two feet and the pedestal.
    assert found[TORSO] == 5
    assert alone[LEFT] == found[LEFT] + found[RIGHT] + found[TORSO]
    refuse_overlaps(simulation)
    tools = [simulation.data.site_xpos[robot.tool] for robot in simulation.robots.values()]
    assert [tool[1] for tool in tools] == pytest.approx([0.25, -0.25], abs=0.02)


def excluded(model: Any) -> set[frozenset[str]]:
    """Return the pairs of bodies whose contacts the engine ignores."""
    pairs = ((int(signature) >> 16, int(signature) & 0xFFFF) for signature in model.exclude_signature)
    return {frozenset(str(model.body(body).name) for body in pair) for pair in pairs}


def test_contacts_are_ignored_where_the_file_says_and_between_each_shoulder_and_what_carries_it(tmp_path: Path) -> None:
    found = excluded(begun(tmp_path).simulation.model)
    assert {frozenset((f"{TORSO}/torso", f"{arm}_column")) for arm in (f"{LEFT}/l", f"{RIGHT}/r")} <= found
    between_arms = {pair for pair in found if {name.partition("/")[0] for name in pair} == {LEFT, RIGHT}}
    assert between_arms == {frozenset((f"{LEFT}/l_hand", f"{RIGHT}/r_hand"))}
    of_torso = {name for pair in found if any(name.startswith(TORSO) for name in pair) for name in pair}
    assert not any("hand" in name or "wrist" in name for name in of_torso), of_torso


def test_each_arm_parks_on_its_own_side(tmp_path: Path) -> None:
    simulation = begun(tmp_path).simulation
    for name, side in ((LEFT, 1.0), (RIGHT, -1.0)):
        pose = parking_pose(simulation, simulation.robots[name])
        assert pose is not None
        assert side * frame_of(pose)[0][1] > 0.2
    assert [arm_of(robot.model).aside for robot in simulation.robots.values()] == pytest.approx([0.25, -0.25])


def test_an_arm_parks_away_from_the_others_shoulder_where_both_sides_are_free(tmp_path: Path) -> None:
    simulation = begun(tmp_path, beside=0.15).simulation
    left, right = simulation.robots.values()
    simulation.data.qpos[left.joints[0]] = 2.5  # Turned away, so that the right arm could park on either side.
    mujoco.mj_forward(simulation.model, simulation.data)
    pose = parking_pose(simulation, right)
    assert pose is not None
    assert frame_of(pose)[0][1] < -0.5


def test_the_same_arm_twice_overlaps(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="'env:left' and 'env:right' overlap by"):
        begun(tmp_path, ("l_hand", "l_hand"))


def test_each_arm_of_a_robot_may_get_a_gripper_from_another_file(tmp_path: Path) -> None:
    simulation = begun(tmp_path, flanges=("l_flange", "r_flange")).simulation
    refuse_overlaps(simulation)
    found = shaped(simulation.world)
    assert found[LEFT] == found[RIGHT]
    assert found[TORSO] == 5
    assert [robot.model.joints[0] for robot in simulation.robots.values()] == ["l_yaw", "r_yaw"]
    tools = [simulation.data.site_xpos[robot.tool] for robot in simulation.robots.values()]
    assert [tool[1] for tool in tools] == pytest.approx([0.25, -0.25], abs=0.02)


def test_robots_at_different_places_are_whole(tmp_path: Path) -> None:
    found = shaped(begun(tmp_path, aside=2.0).simulation.world)
    assert TORSO not in found
    assert found[LEFT] == found[RIGHT]


@pytest.mark.physics
def test_one_arm_carries_and_the_other_stays_clear(tmp_path: Path) -> None:
    run = begun(tmp_path, first=LEFT)
    trace = run.advance_until(lambda _: False)
    assert run.completed == 1, trace.remark
    moved = np.ptp(trace.positions[:, trace.column(RIGHT)], axis=0).max()
    assert moved < 0.5
    forces = run.simulation.forces.peaks(len(trace.times))
    assert (LEFT, RIGHT) not in forces
    assert not any(other.startswith(TORSO) for _, other in forces)


@pytest.mark.physics
def test_an_arm_that_hits_the_torso_touches_neither_arm(tmp_path: Path) -> None:
    simulation = begun(tmp_path).simulation
    robot = simulation.robots[LEFT]
    joints = simulation.joint_positions(robot).copy()
    joints[0] = 2.95  # Towards the post behind the arm.
    for _ in range(400):
        simulation.command(robot, joints, robot.model.gripper_open)
        simulation.tick()
    hit = {other for agent, other in simulation.forces.peaks(400) if agent == LEFT}
    assert any(other.startswith(f"{TORSO}/") for other in hit), hit


BAXTER = "cmeel.prefix/share/example-robot-data/robots/baxter_description/urdf/baxter.urdf"


@pytest.mark.physics
@pytest.mark.nightly
@pytest.mark.skipif(not FOLDER.is_dir(), reason="the arms of others are not here: make arms")
def test_one_arm_of_baxter_moves_what_the_other_one_has_put_down_as_often_as_the_page_says() -> None:
    places, origin = (link("x:g.torso.base", (-0.2, 0.0, 0.28)),), Origin(str(FOLDER / "cell.scenex"), 3, 7)
    arms = [
        ModelSource(
            f"x:{side}",
            "urdf",
            "file",
            BAXTER,
            bodies=(("x:g.torso", "torso"),),
            arm=ArmModel(tool=tool),
            origin=origin,
        )
        for side, tool in (("left", "left_gripper_base_link"), ("right", "right_gripper_base_link"))
    ]
    elements = tuple(Realisation(name, (model,)) for name, model in zip((LEFT, RIGHT), arms, strict=True))
    run = ExecutionSpec(
        "x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance(*places, elements=elements)
    )
    tray = "env:tray_ws"
    scene = SceneSpec(
        (CUBE, "env:bench", "env:tray", BIN),
        (LEFT, RIGHT),
        {"env:bench_ws": ("env:bench",), tray: ("env:tray",), BIN_WS: (BIN,)},
    )
    calls = [pick_place(CUBE, tray, RIGHT), pick_place(CUBE, BIN_WS, LEFT)]
    done = 0
    for seed in range(1, 6):
        execution = Execution(replace(scenario(scene, seed), execution=run), calls)
        trace = execution.advance_until(lambda _: False)
        done += execution.completed == 2 and (LEFT, RIGHT) not in execution.simulation.forces.peaks(len(trace.times))
    assert f"without touching each other in {done} of 5" in (ROOT / "docs/robots.md").read_text(encoding="utf-8")
