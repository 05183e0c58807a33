"""A mesh that was cut collides as its convex pieces; one that was not collides as its convex hull."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

from robbdd_tools.base.model_includes import model_files, pieces_beside
from robbdd_tools.catalog.executable import ModelSource, Origin
from robbdd_tools.cli import main
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.mesh_cutting import NotCut, cut_mesh
from robbdd_tools.world.mesh_pieces import hollowness, obj_of, pieces_of
from robbdd_tools.world.model_files import load, object_from
from robbdd_tools.world.model_meshes import hollow_meshes, read_model, read_whole, whole_meshes
from robbdd_tools.world.robot_files import prepared_robot, robot_from
from world.arms import URDF
from world.hollow import HEIGHT, HULL, LENGTH, WALL, WIDTH, write_model, write_tote

THRESHOLD = 0.05


def source(path: Path) -> ModelSource:
    return ModelSource("x:tote", "mjcf", "file", path.name, origin=Origin(str(path.parent / "cell.scenex"), 3, 7))


@cache
def pieces_of_tote() -> str:
    with TemporaryDirectory() as folder:
        mesh = write_tote(Path(folder) / "tote.obj")
        cut_mesh(mesh, THRESHOLD)
        return pieces_beside(mesh).read_text(encoding="utf-8")


def put_pieces(mesh: Path) -> None:
    pieces_beside(mesh).write_text(pieces_of_tote(), encoding="utf-8")


def cut(path: Path) -> None:
    put_pieces(path.parent / "meshes" / "tote.obj")


def compiled(path: Path) -> Any:
    return read_model(path).compile()


def height_after_fall(path: Path) -> float:
    """Return the height (m) above the tote's floor at which a ball of 10 mm radius comes to rest in its middle."""
    spec = read_model(path)
    spec.delete(spec.body("tote").joints[0])
    ball = spec.worldbody.add_body(name="ball", pos=(0.0, 0.0, 0.4 + HEIGHT + 0.05))
    ball.add_freejoint()
    ball.add_geom(size=(0.01, 0.0, 0.0), density=2000.0)
    model = spec.compile()
    data: Any = mujoco.MjData(model)
    for _ in range(2000):
        mujoco.mj_step(model, data)
    return float(data.body("ball").xpos[2]) - 0.4


def test_a_hollow_mesh_is_found_by_the_volume_of_its_convex_hull(tmp_path: Path) -> None:
    assert hollow_meshes(compiled(write_model(tmp_path))) == {"shell": pytest.approx(HULL, rel=1e-5)}


def test_a_convex_mesh_is_not_hollow() -> None:
    spec = mujoco.MjSpec()
    spec.add_mesh(name="wedge", uservert=[0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1])
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="wedge")
    model = spec.compile()
    assert hollowness(model, 0) == pytest.approx(1.0)
    assert hollow_meshes(model) == {}


def test_a_ball_lies_on_the_hull_of_a_whole_tote_and_on_the_floor_of_one_that_is_cut(tmp_path: Path) -> None:
    path = write_model(tmp_path)
    assert height_after_fall(path) == pytest.approx(HEIGHT + 0.01, abs=2e-3)
    cut(path)
    assert height_after_fall(path) == pytest.approx(WALL + 0.01, abs=3e-3)


def test_pieces_keep_mass_inertia_friction_and_place(tmp_path: Path) -> None:
    whole = compiled(write_model(tmp_path))
    cut(tmp_path / "tote.xml")
    model = compiled(tmp_path / "tote.xml")
    np.testing.assert_allclose(model.body("tote").mass, whole.body("tote").mass)
    np.testing.assert_allclose(model.body("tote").inertia, whole.body("tote").inertia)
    np.testing.assert_allclose(model.body("tote").ipos, whole.body("tote").ipos, atol=1e-12)
    pieces = [geom for geom in range(model.ngeom) if model.geom_contype[geom]]
    assert len(pieces) > 4
    assert {float(model.geom_friction[geom, 0]) for geom in pieces} == {0.7}
    names = {str(model.geom(geom).name) for geom in pieces}
    assert names == {f"body piece {number + 1}" for number in range(len(pieces))}


