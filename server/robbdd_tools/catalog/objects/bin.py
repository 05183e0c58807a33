"""An open bin, loose on a table: a hit pushes it."""

from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind

LENGTH, WIDTH, HEIGHT = 0.30, 0.20, 0.15
"""Outer edges along x, y and z, m."""
WALL = 0.005
"""Thickness of walls and bottom, m."""


def _shapes() -> tuple[Shape, ...]:
    long, wide, high = LENGTH / 2, WIDTH / 2, HEIGHT / 2
    half = WALL / 2
    side, end = (long, half, high), (half, wide - WALL, high)
    return (
        Shape(ShapeKind.BOX, (long - WALL, wide - WALL, half), (0.0, 0.0, half)),
        Shape(ShapeKind.BOX, side, (0.0, wide - half, high)),
        Shape(ShapeKind.BOX, side, (0.0, half - wide, high)),
        Shape(ShapeKind.BOX, end, (long - half, 0.0, high)),
        Shape(ShapeKind.BOX, end, (half - long, 0.0, high)),
    )


BIN = ObjectModel(
    name="bin",
    prefixes=("bin", "container", "crate", "tote", "basket", "bucket"),
    shapes=_shapes(),
    mass=0.60,
    friction=0.5,
    free=True,
    graspable=False,
    rest_height=0.0,
    color=(0.35, 0.38, 0.42, 1.0),
    doc="An open plastic bin of 0.30 × 0.20 × 0.15 m; its workspace is the space within its walls.",
    region=Region(
        center=(0.0, 0.0, (HEIGHT + WALL) / 2),
        half=(LENGTH / 2 - WALL, WIDTH / 2 - WALL, (HEIGHT - WALL) / 2),
        walled=True,
    ),
    places=((-0.05, 0.60, 0.0), (-0.05, -0.60, 0.0), (-0.05, 0.36, 0.0), (-0.05, -0.36, 0.0)),
)
