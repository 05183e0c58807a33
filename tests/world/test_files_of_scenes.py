"""Files that hold more than one arm: heads, second arms, loose objects and what only another program would use."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robbdd_tools.catalog.api import RobotModel
from robbdd_tools.catalog.executable import ArmModel, Body, Link, ModelSource, Origin, Realisation, SceneInstance
from robbdd_tools.protocol.specs import SceneSpec
from robbdd_tools.world.composition import World, build_world
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.robot_files import prepared_robot, robot_from
from robbdd_tools.world.robot_report import report
from robbdd_tools.world.simulation import Simulation
from world.arms import MJCF, URDF

ARM = "env:own"
FIVE = ("yaw", "shoulder", "elbow", "pitch", "roll")
HEAD = """<body name="neck" pos="0 0 0.3"><joint name="pan" axis="0 0 1"/><geom size="0.02"/>
  <body name="head" pos="0 0 0.1"><joint name="nod" axis="0 1 0" damping="1"/><geom size="0.03"/></body></body>"""
WITH_HEAD = MJCF.replace('<body name="column">', f'{HEAD}<body name="column">').replace(
    "<actuator>", '<actuator><position name="look" joint="pan" kp="10"/>'
)
SCENE = """<light name="lamp" pos="0 0 3" mode="targetbody" target="cube"/>
<body name="cube" pos="0.5 0 0.02"><freejoint/><geom type="box" size="0.02 0.02 0.02"/></body>
<body name="desk" pos="0.5 0 -0.1"><geom type="box" size="0.3 0.3 0.05"/></body>
<body name="marker" mocap="true"><geom size="0.01" contype="0" conaffinity="0"/></body></worldbody>"""
AROUND = MJCF.replace("</worldbody>", SCENE).replace("<equality>", '<equality><weld body1="marker" body2="hand"/>')


def source(folder: Path, text: str, arm: ArmModel | None = None) -> ModelSource:
    name = "arm.urdf" if text.startswith("<robot") else "arm.xml"
    (folder / name).write_text(text, encoding="utf-8")
    iri, origin = f"x:{folder.name}", Origin(str(folder / "cell.scenex"), 3, 7)
    return ModelSource(iri, "urdf", "file", name, arm=arm, origin=origin)


def robot(folder: Path, text: str, arm: ArmModel | None = None) -> RobotModel:
    return robot_from(source(folder, text, arm), ARM)


def placed(folder: Path, text: str, height: float, body: str = "") -> World:
    """Return the world in which the base of an arm, or the ``body`` of its file, is at a height (m)."""
    model = replace(source(folder, text), bodies=(("x:own", body),))
    instance = SceneInstance(
        "x:cell",
        elements=(Realisation(ARM, (model,)),),
        bodies=(Body("x:room", ("x:root",)), Body("x:own", ("x:foot",))),
        links=(Link("x:foot", "x:root", "pose", (0.0, 0.0, height), (1.0, 0.0, 0.0, 0.0)),),
        anchor="x:root",
    )
    return build_world(SceneSpec((), (ARM,), {}), 1, ARM, instance)


def two_arms(text: str = MJCF) -> str:
    """Return a file with two arms side by side, whose names have the prefixes a_ and b_."""
    both = mujoco.MjSpec()
    for prefix, aside in (("a_", 0.0), ("b_", 0.6)):
        frame = both.worldbody.add_frame(pos=[0.0, aside, 0.0])
        both.attach(mujoco.MjSpec.from_string(text), prefix=prefix, frame=frame)
    both.compile()
    return str(both.to_xml())


def test_a_head_beside_the_arm_is_fixed_and_reported(tmp_path: Path) -> None:
    found = robot(tmp_path, WITH_HEAD)
    assert found.joints == FIVE
    assert changes_of(found.mjcf) == ("joints beside the arm, fixed: pan, nod",)
    left = prepared_robot(found.mjcf)
    assert left is not None
    model = left.compile()
    joints = {str(model.joint(number).name) for number in range(model.njnt)}
    assert joints == {*FIVE, "left_slide", "right_slide"}
    assert model.nu == 6  # The actuator of the head is gone.
    assert model.body("head").id > 0  # It still stands in the way.


def test_the_report_says_what_is_fixed(tmp_path: Path) -> None:
    model = source(tmp_path, WITH_HEAD)
    instance = SceneInstance("x:cell", elements=(Realisation(ARM, (model,)),))
    simulation = Simulation(build_world(SceneSpec((), (ARM,), {}), 1, ARM, instance))
    assert "joints beside the arm, fixed: pan, nod" in list(report(simulation, ARM, model))


def test_of_two_arms_the_tool_says_which_is_meant(tmp_path: Path) -> None:
    text = two_arms()
    with pytest.raises(SceneError) as error:
        robot(tmp_path, text)
    assert str(error.value).startswith("cell.scenex:3:7: arm.xml has 2 arms, with the hands 'a_hand', 'b_hand': name a")
    found = robot(tmp_path, text, ArmModel(tool="b_hand"))
    assert found.joints == tuple(f"b_{joint}" for joint in FIVE)
    assert found.gripper_actuator == "b_grip"
    assert "a_left_slide" in changes_of(found.mjcf)[0]


def test_a_key_frame_of_two_arms_gives_the_home_of_each(tmp_path: Path) -> None:
    postures = {"a": "0.1 .2 1.6 1.3416 0 .04 .04", "b": "-.1 .2 1.6 1.3416 0 .04 .04"}
    key = (
        f'<keyframe><key name="home" qpos="{postures["a"]} {postures["b"]}" ctrl="{" ".join(["0"] * 12)}"/></keyframe>'
    )
    text = two_arms().replace("</mujoco>", f"{key}</mujoco>")
    for arm, turn in (("a", 0.1), ("b", -0.1)):
        found = robot(tmp_path, text, ArmModel(tool=f"{arm}_hand"))
        assert found.home == pytest.approx((turn, 0.2, 1.6, 1.3416, 0.0))


def test_the_palm_as_a_tool_only_says_which_hand_is_meant(tmp_path: Path) -> None:
    found, stated = robot(tmp_path, MJCF), robot(tmp_path, MJCF, ArmModel(tool="hand"))
    places = [np.array(prepared_robot(one.mjcf).site(one.tool_site).pos) for one in (found, stated)]  # pyright: ignore[reportOptionalMemberAccess]
    assert places[1] == pytest.approx(places[0])
    assert places[1][2] > 0.09  # Between the tips of the fingers, which are 0.1 m ahead of the palm.


def test_loose_and_commanded_things_around_the_arm_in_the_file_of_a_scene_are_left_out(tmp_path: Path) -> None:
    found = robot(tmp_path, AROUND)
    assert found.joints == FIVE
    left = prepared_robot(found.mjcf)
    assert left is not None
    assert changes_of(found.mjcf) == (
        "bodies that another program would move (mocap), left out: marker",
        "loose objects, left out: cube",
    )
    assert left.body("desk") is not None  # The arm can collide with it.
    model = left.compile()
    assert (model.nmocap, model.nlight) == (0, 0)
    assert model.neq == 1  # Only the fingers are coupled; nothing holds the hand.


def test_an_arm_on_a_floating_base_is_still_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="has a free joint 'joint0'"):
        robot(tmp_path, MJCF.replace('<body name="foot">', '<body name="foot"><freejoint/>'))


@pytest.mark.parametrize(("damping", "count"), [("99999", 5), ("100000", 4)])
def test_a_joint_that_its_author_has_locked_by_damping_is_fixed(tmp_path: Path, damping: str, count: int) -> None:
    text = MJCF.replace('name="yaw" axis="0 0 1"', f'name="yaw" axis="0 0 1" damping="{damping}"')
    home = (0.0, 0.2, 1.6, 1.3416, 0.0)[5 - count :]
    assert len(robot(tmp_path, text, ArmModel(home=home)).joints) == count


def test_moving_links_without_a_mass_get_a_small_one(tmp_path: Path) -> None:
    begin = URDF.index('<link name="column">')
    end = URDF.index("</inertial>", begin) + len("</inertial>")
    found = robot(tmp_path, URDF[:begin] + '<link name="column">' + URDF[end:])
    assert found.joints == FIVE
    assert "moving links without a mass, which got 1 g: column" in changes_of(found.mjcf)


def test_a_palm_whose_frame_is_between_its_fingers_still_points_outwards(tmp_path: Path) -> None:
    """The frame of the hand is moved to the fingers; nothing else changes."""
    moved = MJCF.replace('name="hand" pos="0 0 0.08"', 'name="hand" pos="0 0.005 0.18"')
    for old, new in (
        ('pos="0 0 0.015"/>\n                <site', 'pos="0 -0.005 -0.085"/>\n                <site'),
        ('name="left" pos="0 0.004 0.1"', 'name="left" pos="0.004 -0.001 0"'),
        ('name="right" pos="0 -0.004 0.1"', 'name="right" pos="0.004 -0.009 0"'),
    ):
        assert old in moved
        moved = moved.replace(old, new)
    found = robot(tmp_path, moved)
    left = prepared_robot(found.mjcf)
    assert left is not None
    model = left.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    hand, tool = data.body("hand").xmat.reshape(3, 3), data.site(found.tool_site).xmat.reshape(3, 3)
    assert (hand.T @ tool)[2, 2] > 0.99


def test_an_arm_that_stands_on_the_floor_needs_no_pedestal(tmp_path: Path) -> None:
    world = placed(tmp_path, MJCF, -0.65)
    names = [str(world.model.body(number).name) for number in range(world.model.nbody)]
    assert not any("column" in name and "robbdd" in name for name in names)
    tool = Simulation(world).robots[ARM]
    assert tool.model.joints == FIVE


def test_the_arm_stands_where_the_scene_maps_a_body_of_its_file(tmp_path: Path) -> None:
    text = MJCF.replace('<body name="foot">', '<body name="foot" pos="0.3 0.2 0.1" quat="0.7071068 0 0 0.7071068">')
    data = Simulation(placed(tmp_path, text, 0.15, "foot")).data
    assert data.body(f"{ARM}/foot").xpos == pytest.approx([0.0, 0.0, 0.15])
    assert data.body(f"{ARM}/foot").xmat == pytest.approx(np.eye(3).ravel(), abs=1e-6)
    data = Simulation(placed(tmp_path, text, 0.15)).data
    assert data.body(f"{ARM}/foot").xpos == pytest.approx([0.3, 0.2, 0.25])


def test_a_part_that_other_files_include_is_no_model(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"arm\.xml cannot be read: it is a part that other files include"):
        robot(tmp_path, f"<mujocoinclude>{MJCF[MJCF.index('<worldbody') :].replace('</mujoco>', '')}</mujocoinclude>")
