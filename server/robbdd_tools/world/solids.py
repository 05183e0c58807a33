"""Collision shapes of objects in users' files: primitives if they are aligned with the object, else solids."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from robbdd_tools.base.solid_shapes import Inertia, Shape, ShapeKind, Solid, SolidKind, Vector
from robbdd_tools.world.engine import mujoco

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.catalog.api import FloatArray

ALIGNED = 1e-6
EVEN = 1e-3
"""Mass counts as evenly distributed up to this deviation, a share of its extent and of its inertia: files round."""
_PRIMITIVES = {
    int(mujoco.mjtGeom.mjGEOM_BOX): ShapeKind.BOX,
    int(mujoco.mjtGeom.mjGEOM_SPHERE): ShapeKind.SPHERE,
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): ShapeKind.CYLINDER,
}
_SOLIDS = {
    int(mujoco.mjtGeom.mjGEOM_BOX): SolidKind.BOX,
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): SolidKind.CYLINDER,
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): SolidKind.CAPSULE,
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): SolidKind.ELLIPSOID,
    int(mujoco.mjtGeom.mjGEOM_MESH): SolidKind.MESH,
}
ENGINE = {
    SolidKind.BOX: mujoco.mjtGeom.mjGEOM_BOX,
    SolidKind.CYLINDER: mujoco.mjtGeom.mjGEOM_CYLINDER,
    SolidKind.CAPSULE: mujoco.mjtGeom.mjGEOM_CAPSULE,
    SolidKind.ELLIPSOID: mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    SolidKind.MESH: mujoco.mjtGeom.mjGEOM_MESH,
}
"""The engine's types of solids."""


def shape_in(model: Any, data: Any, geom: int, body: int) -> Shape:
    """Return a collision shape in the frame of a body; any other kind of shape is its bounding box."""
    frame = data.xmat[body].reshape(3, 3)
    turn = frame.T @ data.geom_xmat[geom].reshape(3, 3)
    center = frame.T @ (data.geom_xpos[geom] - data.xpos[body])
    number = int(model.geom_type[geom])
    kind = _PRIMITIVES.get(number)
    size = model.geom_size[geom]
    upright = np.abs(turn - np.eye(3)).max() < ALIGNED
    if kind is ShapeKind.SPHERE:
        return Shape(kind, (float(size[0]), 0.0, 0.0), _vector(center))
    if kind is ShapeKind.CYLINDER and (upright or abs(turn[2, 2]) > 1 - ALIGNED):
        return Shape(kind, (float(size[0]), float(size[1]), 0.0), _vector(center))
    if kind is ShapeKind.BOX and upright:
        return Shape(kind, _vector(size), _vector(center))
    solid = _SOLIDS.get(number)
    if solid is SolidKind.MESH:
        return _hull(model, geom, turn, center)
    half = _half(model, geom, turn)
    middle = center + turn @ model.geom_aabb[geom, :3]
    box = Shape(ShapeKind.BOX, _vector(half), _vector(middle))
    if solid is None:
        return box
    rotation: FloatArray = np.empty(4)
    mujoco.mju_mat2Quat(rotation, turn.ravel())
    w, x, y, z = (float(part) for part in rotation)
    made = Solid(solid, _vector(size), _vector(center - middle), (w, x, y, z))
    return Shape(box.kind, box.size, box.position, solid=made)


def _half(model: Any, geom: int, turn: FloatArray) -> FloatArray:
    """Return half the edges (m, shape (3,)) of the bounding box of a geom that is turned relative to its body."""
    size = model.geom_size[geom]
    match _SOLIDS.get(int(model.geom_type[geom])):
        case SolidKind.CAPSULE:
            return np.abs(turn[:, 2]) * size[1] + size[0]
        case SolidKind.CYLINDER:
            return np.abs(turn[:, 2]) * size[1] + np.sqrt(np.maximum(0.0, 1.0 - turn[:, 2] ** 2)) * size[0]
        case SolidKind.ELLIPSOID:
            return np.sqrt((turn**2) @ (size**2))
        case _:
            return np.abs(turn) @ model.geom_aabb[geom, 3:]