def test_an_object_consists_of_the_pieces_and_is_no_longer_hollow(tmp_path: Path) -> None:
    path = write_model(tmp_path)
    whole = object_from(load(source(path)), source(path), "", ("tray_ws",))
    assert (len(whole.model.shapes), whole.hollow) == (1, pytest.approx(HULL, rel=1e-5))


def test_a_cut_object_consists_of_its_pieces(tmp_path: Path) -> None:
    path = write_model(tmp_path)
    cut(path)
    found = object_from(load(source(path)), source(path), "", ("tray_ws",))
    assert len(found.model.shapes) > 4
    assert found.hollow == 0.0
    assert found.model.mass == pytest.approx(0.5)
    # The geom is turned by a quarter turn: the tote is long along y.
    low = np.min([np.subtract(one.position, one.size) for one in found.model.shapes], axis=0)
    high = np.max([np.add(one.position, one.size) for one in found.model.shapes], axis=0)
    np.testing.assert_allclose(high - low, (WIDTH, LENGTH, HEIGHT), atol=4e-3)


def with_workspace(folder: Path, height: float) -> ModelSource:
    """Return the tote with a workspace whose middle is at a height (m) above its floor."""
    path = write_model(folder)
    site = f'<site name="workspace" type="box" pos="0 0 {height}" size="0.08 0.13 0.03"/></body>'
    path.write_text(path.read_text(encoding="utf-8").replace("</body>", site, 1), encoding="utf-8")
    return source(path)


def test_a_workspace_that_the_hull_of_a_mesh_fills_is_refused(tmp_path: Path) -> None:
    tote = with_workspace(tmp_path, HEIGHT / 2)
    words = (
        r"in tote\.xml, the mesh 'shell' collides as its convex hull, which fills the workspace 'workspace'; 'robbdd"
    )
    with pytest.raises(SceneError, match=words):
        object_from(load(tote), tote, "", ("tray_ws",))


def test_a_workspace_above_a_mesh_is_not_filled(tmp_path: Path) -> None:
    tote = with_workspace(tmp_path, HEIGHT + 0.01)
    assert object_from(load(tote), tote, "", ("tray_ws",)).hollow > 1


def test_a_workspace_in_a_mesh_that_is_cut_is_not_filled(tmp_path: Path) -> None:
    tote = with_workspace(tmp_path, HEIGHT / 2)
    cut(tmp_path / "tote.xml")
    region = object_from(load(tote), tote, "", ("tray_ws",)).model.region
    assert region is not None
    assert region.center[2] == pytest.approx(HEIGHT / 2)
    assert region.walled


@pytest.mark.parametrize("attributes", ['refpos="0.1 0 0.02"', 'refquat="0 1 0 0"', ""])
def test_pieces_are_where_the_mesh_is(tmp_path: Path, attributes: str) -> None:
    path = write_model(tmp_path, attributes=attributes)
    text = path.read_text(encoding="utf-8").replace("<geom", '<frame pos="0.3 0.2 0.1" euler="0 0 30"><geom')
    path.write_text(text.replace("</body>", "</frame></body>"), encoding="utf-8")
    whole = extent(compiled(path))
    cut(path)
    np.testing.assert_allclose(extent(compiled(path)), whole, atol=4e-3)


