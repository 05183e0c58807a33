"""A wooden cube, the larger of the two object types that the paper's robots pick."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind

HALF = 0.01575
"""Half edge, m (edge 31.5 mm)."""

CUBE = ObjectModel(
    name="cube",
    prefixes=("cube",),
    shapes=(Shape(ShapeKind.BOX, (HALF, HALF, HALF)),),
    mass=0.031,
    friction=0.6,
    free=True,
    graspable=True,
    rest_height=HALF,
    color=(0.85, 0.27, 0.20, 1.0),
    doc="A cube with an edge of 31.5 mm and the density of hard plastic.",
)
