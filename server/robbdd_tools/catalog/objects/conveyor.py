"""A short belt conveyor on a table, with a fixed stop at its end."""

from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind

LENGTH, WIDTH, HEIGHT = 0.74, 0.16, 0.05
"""Extent along y (the direction of travel, from the robot's left to its right) and x; height of the belt's top, m."""
BELT = 0.008
"""Thickness of the belt, m."""
GAP = 0.001
"""Clearance between the belt and the parts next to it, m."""
STOP, STOP_HEIGHT = 0.06, 0.02
"""Length of the stop and its height above the belt, m. An open finger does not fit behind the stop and would press on
it when closing. So objects are gripped from the belt's sides."""
SPACE = 0.10
"""Height of the workspace above the belt, m."""
SPEED = 0.10
"""Speed of the belt, m/s."""
FRAME = (HEIGHT - BELT - GAP) / 2

CONVEYOR = ObjectModel(
    name="conveyor",
    prefixes=("conveyor", "belt"),
    shapes=(
        Shape(ShapeKind.BOX, (WIDTH / 2, LENGTH / 2, FRAME), (0.0, 0.0, FRAME)),
        Shape(
            ShapeKind.BOX,
            (WIDTH / 2, STOP / 2, STOP_HEIGHT / 2),
            (0.0, (STOP - LENGTH) / 2, HEIGHT + GAP + STOP_HEIGHT / 2),
        ),
        Shape(
            ShapeKind.BOX,
            (WIDTH / 2, LENGTH / 2, BELT / 2),
            (0.0, 0.0, HEIGHT - BELT / 2),
            surface=(0.0, -SPEED, 0.0),
        ),
    ),
    mass=20.0,
    friction=0.6,
    free=True,
    graspable=False,
    rest_height=0.0,
    color=(0.24, 0.27, 0.30, 1.0),
    doc=(
        "A belt of 0.16 × 0.68 m before a stop, 0.05 m high, that runs at 0.1 m/s from the robot's left to its right; "
        "its workspace is the space of 0.10 m above the belt."
    ),
    region=Region(
        center=(0.0, STOP / 2, HEIGHT + SPACE / 2),
        half=(WIDTH / 2, (LENGTH - STOP) / 2, SPACE / 2),
    ),
    places=((0.0, 0.0, 0.0),),
)
