"""A ball that just fits between the fingers of a small gripper."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind

RADIUS = 0.030
"""Metres."""

BALL = ObjectModel(
    name="ball",
    prefixes=("ball", "sphere", "apple"),
    shapes=(Shape(ShapeKind.SPHERE, (RADIUS, 0.0, 0.0)),),
    mass=0.060,
    friction=0.6,
    free=True,
    graspable=True,
    rest_height=RADIUS,
    color=(0.20, 0.45, 0.80, 1.0),
    doc="A ball with a radius of 30 mm and the mass of a tennis ball.",
)
