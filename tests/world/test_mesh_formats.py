"""Collision meshes in formats that the engine does not read are converted; what cannot be read is reported."""

from __future__ import annotations

import struct
import sys
from pathlib import Path

import pytest

from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.mesh_formats import UnreadableMesh, as_stl, is_readable
from robbdd_tools.world.urdf_files import impossible_inertias, read_urdf

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)]
FACES = [
    *[(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)],
    *[(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)],
]
NUMBERS = " ".join(str(number) for corner in CORNERS for number in corner)
INDICES = " ".join(str(number) for face in FACES for number in face)
DAE = f"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="box"><mesh>
<source id="box-p"><float_array id="box-a" count="24">{NUMBERS}</float_array><technique_common>
<accessor source="#box-a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="box-v"><input semantic="POSITION" source="#box-p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#box-v" offset="0"/><p>{INDICES}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#box"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
PLY = "\n".join(
    [
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z",
        "element face 12\nproperty list uchar int vertex_indices\nend_header",
        *(" ".join(map(str, corner)) for corner in CORNERS),
        *(f"3 {a} {b} {c}" for a, b, c in FACES),
        "",
    ]
)
STL = "\n".join(
    [
        "solid box",
        *(
            "facet normal 0 0 0\nouter loop\n"
            + "\n".join("vertex {} {} {}".format(*CORNERS[corner]) for corner in face)
            + "\nendloop\nendfacet"
            for face in FACES
        ),
        "endsolid box\n",
    ]
)


def _written(folder: Path, name: str, text: str) -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def urdf(folder: Path, name: str, text: str, kind: str = "collision", scale: str = "1 1 1") -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    path = folder / "box.urdf"
    shape = f'<geometry><mesh filename="{name}" scale="{scale}"/></geometry>'
    path.write_text(f'<robot name="r"><link name="box"><{kind}>{shape}</{kind}></link></robot>', encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("name", "text", "unit"),
    [("box.dae", DAE, 0.01), ("box.ply", PLY, 1.0), ("box.stl", STL, 1.0), ("b.DAE", DAE, 0.01)],
)
def test_the_unit_of_a_mesh_counts_and_its_vertical_does_not(tmp_path: Path, name: str, text: str, unit: float) -> None:
    model = read_urdf(urdf(tmp_path, name, text, scale="2 2 2")).copy().compile()
    (mesh,) = range(model.nmesh)
    low, high = model.mesh_vert.min(axis=0), model.mesh_vert.max(axis=0)
    sides = sorted((high - low).tolist())
    assert sides == pytest.approx([2 * unit * side for side in (1.0, 2.0, 3.0)], rel=1e-5)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    corner = data.geom_xpos[0] + data.geom_xmat[0].reshape(3, 3) @ model.mesh_vert[mesh]
    # A corner is at 0 or at a side along each axis of the link: nothing was turned.
    assert all(
        min(abs(place), abs(place - 2 * unit * side)) < 1e-5 for place, side in zip(corner, (1, 2, 3), strict=True)
    )


def test_converted_meshes_stand_beside_others_in_any_world(tmp_path: Path) -> None:
    (tmp_path / "box.stl").write_bytes(as_stl(_written(tmp_path, "other.ply", PLY)))
    path = urdf(tmp_path, "box.ply", PLY)
    readable = '<collision><geometry><mesh filename="box.stl" scale="2 2 2"/></geometry></collision></link>'
    path.write_text(path.read_text(encoding="utf-8").replace("</link>", readable), encoding="utf-8")
    world = mujoco.MjSpec()
    world.attach(read_urdf(path).copy(), prefix="env:own/", frame=world.worldbody.add_frame())
    extents = sorted(float(box[3:].max()) for box in world.compile().geom_aabb)
    assert extents == pytest.approx([1.5, 3.0])


def test_without_the_reader_the_message_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "collada", None)
    with pytest.raises(ValueError, match=r"the collision mesh 'box.dae' of the link 'box' has a format .*\[meshes\]'"):
        read_urdf(urdf(tmp_path, "box.dae", DAE))


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("box.glb", "glTF", "has a format that the simulator cannot read: convert it to STL or OBJ"),
        ("box.dae", "<COLLADA", "cannot be read: "),
        ("box.ply", "ply\nformat ascii 1.0\nend_header\n", "cannot be read: |has no faces"),
    ],
)
def test_a_mesh_that_cannot_be_read_is_named(tmp_path: Path, name: str, text: str, words: str) -> None:
    with pytest.raises(ValueError, match=f"the collision mesh '{name}' of the link 'box' ({words})"):
        read_urdf(urdf(tmp_path, name, text))


def test_a_visual_mesh_that_the_engine_does_not_read_is_left_out(tmp_path: Path) -> None:
    assert read_urdf(urdf(tmp_path, "box.dae", DAE, kind="visual")).copy().compile().ngeom == 0


@pytest.mark.parametrize(("faces", "readable"), [(12, True), (200_001, False)])
def test_an_stl_file_with_too_many_faces_is_named(tmp_path: Path, faces: int, readable: bool) -> None:
    path = tmp_path / "large.stl"
    path.write_bytes(bytes(80) + struct.pack("<I", faces) + bytes(50 * faces))
    assert is_readable(path) == readable
    if not readable:
        with pytest.raises(UnreadableMesh, match="has 200001 faces, and the simulator reads at most 200000"):
            as_stl(path)


def test_an_inertia_without_positive_moments_is_replaced_and_named(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    inertial = (
        '<inertial><mass value="1"/><inertia ixx="{0}" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    text = f'<robot name="r"><link name="fine">{inertial.format("0.02")}</link></robot>'
    path.write_text(text, encoding="utf-8")
    assert list(impossible_inertias(path)) == []
    path.write_text(text.replace('ixx="0.02"', 'ixx="-0.01"'), encoding="utf-8")
    assert list(impossible_inertias(path)) == ["fine"]
    read_urdf(path).copy().compile()
