"""Read meshes in formats that the engine does not read, as STL."""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import open_regular

if TYPE_CHECKING:
    from pathlib import Path

READABLE = (".stl", ".obj", ".msh")
"""Mesh formats that the engine reads."""
CONVERTED = (".dae", ".ply", ".off", ".3mf")
"""Mesh formats that are converted. glTF is not: its files have the vertical along y, and simulators differ in that."""
FACES = 200_000
"""The engine reads meshes with at most this many faces."""
HEADER = 84
"""Length (bytes) of the header of a binary STL file; the last four are the number of faces."""
FACE = 50
"""Length (bytes) of a face in a binary STL file."""
MESHES = 256
"""Size of the cache of converted meshes."""
INSTALL = "convert it to STL or OBJ, or install its reader: pip install 'robbdd-tools[meshes]'"


class UnreadableMesh(Exception):
    """A mesh that the engine cannot use; the message completes 'the mesh …'."""


def is_readable(path: Path) -> bool:
    """Return whether the engine reads a mesh file itself."""
    kind = path.suffix.lower()
    return kind in READABLE and (kind != ".stl" or 0 < _binary_faces(path) <= FACES)


def as_stl(path: Path) -> bytes:
    """Return a mesh that the engine does not read as binary STL. Raises ``UnreadableMesh``."""
    kind = path.suffix.lower()
    if kind not in (*READABLE, *CONVERTED):
        raise UnreadableMesh("has a format that the simulator cannot read: convert it to STL or OBJ")
    if kind == ".stl":
        _refuse_large(_binary_faces(path))
    stamp = path.stat()
    return _converted(path, stamp.st_mtime_ns, stamp.st_size)


def _binary_faces(path: Path) -> int:
    """Return the number of faces of a binary STL file; 0 if the file is not one."""
    with open_regular(path) as file:
        header = file.read(HEADER)
    faces = int.from_bytes(header[-4:], "little")
    return faces if len(header) == HEADER and path.stat().st_size >= HEADER + FACE * faces else 0


def _refuse_large(faces: int) -> None:
    if faces > FACES:
        raise UnreadableMesh(f"has {faces} faces, and the simulator reads at most {FACES}: simplify it")


@lru_cache(maxsize=MESHES)
def _converted(path: Path, changed: int, size: int) -> bytes:
    """Return the mesh of a file as STL; ``changed`` (ns) and ``size`` (bytes) tell its versions apart.

    The unit of a COLLADA file counts. As in ROS, the vertical that it names does not: links have theirs along z.
    """
    del changed, size
    try:
        trimesh: Any = import_module("trimesh")
        if path.suffix.lower() == ".dae":
            import_module("collada")
    except ImportError:
        raise UnreadableMesh(f"has a format that the simulator cannot read: {INSTALL}") from None
    with open_regular(path) as file:
        content = file.read()
    kind = path.suffix.lower()
    try:
        mesh = trimesh.load_scene(BytesIO(content), file_type=kind.removeprefix(".")).to_geometry()
        faces = len(mesh.faces)
        if kind == ".dae":
            mesh.apply_scale(_unit(content))
    except Exception as error:  # each reader of trimesh fails with its own exception type
        raise UnreadableMesh(f"cannot be read: {' '.join(str(error).split()) or type(error).__name__}") from error
    if not faces:
        raise UnreadableMesh("has no faces")
    _refuse_large(faces)
    return bytes(mesh.export(file_type="stl"))


def _unit(content: bytes) -> float:
    """Return the unit (m) of a COLLADA file."""
    collada: Any = import_module("collada")
    return float(collada.Collada(BytesIO(content), ignore=[collada.common.DaeError]).assetInfo.unitmeter or 1.0)
