"""Files that an engine would open by itself are known before it is started."""

from __future__ import annotations

from pathlib import Path

from kit import make_fifo
from robbdd_tools.base.model_includes import model_files, unusable


def test_included_models_meshes_and_pictures_are_found(tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    for name in ("meshes/hull.stl", "urdf.stl", "sky.png"):
        (tmp_path / name).write_bytes(b"\0")
    (tmp_path / "arm.xml").write_text(
        '<mujoco><compiler meshdir="meshes"/><include file="more.xml"/>'
        '<asset><mesh file="hull.stl"/><mesh file="gone.stl"/></asset></mujoco>'
    )
    (tmp_path / "more.xml").write_text(
        '<mujoco><include file="arm.xml"/><texture file="sky.png"/><mesh filename="file://urdf.stl"/></mujoco>'
    )
    found = [path.relative_to(tmp_path).as_posix() for path in model_files(tmp_path / "arm.xml")]
    assert found == ["arm.xml", "more.xml", "sky.png", "urdf.stl", "meshes/hull.stl"]
    assert unusable(tmp_path / "arm.xml") is None


def test_a_mesh_that_is_a_pipe_is_found_before_an_engine_waits_for_it(tmp_path: Path) -> None:
    make_fifo(tmp_path / "hull.stl")
    (tmp_path / "more.xml").write_text('<mujoco><mesh file="hull.stl"/></mujoco>')
    (tmp_path / "arm.xml").write_text('<mujoco><include file="more.xml"/></mujoco>')
    problem = unusable(tmp_path / "arm.xml")
    assert problem is not None
    assert problem.reason == "'hull.stl' is a named pipe; only regular files are read"


def test_a_missing_model_and_one_that_is_no_xml_have_no_includes(tmp_path: Path) -> None:
    problem = unusable(tmp_path / "gone.xml")
    assert problem is not None
    assert problem.code == "file-missing"
    (tmp_path / "arm.xml").write_text("<mujoco><include file=")
    assert list(model_files(tmp_path / "arm.xml")) == [tmp_path / "arm.xml"]


def test_an_srdf_file_beside_a_urdf_file_is_read_with_it(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text('<robot name="arm"/>')
    (tmp_path / "arm.srdf").write_text('<robot name="arm"/>')
    assert list(model_files(tmp_path / "arm.urdf")) == [tmp_path / "arm.urdf", tmp_path / "arm.srdf"]
    (tmp_path / "arm.srdf").unlink()
    make_fifo(tmp_path / "arm.srdf")
    assert list(model_files(tmp_path / "arm.urdf")) == [tmp_path / "arm.urdf"]


def test_meshes_of_packages_and_their_pieces_are_files_of_a_model(tmp_path: Path) -> None:
    urdf, mesh = tmp_path / "arm" / "urdf" / "arm.urdf", tmp_path / "arm" / "meshes" / "jaw.stl"
    urdf.parent.mkdir(parents=True)
    mesh.parent.mkdir()
    mesh.write_bytes(b"mesh")
    text = '<robot name="arm"><mesh filename="package://arm/meshes/jaw.stl"/><mesh filename="package://no/one.stl"/></robot>'
    urdf.write_text(text, encoding="utf-8")
    assert [one.name for one in model_files(urdf)] == ["arm.urdf", "jaw.stl"]
    mesh.with_name("jaw.stl.pieces.obj").write_bytes(b"pieces")
    assert [one.resolve() for one in model_files(urdf)] == [urdf, mesh, mesh.with_name("jaw.stl.pieces.obj")]
