"""A short aluminium profile."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind

HALF = (0.050, 0.020, 0.020)
"""Half edges, m."""

PROFILE = ObjectModel(
    name="profile",
    prefixes=("profile", "extrusion", "beam"),
    shapes=(Shape(ShapeKind.BOX, HALF),),
    mass=0.186,
    friction=0.5,
    free=True,
    graspable=True,
    rest_height=HALF[2],
    color=(0.25, 0.26, 0.28, 1.0),
    doc="A profile of 100 × 40 × 40 mm that lies on a side, with the mass of the large one of RoboCup@Work.",
)
