"""Files that would let a scenario pass that physics does not allow are refused, corrected with a word, or fail."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.catalog.executable import Friction, Implementation, ModelSource, Origin, Realisation, SceneInstance
from robbdd_tools.protocol.specs import ExecutionSpec
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.file_contents import changes_of
from robbdd_tools.world.robot_files import prepared_robot, robot_from
from world.arms import MJCF, URDF
from world.worlds import BIN_WS, CUBE, SCENE, pick_place, scenario

ARM = "env:own"
PART = """<mujoco><option gravity="0 0 0" timestep="0.05"><flag contact="disable"/></option><worldbody>
<body name="p" gravcomp="1"><freejoint/><geom type="box" size=".015 .015 .015" {0}/></body></worldbody></mujoco>"""
NO_PHYSICS = '<option gravity="0 0 0" timestep="0.05"><flag contact="disable" gravity="disable"/></option><default>'
PADS = 'friction="0.9 0.01 0.001"'
ROUGH = MJCF.replace(PADS, 'friction="100 1 1"')


def element(folder: Path, name: str, text: str) -> Realisation:
    file = "arm.urdf" if text.startswith("<robot") else f"{name.partition(':')[2]}.xml"
    (folder / file).write_text(text, encoding="utf-8")
    kind, origin = ("urdf" if file == "arm.urdf" else "mjcf"), Origin(str(folder / "cell.scenex"), 3, 7)
    return Realisation(name, (ModelSource(f"x:{folder.name}-{file}", kind, "file", file, origin=origin),))


def carrying(folder: Path, part: str, arm: str = MJCF, friction: float = 0.0) -> Execution:
    """Return the execution in which an arm from a file moves a part from a file into the bin."""
    instance = SceneInstance(
        "x:cell",
        elements=(element(folder, ARM, arm), element(folder, CUBE, part)),
        frictions=(Friction(ARM, CUBE, friction),) if friction else (),
    )
    spec = ExecutionSpec("x:run", "x:run", Implementation("x:own", "catalog", "pick-place"), instance)
    return Execution(replace(scenario(replace(SCENE, agents=(ARM,))), execution=spec), [pick_place(CUBE, BIN_WS, ARM)])


@pytest.mark.physics
@pytest.mark.parametrize(
    ("mass", "arm", "held"),
    [("1", MJCF, True), ("20", MJCF, False), ("20", MJCF.replace("<default>", NO_PHYSICS, 1), False)],
    ids=["light", "heavy", "heavy without physics"],
)
def test_options_and_weightlessness_of_files_change_nothing(tmp_path: Path, mass: str, arm: str, held: bool) -> None:
    run = carrying(tmp_path, PART.format(f'mass="{mass}"'), arm)
    assert run.simulation.model.opt.gravity.tolist() == [0.0, 0.0, -9.81]
    assert run.run_behaviour(0) == held
    assert (run.trace.remark == "") == held


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ('mass="1e-9"', "the object in cube1.xml weighs 1e-06 g; at least 1 g can be simulated: state the mass"),
        ('mass="0.00099"', "the object in cube1.xml weighs 0.99 g; at least 1 g"),
        ('mass="0.1" contype="0" conaffinity="0"', "the body 'p' has no collision shape"),
    ],
)
def test_a_part_that_cannot_be_simulated_as_its_file_says_is_refused(tmp_path: Path, part: str, words: str) -> None:
    with pytest.raises(SceneError, match=words) as error:
        carrying(tmp_path, PART.format(part))
    assert str(error.value).startswith("cell.scenex:3:7: ")


def test_the_smallest_mass_is_simulated(tmp_path: Path) -> None:
    model = carrying(tmp_path, PART.format('mass="0.001"')).simulation.model
    assert float(model.body(CUBE).mass[0]) == pytest.approx(0.001)


@pytest.mark.parametrize(
    ("part", "arm", "friction", "refused"),
    [("100", ROUGH, 0.0, True), ("2", ROUGH, 0.0, False), ("100", MJCF, 0.0, False), ("100", ROUGH, 0.8, False)],
    ids=["both", "rough pads only", "rough part only", "stated"],
)
def test_a_grip_with_a_friction_that_nothing_has_is_refused(
    tmp_path: Path, part: str, arm: str, friction: float, refused: bool
) -> None:
    text = PART.format(f'mass="0.1" friction="{part}"')
    if not refused:
        carrying(tmp_path, text, arm, friction)
        return
    with pytest.raises(SceneError, match="'env:own' and 'env:cube1' both give a friction of 100 or more; at most 2"):
        carrying(tmp_path, text, arm, friction)


@pytest.mark.parametrize("seen", [True, False])
def test_links_without_collision_shapes_collide_as_they_look(tmp_path: Path, seen: bool) -> None:
    link = '<geom type="capsule" size="0.04" fromto="0 0 0 0 0 0.4"/>'
    assert link in MJCF
    text = MJCF.replace(link, link.replace("/>", ' contype="0" conaffinity="0"/>')) if seen else MJCF
    found = robot_from(element(tmp_path, ARM, text).models[0], ARM)
    words = "links without collision shapes, which collide as their visual shapes: upper"
    assert changes_of(found.mjcf) == ((words,) if seen else ())
    spec = prepared_robot(found.mjcf)
    assert spec is not None
    assert all(geom.contype or geom.conaffinity for geom in spec.body("upper").geoms)


@pytest.mark.parametrize(("written", "used"), [("49", 49.0), ("1000000", 1.0)])
def test_a_speed_that_no_joint_has_stands_for_none(tmp_path: Path, written: str, used: float) -> None:
    source = element(tmp_path, ARM, URDF.replace('velocity="2"', f'velocity="{written}"')).models[0]
    assert robot_from(source, ARM).velocity_limits == (used,) * 5
