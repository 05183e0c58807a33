"""Convex pieces of a mesh, in a file beside it: a whole mesh collides as its convex hull."""

from __future__ import annotations

from hashlib import sha256
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.files import open_regular
from robbdd_tools.base.model_includes import pieces_beside
from robbdd_tools.world.engine import mujoco
from robbdd_tools.world.obj_groups import closed_groups, read_groups

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from robbdd_tools.catalog.api import FloatArray

HEADER = "# Convex pieces of the mesh with the SHA-256 digest "
HIDDEN = 3
"""Group of geoms that pictures leave out."""
HOLLOW = 1.3
"""A mesh counts as hollow if its convex hull has at least so many times its volume."""
CUT = "'robbdd cut MODEL' cuts it into convex pieces"
_GEOM = (
    *("pos", "quat", "contype", "conaffinity", "condim", "priority", "friction", "solmix", "solref", "solimp"),
    *("margin", "gap", "rgba"),
)
"""Attributes that a piece shares with its geom."""
_TURN = ("type", "axisangle", "euler", "xyaxes", "zaxis")


def obj_of(mesh: bytes, pieces: Sequence[tuple[FloatArray, FloatArray]]) -> str:
    """Return the pieces of a mesh file as an OBJ file with an object each.

    A piece has corners (shape (n, 3), in the unit of the mesh) and faces (shape (m, 3), numbers of corners from 0).
    """
    lines, before = [f"{HEADER}{sha256(mesh).hexdigest()}", "# Written by 'robbdd cut'."], 1
    for number, (corners, faces) in enumerate(pieces, start=1):
        lines.append(f"o piece{number}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in corners]
        lines += [f"f {a + before} {b + before} {c + before}" for a, b, c in faces]
        before += len(corners)
    return "\n".join((*lines, ""))


def pieces_of(mesh: Path) -> tuple[FloatArray, ...]:
    """Return the corners (shape (n, 3), in the unit of the mesh) of the pieces of a mesh; nothing if it is whole.

    They are those of the file beside it, or the closed groups of an OBJ file.
    Raises ``ValueError`` if the pieces cannot be read or are those of another version of the mesh.
    """
    file = pieces_beside(mesh)
    if not file.is_file():
        return _own_groups(mesh)
    lines = _content(file).decode("utf-8", "replace").splitlines()
    if lines[:1] != [f"{HEADER}{sha256(_content(mesh)).hexdigest()}"]:
        raise ValueError(
            f"{file.name} has the pieces of another version of {mesh.name}: 'robbdd cut {mesh.name}' cuts it"
        )
    try:
        found = tuple(corners[np.unique(faces)] for corners, faces in read_groups(lines))
    except ValueError:
        found = ()
    if not found:
        raise ValueError(f"{file.name} cannot be read: remove it, or cut {mesh.name} again")
    return found


def _own_groups(mesh: Path) -> tuple[FloatArray, ...]:
    try:
        return closed_groups(_content(mesh)) if mesh.suffix.lower() == ".obj" else ()
    except ValueError:
        return ()  # the engine says what is wrong with the file


def _content(path: Path) -> bytes:
    with open_regular(path) as file:
        return file.read()


def use_pieces(spec: Any, files: Mapping[str, Path]) -> None:
    """Let the colliding geoms of cut meshes collide as their pieces. Raises ``ValueError``.

    ``files`` are the files of the meshes by their names in ``spec``. The geoms keep their mass and their looks; those
    that the file names in a contact pair stay as they are.
    """
    paired = {name for pair in spec.pairs for name in (pair.geomname1, pair.geomname2)}
    cut: dict[str, tuple[str, ...]] = {}
    for geom in [geom for body in spec.bodies for geom in body.geoms if _collides_as_mesh(geom)]:
        name = str(geom.meshname)
        if name not in files or (geom.name and geom.name in paired):
            continue
        if name not in cut:
            cut[name] = tuple(_add_meshes(spec, spec.mesh(name), pieces_of(files[name])))
        for number, piece in enumerate(cut[name], start=1):
            _add_geom(geom, piece, number)
        if cut[name]:
            geom.contype = geom.conaffinity = 0


def _collides_as_mesh(geom: Any) -> bool:
    return geom.type == mujoco.mjtGeom.mjGEOM_MESH and bool(geom.contype or geom.conaffinity)


def _add_meshes(spec: Any, mesh: Any, pieces: Iterable[FloatArray]) -> Iterator[str]:
    for number, corners in enumerate(pieces, start=1):
        name = f"{mesh.name} piece {number}"
        spec.add_mesh(name=name, uservert=corners.ravel(), scale=mesh.scale, refpos=mesh.refpos, refquat=mesh.refquat)
        yield name


def _add_geom(geom: Any, mesh: str, number: int) -> None:
    made = geom.parent.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh, mass=0.0, group=HIDDEN)
    if geom.name:
        made.name = f"{geom.name} piece {number}"
    for attribute in _GEOM:
        setattr(made, attribute, getattr(geom, attribute))
    for attribute in _TURN:
        setattr(made.alt, attribute, getattr(geom.alt, attribute))
    if geom.frame is not None:
        made.set_frame(geom.frame)


def is_in_hull(model: Any, mesh: int, point: FloatArray) -> bool:
    """Return whether a point (m, shape (3,), in the frame of a compiled mesh) is inside the convex hull of the mesh."""
    vertices, faces = _hull_of(model, mesh)
    if not len(faces):
        return False
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    outward = np.cross(b - a, c - a)
    middle = vertices[np.unique(faces)].mean(axis=0)
    sides = np.einsum("ij,ij->i", outward, point - a) * np.einsum("ij,ij->i", outward, middle - a)
    return bool((sides > 0.0).all())


def _hull_of(model: Any, mesh: int) -> tuple[FloatArray, Any]:
    """Return the corners of a mesh (shape (n, 3)) and the triangles of its convex hull (shape (m, 3))."""
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    vertices = np.asarray(model.mesh_vert[first : first + count], dtype=float)
    graph = int(model.mesh_graphadr[mesh])
    if graph < 0:
        return vertices, np.empty((0, 3), dtype=np.int64)
    corners, sides = int(model.mesh_graph[graph]), int(model.mesh_graph[graph + 1])
    # After the counts: an address and a number for each corner, the edges, then three corners for each face.
    start = graph + 2 + 3 * corners + 3 * sides
    return vertices, model.mesh_graph[start : start + 3 * sides].reshape(-1, 3)


def hollowness(model: Any, mesh: int) -> float | None:
    """Return how many times a mesh's volume its convex hull has; ``None`` if its faces do not enclose a volume."""
    vertices, hull = _hull_of(model, mesh)
    start, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    inner, outer = volume(vertices, model.mesh_face[start : start + faces]), volume(vertices, hull)
    return outer / inner if inner > 0.0 and outer > 0.0 else None


def volume(vertices: FloatArray, faces: Any) -> float:
    """Return the volume that faces enclose: ``vertices`` has shape (n, 3), ``faces`` shape (m, 3), numbers from 0."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    return abs(float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum())) / 6
