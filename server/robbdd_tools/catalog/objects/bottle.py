"""A small bottle; grippers grasp its neck."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind

RADIUS, NECK = 0.030, 0.016
"""Radius of the body and of the neck with its cap, m."""
HEIGHT, NECK_HEIGHT = 0.080, 0.040
"""Height of the body and of the neck, m."""

BOTTLE = ObjectModel(
    name="bottle",
    prefixes=("bottle", "flask"),
    shapes=(
        Shape(ShapeKind.CYLINDER, (RADIUS, HEIGHT / 2, 0.0)),
        Shape(ShapeKind.CYLINDER, (NECK, NECK_HEIGHT / 2, 0.0), (0.0, 0.0, (HEIGHT + NECK_HEIGHT) / 2)),
    ),
    mass=0.150,
    friction=0.5,
    free=True,
    graspable=True,
    rest_height=HEIGHT / 2,
    color=(0.30, 0.60, 0.45, 1.0),
    doc="A bottle of 60 mm diameter and 120 mm height with a neck of 32 mm; its poses refer to the middle of its body.",
)
