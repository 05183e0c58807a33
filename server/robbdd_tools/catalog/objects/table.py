"""A table in front of the robot."""

from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind

LENGTH, WIDTH, HEIGHT = 0.70, 1.50, 0.75
"""Extent along x (away from the robot) and y, and height of the top above the floor, m."""
SLAB = 0.04
"""Thickness of the top, m."""
LEG = 0.03
"""Half edge of a leg, m."""
SPACE = 0.15
"""Height of the workspace above the top, m: an object lifted higher is no longer on the table."""


def _shapes() -> tuple[Shape, ...]:
    top = Shape(ShapeKind.BOX, (LENGTH / 2, WIDTH / 2, SLAB / 2), (0.0, 0.0, -SLAB / 2))
    half = (HEIGHT - SLAB) / 2
    x, y = LENGTH / 2 - 2 * LEG, WIDTH / 2 - 2 * LEG
    corners = ((x, y), (x, -y), (-x, y), (-x, -y))
    legs = (Shape(ShapeKind.BOX, (LEG, LEG, half), (cx, cy, -SLAB - half)) for cx, cy in corners)
    return (top, *legs)


TABLE = ObjectModel(
    name="table",
    prefixes=("table", "bench", "desk", "worktop", "dining"),
    shapes=_shapes(),
    mass=30.0,
    friction=0.6,
    free=False,
    graspable=False,
    rest_height=HEIGHT,
    color=(0.80, 0.74, 0.64, 1.0),
    doc="A table with a top of 0.70 × 1.50 m; its poses refer to the middle of the top, its workspace is 0.15 m high.",
    region=Region(center=(0.0, 0.0, SPACE / 2), half=(LENGTH / 2, WIDTH / 2, SPACE / 2)),
    places=((0.50, 0.0, 0.0), (-0.55, 0.0, 0.0)),
)
