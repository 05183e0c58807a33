"""Objects from files keep the shapes, the friction and the distribution of mass that their files give them."""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robbdd_tools.agent.execution import Execution
from robbdd_tools.base.solid_shapes import SolidKind
from robbdd_tools.catalog.api import ObjectModel
from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.protocol.specs import ConfigSpec, ExecutionSpec
from robbdd_tools.world.composition import build_world
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from world.scene_instances import catalog, file, instance, link
from world.worlds import BIN, CUBE, SCENE, scenario

CORNERS = " ".join(f"{0.02 * cos(k):.5f} {0.02 * sin(k):.5f} -.01" for k in range(6))
CONE = f'<asset><mesh name="cone" vertex="{CORNERS} 0 0 .03 0 .001 0"/></asset>'


OURS = Implementation("x:own", "catalog", "pick-place")


def text(geoms: str, before: str = "", joint: str = "<freejoint/>", inside: str = "") -> str:
    body = f'<body name="thing">{joint}{inside}{geoms}</body>'
    return f'<mujoco><compiler angle="degree"/>{before}<worldbody>{body}</worldbody></mujoco>'


def staged(folder: Path, geoms: str, before: str = "", inside: str = "") -> tuple[ObjectModel, Any]:
    """Return an object that consists of some geoms, and the compiled world."""
    thing = file(folder, CUBE, text(geoms, before, inside=inside), ("x:g.thing", "thing"))
    world = build_world(SCENE, 1, instance=instance(link("x:g.thing.mid", (0.45, 0.1, 0.3)), elements=(thing,)))
    return world.cast.objects[CUBE], world.model


@pytest.mark.parametrize(
    ("geom", "kind", "half"),
    [
        ('<geom type="capsule" size=".01 .03" euler="0 90 0"/>', SolidKind.CAPSULE, (0.04, 0.01, 0.01)),
        ('<geom type="cylinder" size=".01 .03" euler="0 90 0"/>', SolidKind.CYLINDER, (0.03, 0.01, 0.01)),
        ('<geom type="ellipsoid" size=".01 .02 .03" euler="0 0 90"/>', SolidKind.ELLIPSOID, (0.02, 0.01, 0.03)),
        (
            '<geom type="box" size=".03 .01 .02" euler="0 0 45"/>',
            SolidKind.BOX,
            (0.04 / 2**0.5, 0.04 / 2**0.5, 0.02),
        ),
    ],
)
def test_a_shape_that_is_not_aligned_is_no_box(
    tmp_path: Path, geom: str, kind: SolidKind, half: tuple[float, ...]
) -> None:
    model, world = staged(tmp_path, geom)
    (shape,) = model.shapes
    assert shape.solid is not None
    assert shape.solid.kind is kind
    assert shape.size == pytest.approx(half, abs=1e-6)
    alone = mujoco.MjModel.from_xml_string(text(geom))
    number = world.geom(f"{CUBE}/shape0").id
    assert world.geom_type[number] == alone.geom_type[0]
    assert world.geom_size[number] == pytest.approx(alone.geom_size[0])
    assert abs(world.geom_quat[number] @ alone.geom_quat[0]) == pytest.approx(1.0)
    assert sorted(world.body(CUBE).inertia) == pytest.approx(sorted(alone.body_inertia[1]), rel=1e-3)


def test_a_mesh_is_its_hull(tmp_path: Path) -> None:
    model, world = staged(tmp_path, '<geom type="mesh" mesh="cone" mass=".1"/>', CONE)
    (shape,) = model.shapes
    assert shape.solid is not None
    assert len(shape.solid.vertices) == 7, "a vertex inside the hull is left out"
    assert shape.size[2] == pytest.approx(0.02)
    geom = world.geom(f"{CUBE}/shape0")
    assert geom.type == mujoco.mjtGeom.mjGEOM_MESH
    data = mujoco.MjData(world)
    mujoco.mj_kinematics(world, data)
    turn = data.geom_xmat[geom.id].reshape(3, 3)
    placed = data.geom_xpos[geom.id] + world.mesh_vert @ turn.T - data.body(CUBE).xpos
    assert placed.max(axis=0) == pytest.approx(np.array(shape.position) + shape.size, abs=1e-6)
    assert world.body(CUBE).mass == pytest.approx(0.1)


def test_the_mass_is_where_the_file_has_it(tmp_path: Path) -> None:
    hammer = '<inertial pos=".05 0 0" mass=".4" diaginertia="1e-4 3e-4 2e-4"/>'
    model, world = staged(tmp_path, '<geom type="box" size=".08 .01 .01" pos=".02 0 0"/>', inside=hammer)
    assert model.inertia is not None
    assert model.inertia.center == pytest.approx((0.03, 0.0, 0.0)), "from the middle of its geometry"
    body = world.body(CUBE)
    assert (body.mass, body.ipos) == (pytest.approx(0.4), pytest.approx([0.03, 0.0, 0.0]))
    assert sorted(body.inertia) == pytest.approx([1e-4, 2e-4, 3e-4])


