"""Find the files that are read with an MJCF or URDF file: included models, meshes, textures and SRDF files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from xml.etree import ElementTree

from robbdd_tools.base.files import Unreadable, UnreadableFile, load_bytes, unreadable
from robbdd_tools.base.model_paths import SCHEMES, mesh_places
from robbdd_tools.base.source_texts import source_xml
from robbdd_tools.base.srdf import srdf_files

FOLDERS = ("meshdir", "texturedir", "assetdir")
"""Attributes of MJCF and URDF that name folders to search for files."""

PIECES = ".pieces.obj"
"""End of the name of a file with the convex pieces of a mesh, beside the mesh."""

Read = Callable[[Path], str | bytes]
"""Returns the XML of a file; raises ``UnreadableFile``."""


def model_files(path: Path, read: Read = load_bytes) -> Iterator[Path]:
    """Yield a model file, the existing files of any kind that it names, and its SRDF files; each file once."""
    seen: dict[Path, None] = {}
    waiting = [path]
    while waiting:
        current = waiting.pop()
        if current in seen or not os.path.lexists(current):
            continue
        seen[current] = None
        yield current
        waiting += reversed(list(_named(current, read)))
    yield from (one for one in srdf_files(path) if one not in seen)


def pieces_beside(mesh: Path) -> Path:
    """Return the path of the file with the convex pieces of a mesh file, whether it exists or not."""
    return mesh.with_name(mesh.name + PIECES)


def unusable(path: Path) -> Unreadable | None:
    """Return the reason why an engine cannot load a model file; ``None`` if it can.

    It cannot if one of the files that the model names is not a regular file.
    """
    named = [path, *model_files(path, source_xml)]
    return next((problem for file in named if (problem := unreadable(file)) is not None), None)


def _named(path: Path, read: Read) -> Iterator[Path]:
    try:
        root = ElementTree.fromstring(read(path))
    except (ElementTree.ParseError, LookupError, ValueError, UnreadableFile):
        return
    places = [path.parent, *(path.parent / element.get(name, "") for element in root.iter() for name in FOLDERS)]
    for name in (element.get("file") or element.get("filename") for element in root.iter()):
        if name:
            found = _in_package(path, name) or [place / name.removeprefix("file://") for place in dict.fromkeys(places)]
            yield from (one for place in found for one in (place, pieces_beside(place)) if os.path.lexists(one))


def _in_package(path: Path, name: str) -> list[Path]:
    """Return the file of a package that a model file names, which is the first one found; nothing for other names."""
    places = mesh_places(path, name) if name.startswith(SCHEMES) else iter(())
    return list(islice((one for one in places if os.path.lexists(one)), 1))
