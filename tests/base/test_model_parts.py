"""The named parts of MJCF and URDF files, read from their text, are those that the engine finds."""

from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES, ROOT
from robbdd_tools.base.limits import SOURCE_SIZE
from robbdd_tools.base.model_part import ModelPart
from robbdd_tools.base.model_parts import model_parts
from robbdd_tools.world.engine import mujoco

GANTRY = """<mujoco model="gantry">
  <default>
    <joint range="-90 90"/>
    <default class="arm">
      <joint axis="0 1 0"/>
      <default class="wrist"><joint range="-10 20"/></default>
      <default class="rail"><joint type="slide" range="0 0.4"/></default>
    </default>
  </default>
  <include file="parts/hand.xml"/>
  <worldbody>
    <body name="base" childclass="arm">
      <joint name="run" class="rail"/>
      <geom size=".1"/>
      <frame name="side" pos="0 1 0">
        <body name="elbow" pos="0 0 .3">
          <joint name="bend"/>
          <joint name="turn" class="wrist"/>
          <inertial mass="2.5" pos="0 0 0" diaginertia="1 1 1"/>
          <geom name="shell" type="capsule" fromto="0 0 0 0 0 .2" size=".1"/>
        </body>
      </frame>
    </body>
  </worldbody>
</mujoco>
"""
HAND = """<mujocoinclude>
  <!-- größe -->
  <worldbody>
    <body name="hand"><freejoint name="fly"/>
      <geom name="pad_ä" type="box" size="1 1 1"/><site name="tip" pos="0 0 .1"/>
    </body>
  </worldbody>
  <actuator><position name="close" joint="bend" ctrlrange="0 1"/></actuator>
</mujocoinclude>
"""
CART = """<robot name="cart">
  <link name="world"/>
  <link name="chassis">
    <inertial><mass value="4"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision name="hull"><geometry><mesh filename="package://cart_description/meshes/hull.stl"/></geometry></collision>
  </link>
  <link name="mast"><inertial><mass value="0.5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision name="pole"><geometry><box size="1 1 1"/></geometry></collision></link>
  <joint name="mount" type="fixed"><parent link="world"/><child link="chassis"/></joint>
  <joint name="lift" type="prismatic"><parent link="chassis"/><child link="mast"/>
    <limit lower="0" upper="0.6" velocity="0.2" effort="90"/></joint>
</robot>
"""


def gantry(folder: Path) -> Path:
    (folder / "parts").mkdir()
    (folder / "parts" / "hand.xml").write_text(HAND, encoding="utf-8")
    (folder / "gantry.xml").write_text(GANTRY, encoding="utf-8")
    return folder / "gantry.xml"


def part(path: Path, kind: str, name: str) -> ModelPart:
    found = model_parts(path).find(name, kind)
    assert found is not None
    return found


@pytest.mark.parametrize(
    "path",
    [EXAMPLES / "ownrobot" / "five.xml", *sorted((ROOT / "server/robbdd_tools/catalog/robots").glob("*.xml")), None],
    ids=lambda path: path.stem if path else "nested classes and includes",
)
def test_the_engine_finds_the_same_names_and_limits(tmp_path: Path, path: Path | None) -> None:
    path = path or gantry(tmp_path)
    spec: Any = mujoco.MjSpec.from_file(str(path))
    parts = model_parts(path)
    engine = {
        "body": spec.bodies[1:],
        "joint": spec.joints,
        "site": spec.sites,
        "geom": spec.geoms,
        "actuator": spec.actuators,
    }
    for kind, things in engine.items():
        read, built = ({one.name for one in named if one.name} for named in (parts.names(kind), things))
        # Names of attached models are not in the text, and no name is reported as wrong then.
        assert read == built if parts.is_complete else read <= built, kind
    model: Any = spec.compile()
    for joint in parts.names("joint"):
        stated = next((fact for fact in joint.facts if fact.startswith("range ")), None)
        low, high = model.joint(joint.name).range
        if stated is not None:
            _, first, _, second, unit = stated.split()
            factor = 3.141592653589793 / 180 if unit == "deg" else 1.0
            assert [float(first) * factor, float(second) * factor] == pytest.approx([low, high], rel=1e-5, abs=1e-6)
    masses = {one.name: fact for one in parts.names("body") for fact in one.facts if fact.endswith(" kg")}
    for name, fact in masses.items():
        assert float(fact.split()[1]) == pytest.approx(float(model.body(name).mass[0]), rel=1e-5)


def test_facts_have_the_values_of_nested_default_classes(tmp_path: Path) -> None:
    path = gantry(tmp_path)
    assert part(path, "joint", "turn").facts == ("hinge", "axis (0, 1, 0)", "range -10 to 20 deg")
    assert part(path, "joint", "bend").facts == ("hinge", "axis (0, 1, 0)", "range -90 to 90 deg")
    assert part(path, "joint", "run").facts == ("slide", "axis (0, 1, 0)", "range 0 to 0.4 m")
    assert part(path, "body", "elbow").facts == ("mass 2.5 kg", "at (0, 0, 0.3) m in a frame in the body 'base'")
    assert part(path, "site", "tip").facts == ("at (0, 0, 0.1) m in the body 'hand'",)
    assert part(path, "actuator", "close").facts == ("acts on the joint 'bend'", "control from 0 to 1")


def test_an_included_part_is_in_its_own_file(tmp_path: Path) -> None:
    found = part(gantry(tmp_path), "geom", "pad_ä")
    assert found.path.name == "hand.xml"
    assert HAND[found.start :].startswith('<geom name="pad_ä"')
    assert HAND[part(tmp_path / "gantry.xml", "site", "tip").start :].startswith('<site name="tip"')


