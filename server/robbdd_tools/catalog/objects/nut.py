"""A large hexagon nut, M20 by ISO 4032."""

from math import cos, pi, sin, sqrt

from robbdd_tools.base.solid_shapes import Solid, SolidKind
from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind, Vector

FLATS, HEIGHT = 0.030, 0.018
"""Width across flats, and height, m."""


def hexagonal_prism(flats: float, height: float, position: Vector = (0.0, 0.0, 0.0)) -> Shape:
    """Return an upright prism whose width across flats (m) lies along x."""
    radius, half = flats / sqrt(3), height / 2
    angles = [pi / 6 + number * pi / 3 for number in range(6)]
    corners = tuple((radius * cos(angle), radius * sin(angle), z) for z in (-half, half) for angle in angles)
    return Shape(ShapeKind.BOX, (flats / 2, radius, half), position, solid=Solid(SolidKind.MESH, vertices=corners))


NUT = ObjectModel(
    name="nut",
    prefixes=("nut",),
    shapes=(hexagonal_prism(FLATS, HEIGHT),),
    mass=0.064,
    friction=0.5,
    free=True,
    graspable=True,
    rest_height=HEIGHT / 2,
    color=(0.62, 0.64, 0.67, 1.0),
    doc="An M20 hexagon nut of steel, 30 mm across flats and 18 mm high (ISO 4032), without its hole.",
    whole_words=True,
)
