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


@dataclass(frozen=True, slots=True)
class Shape:
    """A primitive shape in the frame of its object.

    - ``size``: in m: the half edges of a box, (radius, 0, 0) of a sphere, or (radius, half length, 0) of a cylinder
      along z.
    - ``position``: the centre of the shape.
    - ``surface``: the surface velocity (m/s, along one axis) of a driven belt; ``None`` for other shapes.
    """

    kind: ShapeKind
    size: Vector
    position: Vector = (0.0, 0.0, 0.0)
    surface: Vector | None = None
