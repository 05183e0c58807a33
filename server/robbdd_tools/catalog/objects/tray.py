"""A flat tray, loose on a table."""

from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind

LENGTH, WIDTH, HEIGHT = 0.30, 0.22, 0.03
"""Outer edges along x, y and z, m."""
WALL = 0.005
"""Thickness of rim and bottom, m."""
SPACE = 0.10
"""Height of the workspace above the bottom, m: objects on a tray are higher than its rim."""


def _shapes() -> tuple[Shape, ...]:
    long, wide, high, half = LENGTH / 2, WIDTH / 2, HEIGHT / 2, WALL / 2
    bottom = Shape(ShapeKind.BOX, (long - WALL, wide - WALL, half), (0.0, 0.0, half))
    sides = (Shape(ShapeKind.BOX, (long, half, high), (0.0, side * (wide - half), high)) for side in (1, -1))
    ends = (Shape(ShapeKind.BOX, (half, wide - WALL, high), (end * (long - half), 0.0, high)) for end in (1, -1))
    return (bottom, *sides, *ends)


TRAY = ObjectModel(
    name="tray",
    prefixes=("tray",),
    shapes=_shapes(),
    mass=0.40,
    friction=0.5,
    free=True,
    graspable=False,
    rest_height=0.0,
    color=(0.40, 0.55, 0.60, 1.0),
    doc="A tray of 0.30 × 0.22 m with a rim of 30 mm; its workspace is the space of 0.10 m above its bottom.",
    region=Region(
        center=(0.0, 0.0, WALL + SPACE / 2),
        half=(LENGTH / 2 - WALL, WIDTH / 2 - WALL, SPACE / 2),
    ),
    places=((0.19, 0.0, 0.0), (-0.05, 0.60, 0.0), (-0.05, -0.60, 0.0), (-0.05, 0.36, 0.0), (-0.05, -0.36, 0.0)),
)