def test_links_of_urdf_are_bodies_without_the_world(tmp_path: Path) -> None:
    path = tmp_path / "cart.urdf"
    path.write_text(CART, encoding="utf-8")
    parts = model_parts(path)
    assert [one.name for one in parts.names("body", "geom")] == ["chassis", "mast", "hull", "pole"]
    assert part(path, "joint", "lift").facts == (
        "prismatic",
        "from the link 'chassis' to the link 'mast'",
        "range 0 to 0.6 m",
        "velocity up to 0.2 m/s",
        "effort up to 90 N",
    )
    assert part(path, "body", "chassis").facts == ("mass 4 kg",)
    mesh = "package://cart_description/meshes/hull.stl"
    assert parts.missing == (f"the collision mesh '{mesh}' of the link 'chassis' is not on this machine",)
    (tmp_path / "cart_description" / "meshes").mkdir(parents=True)
    (tmp_path / "cart_description" / "meshes" / "hull.stl").write_bytes(b"")
    path.write_text(CART + "\n", encoding="utf-8")
    assert model_parts(path).missing == ()


def test_a_changed_included_file_is_read_again(tmp_path: Path) -> None:
    path = gantry(tmp_path)
    assert model_parts(path).find("tip", "site") is not None
    (tmp_path / "parts" / "hand.xml").write_text(HAND.replace('"tip"', '"point"'), encoding="utf-8")
    assert model_parts(path).find("tip", "site") is None
    (tmp_path / "parts" / "hand.xml").unlink()
    assert model_parts(path).problem.endswith("includes 'parts/hand.xml', which does not exist")
    (tmp_path / "parts" / "hand.xml").write_text(HAND, encoding="utf-8")
    assert model_parts(path).find("tip", "site") is not None


@pytest.mark.parametrize("tag", ['<replicate count="2">', '<attach model="m" body="b" prefix="p_"/>'])
def test_names_that_are_not_in_the_text_may_exist(tmp_path: Path, tag: str) -> None:
    path = tmp_path / "many.xml"
    close = "" if tag.endswith("/>") else "</replicate>"
    path.write_text(f"<mujoco><worldbody>{tag}{close}</worldbody></mujoco>", encoding="utf-8")
    assert model_parts(path).may_have("anything", "body")


def test_a_run_names_unnamed_parts(tmp_path: Path) -> None:
    path = tmp_path / "plain.xml"
    path.write_text('<mujoco><worldbody><body><joint name="j"/></body></worldbody></mujoco>', encoding="utf-8")
    parts = model_parts(path)
    assert parts.may_have("part0", "body")
    assert not parts.may_have("joint0", "joint")
    assert not parts.may_have("palm", "body")


LAUGHS = '<!DOCTYPE m [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]><mujoco>&b;</mujoco>'


@pytest.mark.parametrize(
    ("files", "problem"),
    [
        ({"a.xml": "<mujoco><worldbody></mujoco>"}, "line 1 of 'a.xml' is not XML: mismatched tag"),
        ({"a.xml": ""}, "line 1 of 'a.xml' is not XML: no element found"),
        ({"a.xml": "<sdf/>"}, "'a.xml' has the root element <sdf>, not <mujoco> or <robot>"),
        ({"a.xml": LAUGHS}, "'a.xml' declares entities, which are not read"),
        ({"a.xml": '<mujoco>\n<include file="b.xml"/></mujoco>'}, "line 2 of 'a.xml' includes 'b.xml', which does not"),
        ({"a.xml": '<mujoco><include file="a.xml"/></mujoco>'}, "line 1 of 'a.xml' includes 'a.xml' a second time"),
        (
            {"a.xml": '<mujoco><include file="b.xml"/></mujoco>', "b.xml": '<m><include file="./a.xml"/></m>'},
            "line 1 of 'b.xml' includes './a.xml' a second time",
        ),
        ({"a.xml": '<robot xmlns:xacro="x"><xacro:include filename="b"/></robot>'}, "'a.xml' is a xacro file: expand"),
        ({"a.xml": f"<mujoco>{' ' * SOURCE_SIZE.default}</mujoco>"}, "'a.xml' has 1.0 MiB; the limit is 1 MiB"),
        (
            {
                "a.xml": '<mujoco><include file="b.xml"/></mujoco>',
                "b.xml": f"<m>{' ' * (SOURCE_SIZE.default - 10)}</m>",
            },
            "the model and the files that it includes are larger than 1 MiB: see ROBBDD_LIMIT_SOURCE_SIZE",
        ),
        (
            {f"{name}.xml": f'<mujoco><include file="{name + 1}.xml"/></mujoco>' for name in range(40)}
            | {"a.xml": '<mujoco><include file="0.xml"/></mujoco>'},
            "line 1 of '31.xml' includes '32.xml': it includes more than 256 files, or nests them too deeply",
        ),
    ],
    ids=lambda value: value[:40] if isinstance(value, str) else "",
)
def test_a_hostile_or_broken_file_has_a_reason(tmp_path: Path, files: dict[str, str], problem: str) -> None:
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    found = model_parts(tmp_path / "a.xml")
    assert found.problem.startswith(problem)
    assert found.parts == ()


def test_deep_nesting_is_read(tmp_path: Path) -> None:
    path = tmp_path / "deep.xml"
    depth = 20_000
    path.write_text(f"<mujoco><worldbody>{'<body>' * depth}{'</body>' * depth}</worldbody></mujoco>", encoding="utf-8")
    assert len(model_parts(path).parts) == depth
