"""Shapes that take part in contacts."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

Vector = tuple[float, float, float]
"""Metres, x y z."""


class ShapeKind(StrEnum):
    """Primitive collision shapes."""

    BOX = "box"
    SPHERE = "sphere"
    CYLINDER = "cylinder"


class SolidKind(StrEnum):
    """Kinds of shapes in files that take part in contacts as they are."""

    BOX = "box"
    CYLINDER = "cylinder"
    CAPSULE = "capsule"
    ELLIPSOID = "ellipsoid"
    MESH = "mesh"


@dataclass(frozen=True, slots=True)
class Solid:
    """A shape of a file that is not a primitive aligned with its object: contacts are with it, not with its box.

    - ``size``: half edges of a box, (radius, half length, 0) along its own z axis, or radii of an ellipsoid (m).
    - ``offset`` (m) and ``rotation`` (w, x, y, z): its frame, from the centre of its bounding box.
    - ``vertices``: those of the convex hull of a mesh, from the same centre, aligned with the object (m).
    """

    kind: SolidKind
    size: Vector = (0.0, 0.0, 0.0)
    offset: Vector = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    vertices: tuple[Vector, ...] = ()


@dataclass(frozen=True, slots=True)
class Inertia:
    """How the mass of an object is distributed: its centre (m), and the inertia about it for 1 kg (m²).

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
    - ``solid``: what is in contact, if it is not this primitive: then that is its bounding box, a box.
    - ``friction`` and ``color`` (RGBA): its own, where they differ from those of the object.
    """

    kind: ShapeKind
    size: Vector
    position: Vector = (0.0, 0.0, 0.0)
    surface: Vector | None = None
    solid: Solid | None = None
    friction: float | None = None
    color: tuple[float, float, float, float] | None = None
