"""The shapes of a simulated world as plain data, to draw a recorded execution without the simulator."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.world.arrays import array
from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray
    from robbdd_tools.monitor.judge import Regions

SHOWN = 3
"""Geoms in groups below this one are drawn, as the engine does; others are collision shapes."""
FACES = 3000
"""Maximum number of triangles of a mesh; finer meshes are decimated."""
GRIDS = (96, 64, 48, 32, 24, 16, 8, 4)
"""Numbers of cells along the longest side of a mesh, tried in this order; vertices in one cell are merged."""
DIGITS = 5
"""Number of decimals of lengths and rotations: hundredths of a millimetre."""
UNPAINTED = (0.5, 0.5, 0.5, 1.0)
"""The engine's default colour, which a material's colour replaces."""
KINDS = {
    "mjGEOM_PLANE": "plane",
    "mjGEOM_SPHERE": "sphere",
    "mjGEOM_CAPSULE": "capsule",
    "mjGEOM_ELLIPSOID": "ellipsoid",
    "mjGEOM_CYLINDER": "cylinder",
    "mjGEOM_BOX": "box",
    "mjGEOM_MESH": "mesh",
}


def geometry(model: Any, names: dict[int, str], regions: Regions) -> dict[str, Any]:
    """Return shapes, meshes and workspaces in the form of ``docs/schemas/trace.schema.json``, bodies by name."""
    meshes: dict[int, int] = {}
    shapes = [_shape(model, geom, names[body], meshes) for body in names for geom in shown_geoms(model, body)]
    return {
        "shapes": shapes,
        "meshes": [_mesh(model, mesh) for mesh in meshes],
        "workspaces": [
            {"name": workspace, "body": carrier, "center": list(region.center), "half": list(region.half)}
            | ({"orientation": list(region.turn)} if region.turn else {})
            for workspace, boxes in regions.items()
            for carrier, region in boxes
        ],
    }


def shown_geoms(model: Any, body: int) -> Iterator[int]:
    """Yield the visible geoms of a body."""
    first = int(model.body_geomadr[body])
    for geom in range(first, first + int(model.body_geomnum[body])):
        if model.geom_group[geom] < SHOWN and color(model, geom)[3] > 0 and _kind(model, geom):
            yield geom


def color(model: Any, geom: int) -> list[float]:
    """Return red, green, blue and opacity of a geom."""
    material = int(model.geom_matid[geom])
    own: FloatArray = model.geom_rgba[geom]
    shade: FloatArray = own if material < 0 or not np.allclose(own, UNPAINTED) else model.mat_rgba[material]
    return np.asarray(shade, dtype=float).round(DIGITS).tolist()


def _kind(model: Any, geom: int) -> str:
    return KINDS.get(mujoco.mjtGeom(int(model.geom_type[geom])).name, "")


def _shape(model: Any, geom: int, body: str, meshes: dict[int, int]) -> dict[str, Any]:
    kind = _kind(model, geom)
    is_mesh = kind == "mesh"
    found: dict[str, Any] = {
        "body": body,
        "kind": kind,
        "size": [0.0] * 3 if is_mesh else model.geom_size[geom].round(DIGITS).tolist(),
        "position": model.geom_pos[geom].round(DIGITS).tolist(),
        "orientation": model.geom_quat[geom].round(DIGITS).tolist(),
        "color": color(model, geom),
    }
    if is_mesh:
        found["mesh"] = meshes.setdefault(int(model.geom_dataid[geom]), len(meshes))
    return found


def _mesh(model: Any, mesh: int) -> dict[str, Any]:
    first, face = int(model.mesh_vertadr[mesh]), int(model.mesh_faceadr[mesh])
    vertices = np.asarray(model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])], dtype=float)
    faces = np.asarray(model.mesh_face[face : face + int(model.mesh_facenum[mesh])], dtype=int)
    for cells in GRIDS:
        if len(faces) <= FACES:
            break
        vertices, faces = thinned(vertices, faces, cells)
    return {"vertices": array(vertices, "float32"), "faces": array(faces, "uint32")}


def thinned(vertices: FloatArray, faces: NDArray[np.intp], cells: int) -> tuple[FloatArray, NDArray[np.intp]]:
    """Return a coarser mesh: vertices (n, 3) m in a grid cell become their mean; faces (f, 3) in a cell are dropped."""
    low = vertices.min(axis=0)
    side = float((vertices.max(axis=0) - low).max()) / cells or 1.0
    _, owner = np.unique(np.floor((vertices - low) / side).astype(int), axis=0, return_inverse=True)
    owner = owner.reshape(-1)
    means = np.stack([np.bincount(owner, vertices[:, axis]) for axis in range(3)], axis=1)
    means /= np.bincount(owner)[:, None]
    found = owner[faces]
    kept = (found[:, 0] != found[:, 1]) & (found[:, 1] != found[:, 2]) & (found[:, 2] != found[:, 0])
    # Merging vertices may produce duplicate triangles.
    _, once = np.unique(np.sort(found[kept], axis=1), axis=0, return_index=True)
    return means, found[kept][np.sort(once)]