def _hull(model: Any, geom: int, turn: FloatArray, center: FloatArray) -> Shape:
    """Return a mesh as its convex hull, with which the engine detects contacts."""
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    vertices = np.asarray(model.mesh_vert[first : first + count], dtype=float)
    graph = int(model.mesh_graphadr[mesh])
    if graph >= 0:
        # The hull's graph has the counts of vertices and faces, an address for each vertex, then the vertices' numbers.
        corners = int(model.mesh_graph[graph])
        vertices = vertices[model.mesh_graph[graph + 2 + corners : graph + 2 + 2 * corners]]
    placed = center + vertices @ turn.T
    low, high = placed.min(axis=0), placed.max(axis=0)
    middle = (low + high) / 2
    points = tuple(_vector(point) for point in placed - middle)
    return Shape(
        ShapeKind.BOX, _vector((high - low) / 2), _vector(middle), solid=Solid(SolidKind.MESH, vertices=points)
    )


def inertia_in(model: Any, data: Any, bodies: Sequence[int], root: int, shapes: Sequence[Shape]) -> Inertia | None:
    """Return how the mass of rigidly connected bodies is distributed, in the frame of ``root``.

    Return ``None`` if the shapes at uniform density have the same distribution, or if the bodies have no mass.
    """
    masses = model.body_mass[list(bodies)]
    mass = float(masses.sum())
    if mass <= 0.0:
        return None
    frame = data.xmat[root].reshape(3, 3)
    centers = (data.xipos[list(bodies)] - data.xpos[root]) @ frame
    turned = [frame.T @ data.ximat[body].reshape(3, 3) for body in bodies]
    own = [turn @ np.diag(model.body_inertia[body]) @ turn.T for turn, body in zip(turned, bodies, strict=True)]
    center, whole = _together(masses, centers, own)
    if all(shape.solid is None for shape in shapes):
        volumes = np.array([_volume(shape) for shape in shapes])
        even, expected = _together(
            volumes / volumes.sum() * mass,
            np.array([shape.position for shape in shapes]),
            [_unit(shape) * mass * volume / volumes.sum() for shape, volume in zip(shapes, volumes, strict=True)],
        )
        extent = float(np.trace(expected) / mass) ** 0.5
        if np.abs(center - even).max() <= EVEN * extent and np.abs(whole - expected).max() <= EVEN * float(
            np.trace(expected)
        ):
            return None
    about = whole / mass
    xx, yy, zz, xy, xz, yz = (float(about[i, j]) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    return Inertia(_vector(center), (xx, yy, zz, xy, xz, yz))


def _together(masses: FloatArray, centers: FloatArray, own: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return the centre of mass (m) of several parts, and their inertia (kg m²) about it."""
    center = masses @ centers / masses.sum()
    whole = np.zeros((3, 3))
    for mass, place, inertia in zip(masses, centers - center, own, strict=True):
        whole += inertia + mass * (float(place @ place) * np.eye(3) - np.outer(place, place))
    return center, whole


def _unit(shape: Shape) -> FloatArray:
    """Return the inertia (m²) about its centre of a primitive of 1 kg and uniform density."""
    a, b, c = shape.size
    match shape.kind:
        case ShapeKind.SPHERE:
            return np.eye(3) * 0.4 * a**2
        case ShapeKind.CYLINDER:
            across = a**2 / 4 + b**2 / 3
            return np.diag([across, across, a**2 / 2])
        case ShapeKind.BOX:
            return np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2]) / 3


def _volume(shape: Shape) -> float:
    a, b, c = shape.size
    match shape.kind:
        case ShapeKind.SPHERE:
            return 4 / 3 * np.pi * a**3
        case ShapeKind.CYLINDER:
            return 2 * np.pi * a**2 * b
        case ShapeKind.BOX:
            return 8 * a * b * c


def _vector(numbers: Any) -> Vector:
    x, y, z = (float(number) for number in numbers)
    return (x, y, z)
