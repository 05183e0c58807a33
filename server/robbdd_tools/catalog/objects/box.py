"""A small carton."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind

HALF = (0.030, 0.022, 0.020)
"""Half edges, m."""

BOX = ObjectModel(
    name="box",
    prefixes=("box", "carton", "block", "brick", "package", "packet", "parcel"),
    shapes=(Shape(ShapeKind.BOX, HALF),),
    mass=0.080,
    friction=0.5,
    free=True,
    graspable=True,
    rest_height=HALF[2],
    color=(0.76, 0.58, 0.36, 1.0),
    doc="A carton of 60 × 44 × 40 mm.",
)