def extent(model: Any) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return the lowest and the highest corner (m, world frame) of all shapes that collide."""
    data: Any = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    corners = [
        data.geom_xpos[geom] + model.mesh_vert[first : first + count] @ data.geom_xmat[geom].reshape(3, 3).T
        for geom in range(model.ngeom)
        if model.geom_contype[geom]
        for first, count in [(model.mesh_vertadr[model.geom_dataid[geom]], model.mesh_vertnum[model.geom_dataid[geom]])]
    ]
    return np.concatenate(corners).min(axis=0), np.concatenate(corners).max(axis=0)


def test_a_scaled_mesh_has_scaled_pieces(tmp_path: Path) -> None:
    path = write_model(tmp_path, attributes='scale="2 2 0.5"')
    cut(path)
    assert extent(compiled(path))[1][2] == pytest.approx(0.4 + HEIGHT / 2, abs=1e-3)


def test_a_collision_mesh_of_a_urdf_file_collides_as_its_pieces(tmp_path: Path) -> None:
    write_tote(tmp_path / "tote.obj")
    path = tmp_path / "tote.urdf"
    mesh = '<geometry><mesh filename="tote.obj"/></geometry>'
    path.write_text(
        f'<robot name="tote"><link name="tote"><visual>{mesh}</visual><collision>{mesh}</collision></link></robot>',
        encoding="utf-8",
    )
    put_pieces(tmp_path / "tote.obj")
    model = read_model(path).compile()
    assert int((model.geom_contype > 0).sum()) > 4
    spec, files = read_whole(path)
    assert int((spec.compile().geom_contype > 0).sum()) == 1
    assert files == {"tote": tmp_path / "tote.obj"}


COLUMN = '<collision><origin xyz="0 0 0.15"/><geometry><cylinder radius="0.05" length="0.2"/></geometry></collision>'
SHOWN = '<visual><origin xyz="0 0 0.15"/><geometry><mesh filename="tote.obj" scale="0.2 0.2 0.2"/></geometry></visual>'


def arm_with_a_shown_tote(folder: Path) -> ModelSource:
    """Return an arm whose second link has the tote as its only shape, a visual one."""
    write_tote(folder / "tote.obj")
    (folder / "arm.urdf").write_text(URDF.replace(COLUMN, SHOWN), encoding="utf-8")
    return ModelSource("x:arm", "urdf", "file", "arm.urdf", origin=Origin(str(folder / "cell.scenex"), 3, 7))


def colliding(source: ModelSource) -> int:
    """Return how many shapes of the second link collide."""
    spec = prepared_robot(robot_from(source, "env:arm").mjcf)
    assert spec is not None
    return sum(bool(geom.contype or geom.conaffinity) for geom in spec.body("column").geoms)


def test_a_collision_mesh_that_is_converted_collides_as_its_pieces(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    trimesh.load_mesh(write_tote(tmp_path / "tote.obj")).export(tmp_path / "tote.ply")
    path = tmp_path / "tote.urdf"
    shape = '<collision><geometry><mesh filename="tote.ply"/></geometry></collision>'
    path.write_text(f'<robot name="tote"><link name="tote">{shape}</link></robot>', encoding="utf-8")
    assert list(whole_meshes(path)) == [tmp_path / "tote.ply"]
    cut_mesh(tmp_path / "tote.ply", THRESHOLD)
    assert int((read_model(path).compile().geom_contype > 0).sum()) > 4
    assert whole_meshes(path) == {}


def test_a_hollow_link_that_collides_as_its_visual_mesh_is_found(tmp_path: Path) -> None:
    arm = arm_with_a_shown_tote(tmp_path)
    assert colliding(arm) == 1
    assert [file.name for file in whole_meshes(tmp_path / "arm.urdf")] == ["tote.obj"]


def test_a_link_that_collides_as_its_visual_mesh_collides_as_its_pieces(tmp_path: Path) -> None:
    arm = arm_with_a_shown_tote(tmp_path)
    put_pieces(tmp_path / "tote.obj")
    assert colliding(arm) > 4
    assert whole_meshes(tmp_path / "arm.urdf") == {}


def test_a_gripper_whose_hollow_finger_never_meets_the_other_one_is_to_be_cut(tmp_path: Path) -> None:
    write_tote(tmp_path / "tote.obj")
    finger = '<geometry><box size="0.018 0.008 0.03"/></geometry>'
    hollow = '<geometry><mesh filename="tote.obj" scale="0.02 0.02 0.02"/></geometry>'
    (tmp_path / "arm.urdf").write_text(
        URDF.replace(finger, hollow).replace('lower="0.0"', 'lower="0.02"'), encoding="utf-8"
    )
    arm = ModelSource("x:arm", "urdf", "file", "arm.urdf", origin=Origin(str(tmp_path / "cell.scenex"), 3, 7))
    with pytest.raises(SceneError, match=r"no two parts that meet .* A hollow mesh collides as its convex hull; "):
        robot_from(arm, "env:arm")


def test_a_shape_of_a_contact_pair_stays_whole(tmp_path: Path) -> None:
    pair = '<contact><pair geom1="body" geom2="other"/></contact>'
    path = write_model(tmp_path, pair)
    path.write_text(path.read_text().replace("<worldbody>", '<worldbody><geom name="other" size="0.01"/>'))
    cut(path)
    assert int((compiled(path).geom_contype > 0).sum()) == 2


def test_pieces_of_another_version_of_the_mesh_are_refused(tmp_path: Path) -> None:
    path = write_model(tmp_path)
    cut(path)
    mesh = tmp_path / "meshes" / "tote.obj"
    mesh.write_text(mesh.read_text() + "# changed\n")
    with pytest.raises(
        SceneError, match=r"has the pieces of another version of tote\.obj: 'robbdd cut tote\.obj' cuts it"
    ):
        load(source(path))


@pytest.mark.parametrize("damage", ["v 1 2 x", "v 1 2\nf 1 1 1", "v 1 2 3\nf 1 1 9", ""])
def test_damaged_pieces_are_refused(tmp_path: Path, damage: str) -> None:
    mesh = write_tote(tmp_path / "tote.obj")
    pieces_beside(mesh).write_text(f"{obj_of(mesh.read_bytes(), [])}o piece1\n{damage}\n")
    with pytest.raises(ValueError, match=r"tote\.obj\.pieces\.obj cannot be read: remove it, or cut tote\.obj again"):
        pieces_of(mesh)


def test_pieces_are_read_as_written(tmp_path: Path) -> None:
    mesh = write_tote(tmp_path / "tote.obj")
    pieces = [(np.eye(3), np.array([[0, 1, 2]])), (2 * np.eye(3), np.array([[2, 1, 0]]))]
    text = obj_of(mesh.read_bytes(), pieces)
    pieces_beside(mesh).write_text(text)
    for found, (corners, _) in zip(pieces_of(mesh), pieces, strict=True):
        np.testing.assert_allclose(found, corners)
    assert [line for line in text.splitlines() if line.startswith("f ")] == ["f 1 2 3", "f 6 5 4"]


def test_the_same_mesh_is_cut_into_the_same_pieces(tmp_path: Path) -> None:
    mesh = write_tote(tmp_path / "tote.obj")
    cut_mesh(mesh, THRESHOLD)
    assert pieces_beside(mesh).read_text(encoding="utf-8") == pieces_of_tote()


def test_pieces_are_among_the_files_of_a_model(tmp_path: Path) -> None:
    path = write_model(tmp_path)
    cut(path)
    assert [one.name for one in model_files(path)] == ["tote.xml", "tote.obj", "tote.obj.pieces.obj"]


def test_what_is_no_mesh_is_not_cut(tmp_path: Path) -> None:
    other = tmp_path / "notes.stl"
    other.write_bytes(b"no mesh")
    with pytest.raises(NotCut, match="the mesh notes"):
        cut_mesh(other, THRESHOLD)


def test_the_command_cuts_the_hollow_meshes_of_a_model_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_model(tmp_path)
    assert main(["cut", str(path)]) == 0
    first, second = capsys.readouterr().out.splitlines()
    assert first == f"tote.obj, whose convex hull has {HULL:.3g} times its volume: this may take minutes"
    assert second.endswith("times its volume: tote.obj.pieces.obj")
    assert main(["cut", str(path)]) == 0
    assert capsys.readouterr().out == "tote.obj: has been cut (--force cuts it again)\n"
    assert main(["cut", str(path), "--force"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 2


def test_the_command_cuts_a_mesh(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = write_tote(tmp_path / "tote.obj")
    assert main(["cut", str(mesh), "--threshold", "0.1"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "tote.obj: this may take minutes"
    assert pieces_beside(mesh).is_file()


def test_the_command_says_why_it_cuts_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plain = tmp_path / "plain.xml"
    plain.write_text('<mujoco><worldbody><geom size="1"/></worldbody></mujoco>')
    assert main(["cut", str(plain)]) == 0
    assert capsys.readouterr().out == f"{plain}: no collision mesh is hollow\n"
    broken = tmp_path / "broken.xml"
    broken.write_text("<mujoco>")
    assert main(["cut", str(broken)]) == 2
    assert f"{broken}: " in capsys.readouterr().err
    assert main(["cut", str(tmp_path / "none.stl")]) == 2
    assert "there is no file" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["cut", str(plain), "--threshold", "2"])
    assert "'2' is not a number from 0.01 to 1" in capsys.readouterr().err
