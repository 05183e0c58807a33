"""Cut a mesh into convex pieces with CoACD (Wei et al. 2022, ACM Transactions on Graphics 41(4))."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.files import open_regular
from robbdd_tools.base.model_includes import pieces_beside
from robbdd_tools.base.writing import replace_file
from robbdd_tools.world.mesh_formats import UnreadableMesh, as_stl, is_readable
from robbdd_tools.world.mesh_pieces import obj_of, volume

if TYPE_CHECKING:
    from pathlib import Path

CORNERS = 64
"""Most corners of a piece: the engine takes longer to find the contacts of pieces with more."""
INSTALL = "install what cuts meshes: pip install 'robbdd-tools[meshes]'"


class NotCut(Exception):
    """A mesh cannot be cut; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class Cut:
    """The number of pieces, and how many times the mesh's volume they have; ``share`` is 0 for a mesh with holes."""

    pieces: int
    share: float


def cut_mesh(path: Path, threshold: float) -> Cut:
    """Write the convex pieces of a mesh beside it. Raises ``NotCut`` and ``OSError``.

    ``threshold`` is the largest concavity of a piece, a share of half the size of the mesh. The same mesh and threshold
    give the same pieces.
    """
    try:
        coacd: Any = import_module("coacd")
        mesh = _read(path)
    except ImportError:
        raise NotCut(INSTALL) from None
    except UnreadableMesh as error:
        raise NotCut(f"the mesh {path.name} {error}") from error
    coacd.set_log_level("error")
    found = coacd.run_coacd(
        coacd.Mesh(mesh.vertices, mesh.faces), threshold=threshold, decimate=True, max_ch_vertex=CORNERS, seed=0
    )
    with open_regular(path) as file:
        replace_file(pieces_beside(path), obj_of(file.read(), found))
    whole = volume(np.asarray(mesh.vertices), mesh.faces) if mesh.is_watertight else 0.0
    return Cut(len(found), sum(volume(*piece) for piece in found) / whole if whole else 0.0)


def _read(path: Path) -> Any:
    """Return a mesh in the unit in which the engine gets it. Raises ``UnreadableMesh`` and ``ImportError``."""
    trimesh: Any = import_module("trimesh")
    if is_readable(path):
        with open_regular(path) as file:
            content, kind = file.read(), path.suffix.lower().removeprefix(".")
    else:
        content, kind = as_stl(path), "stl"
    try:
        mesh = trimesh.load_scene(BytesIO(content), file_type=kind).to_geometry()
        mesh.merge_vertices()
    except Exception as error:  # each reader of trimesh fails with its own exception type
        raise UnreadableMesh(f"cannot be read: {' '.join(str(error).split()) or type(error).__name__}") from error
    return mesh