def test_an_even_mass_needs_no_more_than_the_shapes(tmp_path: Path) -> None:
    even = '<geom type="box" size=".02 .01 .03" mass=".2"/><geom type="sphere" size=".01" pos="0 0 .04" mass="{}"/>'
    share = 0.2 * (4 / 3 * np.pi * 1e-6) / (8 * 6e-6)
    assert staged(tmp_path, even.format(share))[0].inertia is None
    other = tmp_path / "other"
    other.mkdir()
    assert staged(other, even.format(0.2))[0].inertia is not None, "a heavy ball on a light box"


TWO = (
    '<geom type="box" size=".02 .02 .01" friction=".8" rgba="0 1 0 1"/>'
    '<geom type="box" size=".02 .02 .01" pos="0 0 .02" friction=".05" rgba="1 0 0 1"/>'
)


def test_each_shape_has_its_friction_and_colour(tmp_path: Path) -> None:
    _, world = staged(tmp_path, TWO)
    first, second = (world.geom(f"{CUBE}/shape{number}") for number in range(2))
    assert (first.friction[0], second.friction[0]) == (pytest.approx(0.8), pytest.approx(0.05))
    assert (first.rgba.tolist(), second.rgba.tolist()) == ([0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0])


def test_a_configured_friction_is_that_of_all_shapes(tmp_path: Path) -> None:
    thing = file(tmp_path, CUBE, text(TWO), ("x:g.thing", "thing"))
    slippery = replace(SCENE, config=(ConfigSpec(CUBE, "friction", "0.3"),))
    world = build_world(slippery, 1, instance=instance(link("x:g.thing.mid", (0.45, 0.1, 0.3)), elements=(thing,)))
    assert [world.model.geom(f"{CUBE}/shape{number}").friction[0] for number in range(2)] == pytest.approx([0.3, 0.3])


TUB = text(
    '<geom type="box" size=".1 .1 .004"/><geom type="box" size=".1 .004 .05" pos="0 .12 .05" euler="-20 0 0"/>'
    '<site name="workspace" type="box" size=".09 .09 .04" pos="0 0 .05"/>'
)


def test_slanted_walls_are_not_stretched(tmp_path: Path) -> None:
    tub = file(tmp_path, BIN, TUB, ("x:g.tub", "thing"))
    taller = replace(SCENE, config=(ConfigSpec(BIN, "height_scale", "1.5"),))
    with pytest.raises(SceneError, match="has no height_scale"):
        build_world(taller, 1, instance=instance(link("x:g.tub.mid", (0.45, 0.4, 0.1)), elements=(tub,)))


RAMP = text('<geom type="box" size=".2 .2 .01" euler="0 35 0" friction=".1"/>', joint="")


@pytest.mark.physics
def test_a_part_slides_down_a_ramp(tmp_path: Path) -> None:
    """On the box around the ramp, it would lie still."""
    ramp = file(tmp_path, "env:ramp", RAMP, ("x:g.ramp", "thing"))
    cell = instance(
        link("x:g.ramp.mid", (0.5, 0.0, 0.25)),
        link("x:g.cube.mid", (0.4, 0.0, 0.36)),
        elements=(ramp, catalog(CUBE, "cube", "x:g.cube")),
    )
    spec = scenario(replace(SCENE, objects=(*SCENE.objects, "env:ramp")))
    run = Execution(replace(spec, execution=ExecutionSpec("x:run", "x:run", OURS, cell)), [])
    assert run.simulation.pose(CUBE)[0][0] > 0.6


@pytest.mark.physics
def test_a_part_with_a_heavy_end_tips_over(tmp_path: Path) -> None:
    """Its centre of mass is beyond its foot."""
    heavy = '<inertial pos=".02 0 .04" mass=".3" diaginertia="1e-4 1e-4 1e-4"/>'
    geoms = '<geom type="box" size=".01 .01 .05" pos="0 0 .05"/>'
    thing = file(tmp_path, CUBE, text(geoms, inside=heavy), ("x:g.thing", "thing"))
    cell = instance(link("x:g.thing.mid", (0.45, 0.1, 0.1005)), elements=(thing,))
    run = Execution(replace(scenario(), execution=ExecutionSpec("x:run", "x:run", OURS, cell)), [])
    assert run.simulation.pose(CUBE)[1][2, 2] < 0.5
