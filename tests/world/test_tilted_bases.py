"""Arms hang from ceilings, lean, and are fixed to walls: their tools point down all the same."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.api import Region
from robbdd_tools.catalog.executable import Implementation, ModelSource, Origin, Realisation, SceneInstance
from robbdd_tools.catalog.objects.table import TABLE
from robbdd_tools.protocol.specs import ExecutionSpec, SceneSpec
from robbdd_tools.world.arm_kinematics import arm_of
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.extent import centred
from robbdd_tools.world.fixed_faults import fixed_faults
from robbdd_tools.world.hanging_arms import is_hung
from robbdd_tools.world.home_posture import turn_down
from robbdd_tools.world.pose import Pose
from robbdd_tools.world.table_rise import rise_of
from robbdd_tools.world.tilted_base import UPRIGHT, Tilt, far_from_tables, rotation_of, tilt_of, upright_part
from world import strangers
from world.arms import MJCF
from world.arms_from_files import ARM, robot, source
from world.scene_instances import file, instance, link
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
    pose = Pose((1.0, 2.0, 1.234), 0.3, turn)
    (base, _), tilt = upright_part(pose), tilt_of(pose, 0.4)
    assert tilt is not None
    assert (base.position, base.rotation, tilt.height) == ((1.0, 2.0, 1.234), (), 0.83)
    assert abs(base.yaw) == pytest.approx(yaw)
    back = np.array(rotation_of(base.yaw, tilt.rotation))
    assert abs(back @ np.array(turn)) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("height", "rise", "expected"),
    [
        (0.15, 0.0, None),
        (0.83, 0.68, None),
        (0.49, 0.0, None),
        (0.0, 0.68, Tilt(UPRIGHT, -0.68)),
        (-0.65, 0.0, Tilt(UPRIGHT, -0.65)),
        (1.6, 0.8, Tilt(UPRIGHT, 0.8)),
    ],
)
def test_an_upright_base_far_from_the_tables_works_at_their_height(
    height: float, rise: float, expected: Tilt | None
) -> None:
    assert far_from_tables(Pose((0.0, 0.0, height)), rise) == expected


HUNG = strangers.SIX.replace('<body name="b0">', '<body name="b0" euler="180 0 0">')
"""An arm that hangs in its own file."""
COUNTER, COUNTER_WS = "env:counter", "env:counter_ws"


def above_counter(folder: Path, text: str, turn: tuple[float, ...], base: float) -> SceneInstance:
    """Return a cell in which an arm hangs above a counter whose top is 0.9 m above the world's origin."""
    (folder / "arm.xml").write_text(text, encoding="utf-8")
    origin = Origin(str(folder / "cell.scenex"), 3, 7)
    arm = ModelSource("x:arm", "mjcf", "file", "arm.xml", bodies=((FOOT, ""),), origin=origin)
    board = '<body name="counter"><geom type="box" size=".6 .6 .02" pos="0 0 -.02"/></body>'
    text = f"<mujoco><worldbody>{board}</worldbody></mujoco>"
    counter = file(folder, COUNTER, text, ("x:g.counter", "counter"))
    return instance(
        link(FRAME, (0.0, 0.0, base), turn=turn),
        link("x:g.counter.top", (0.2, 0.0, 0.9)),
        elements=(Realisation(ARM, (arm,), is_agent=True), counter),
    )


def carried(cell: SceneInstance) -> Execution:
    """Return the execution in which the arm above the counter picks up a cube and puts it down there."""
    scene = SceneSpec((CUBE, COUNTER), (ARM,), {COUNTER_WS: (COUNTER,)}, {}, places={CUBE: COUNTER_WS})
    run = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), cell)
    return Execution(replace(scenario(scene, 1), execution=run), [pick_place(CUBE, COUNTER_WS, ARM)])


@pytest.mark.physics
@pytest.mark.parametrize(
    ("text", "turn"), [(strangers.SIX, HANGING), (HUNG, (1.0, 0.0, 0.0, 0.0))], ids=["hung", "hangs in its file"]
)
def test_an_arm_hangs_above_a_counter_whose_world_begins_at_the_floor(
    tmp_path: Path, text: str, turn: tuple[float, ...]
) -> None:
    run = carried(above_counter(tmp_path, text, turn, 1.85))
    tool, axes = run.simulation.tool(run.simulation.robots[ARM])
    assert 0.9 + 0.1 < tool[2] < 0.9 + 0.7
    assert axes[2, 2] < -0.99, "the tool points down"
    names = [run.simulation.model.body(body).name for body in range(run.simulation.model.nbody)]
    assert not [name for name in names if name.endswith("column")]
    assert run.run_behaviour(0), run.trace.remark


def test_an_arm_that_hangs_in_its_file_has_a_home_below_its_base(tmp_path: Path) -> None:
    hanging, standing = (
        arm_of(robot(tmp_path, text, name=name)) for text, name in ((HUNG, "h.xml"), (strangers.SIX, "s.xml"))
    )
    for arm, below in ((hanging, True), (standing, False)):
        place, axes = arm.forward(arm.home)
        assert (place[2] < 0.0, arm.hangs) == (below, below)
        assert axes[2, 2] < -0.99


def test_a_robot_that_drives_stands_upright() -> None:
    placed = replace(catalog("mobile-panda"), bodies=((FOOT, "foot"),))
    cell = instance(link(FRAME, (0.0, 0.0, 1.0), turn=HANGING), elements=(Realisation(ARM, (placed,)),))
    with pytest.raises(SceneError, match="drives on the floor, so its base cannot be tilted"):
        build_world(replace(SCENE, agents=(ARM,)), 1, instance=cell)


