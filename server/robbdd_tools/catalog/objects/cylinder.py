"""An upright solid cylinder."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind

RADIUS, HALF = 0.022, 0.030
"""Metres."""

CYLINDER = ObjectModel(
    name="cylinder",
    prefixes=("cylinder", "can", "cup", "jar", "mug", "vial", "glass", "beaker", "tin"),
    shapes=(Shape(ShapeKind.CYLINDER, (RADIUS, HALF, 0.0)),),
    mass=0.090,
    friction=0.5,
    free=True,
    graspable=True,
    rest_height=HALF,
    color=(0.55, 0.35, 0.65, 1.0),
    doc="An upright cylinder of 44 mm diameter and 60 mm height with the mass of a small filled can.",
)
