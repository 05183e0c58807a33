"""Shapes that take part in contacts."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

Vector = tuple[float, float, float]
"""A vector x, y, z in m."""


class ShapeKind(StrEnum):
    """Primitive collision shapes."""

    BOX = "box"
    SPHERE = "sphere"
    CYLINDER = "cylinder"


class SolidKind(StrEnum):
    """Kinds of shapes in model files whose exact geometry takes part in contacts."""

    BOX = "box"
    CYLINDER = "cylinder"
    CAPSULE = "capsule"
    ELLIPSOID = "ellipsoid"
    MESH = "mesh"


@dataclass(frozen=True, slots=True)
class Solid:
    """A shape of a model file that is not a primitive aligned with its object.

    Contacts are computed with this shape, not with its bounding box.

    - ``size``: half edges of a box, (radius, half length, 0) along its own z axis, or radii of an ellipsoid (m).
    - ``offset`` (m) and ``rotation`` (w, x, y, z): its frame, relative to the centre of its bounding box.
    - ``vertices``: the vertices (m) of a mesh's convex hull, relative to the same centre and along the object's axes.
    """

    kind: SolidKind
    size: Vector = (0.0, 0.0, 0.0)
    offset: Vector = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    vertices: tuple[Vector, ...] = ()


@dataclass(frozen=True, slots=True)
class Inertia:
    """The mass distribution of an object: its centre of mass (m), and the inertia about this centre for 1 kg (m²).

    ``moments`` are xx, yy, zz, xy, xz and yz, in the frame of the object.
    """

    center: Vector
    moments: tuple[float, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Shape:
    """A primitive shape in the frame of its object.

    - ``size``: in m: the half edges of a box, (radius, 0, 0) of a sphere, or (radius, half length, 0) of a cylinder
      along z.
    - ``position``: the centre of the shape.
    - ``surface``: the surface velocity (m/s, along one axis) of a driven belt; ``None`` for other shapes.
    - ``solid``: the shape that contacts are computed with, if it is not this primitive. The primitive is
      then the bounding box of this shape.
    - ``friction`` and ``color`` (RGBA): the values of this shape, if they differ from the object's.
    """

    kind: ShapeKind
    size: Vector
    position: Vector = (0.0, 0.0, 0.0)
    surface: Vector | None = None
    solid: Solid | None = None
    friction: float | None = None
    color: tuple[float, float, float, float] | None = None