def test_an_arm_above_a_high_counter_does_not_overlap_it_while_editing(tmp_path: Path) -> None:
    cell = above_counter(tmp_path, strangers.SIX, HANGING, 1.7)
    assert [str(fault) for fault in fixed_faults(cell)] == []


GANTRY = (
    """<robot name="gantry"><link name="beam"/>
<joint name="x" type="prismatic"><parent link="beam"/><child link="a"/><axis xyz="1 0 0"/>
<limit lower="-.4" upper=".6" effort="400" velocity="1"/></joint>
<joint name="y" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
<limit lower="-.5" upper=".5" effort="400" velocity="1"/></joint>
<joint name="z" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
<limit lower="-.6" upper="0" effort="400" velocity="1"/></joint>
<joint name="c" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0 0 -.3"/><axis xyz="0 0 1"/>
<limit lower="-3.1" upper="3.1" effort="20" velocity="3"/></joint>
<joint name="left" type="prismatic"><parent link="d"/><child link="l"/><axis xyz="0 1 0"/>
<limit lower="0" upper=".05" effort="40" velocity=".2"/></joint>
<joint name="right" type="prismatic"><parent link="d"/><child link="r"/><axis xyz="0 -1 0"/>
<limit lower="0" upper=".05" effort="40" velocity=".2"/><mimic joint="left"/></joint>"""
    + "".join(
        f'<link name="{name}"><inertial><mass value="{mass}"/>'
        '<inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/>'
        f'</inertial><collision><origin xyz="0 0 {down}"/><geometry><box size="{size}"/></geometry></collision></link>'
        for name, mass, down, size in (
            ("a", 5, 0.05, ".05 .9 .05"),
            ("b", 3, 0.05, ".1 .1 .1"),
            ("c", 2, -0.1, ".05 .05 .3"),
            ("d", 0.5, 0, ".04 .04 .02"),
            ("l", 0.1, -0.05, ".02 .01 .06"),
            ("r", 0.1, -0.05, ".02 .01 .06"),
        )
    )
    + "</robot>"
)


def test_nothing_stands_below_the_beam_of_a_gantry(tmp_path: Path) -> None:
    arm = arm_of(robot(tmp_path, GANTRY))
    assert arm.hangs
    assert arm.forward(arm.home)[0][2] < -0.2


def test_a_hanging_arm_that_does_not_reach_down_to_the_tables_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="cannot point its tool straight down"):
        carried(above_counter(tmp_path, strangers.SIX, HANGING, 3.5))


def test_an_arm_of_the_catalog_that_hangs_too_high_is_refused() -> None:
    placed = replace(catalog("franka-panda"), bodies=((FOOT, "foot"),))
    cell = instance(link(FRAME, (0.1, 0.1, 3.5), turn=HANGING), elements=(Realisation(ARM, (placed,)),))
    with pytest.raises(SceneError, match="cannot point its tool straight down"):
        build_world(replace(SCENE, agents=(ARM,)), 1, instance=cell)


@pytest.mark.parametrize(("second", "expected"), [(-0.2, True), (0.2, False), (0.0, False)])
def test_the_second_joint_of_a_hung_arm_is_below_its_base(second: float, expected: bool) -> None:
    """The first joint of some arms is in their base, whichever way they point."""
    text = f"""<mujoco><worldbody><body><joint axis="0 0 1"/><geom size=".05"/><body pos="0 0 {second}">
    <joint axis="0 1 0"/><geom size=".05"/></body></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    assert is_hung(data, (0, 1)) is expected
    assert is_hung(data, (0,)) is False


def test_the_largest_table_says_how_high_a_cell_is() -> None:
    large, small = Region((0.0, 0.0, 0.5), (0.5, 0.5, 0.1)), Region((0.0, 0.0, 0.3), (0.1, 0.2, 0.1))
    objects = {
        "large": replace(TABLE, region=large),
        "small": replace(TABLE, region=small),
        "loose": replace(TABLE, region=replace(large, half=(9.0, 9.0, 0.1)), free=True),
        "post": replace(TABLE, region=None),
    }
    poses = {name: Pose((0.0, 0.0, 0.3)) for name in objects}
    # The top of the large one is 0.3 m + 0.4 m high, and usual ones are 0.1 m high.
    assert rise_of(objects, poses.get) == pytest.approx(0.6)
    assert rise_of({**objects, "large": centred(objects["large"])}, poses.get) == pytest.approx(0.6)
    assert rise_of(objects, {"small": poses["small"]}.get) == pytest.approx(0.4)
    assert rise_of(objects, {"large": Pose((0.0, 0.0, -0.5))}.get) == 0.0
    assert rise_of(objects, lambda _: None) == 0.0


@pytest.mark.parametrize("seed", range(8))
def test_the_step_towards_a_tool_that_points_down_is_about_the_shortest_rotation(seed: int) -> None:
    matrix, quaternion, turned = np.zeros(9), np.zeros(4), np.zeros(3)
    drawn = np.random.default_rng(seed).normal(size=4)
    mujoco.mju_quat2Mat(matrix, drawn / np.linalg.norm(drawn))
    step, angle = turn_down(matrix.reshape(3, 3), None), float(np.arccos(-matrix[8]))
    length = float(np.linalg.norm(step))
    assert length == pytest.approx(angle if matrix[8] > 0 else np.sin(angle))
    mujoco.mju_axisAngle2Quat(quaternion, step / length, angle)
    mujoco.mju_rotVecQuat(turned, matrix[2::3], quaternion)
    assert turned == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)
