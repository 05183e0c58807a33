"""A small stepped shelf on a table: a gripper that points down reaches both of its boards."""

from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind, Vector

DEPTH, WIDTH = 0.30, 0.48
"""Outer edges along x (away from the robot) and y, m."""
LOWER, UPPER = 0.05, 0.12
"""Height of the boards' tops, m."""
BOARD = 0.012
"""Thickness of the boards and the sides, m."""
SPACE = 0.12
"""Height of the workspace above each board, m."""


def _shapes() -> tuple[Shape, ...]:
    wide, half, quarter = WIDTH / 2, BOARD / 2, DEPTH / 4
    boards = (
        Shape(ShapeKind.BOX, (DEPTH / 2, wide - BOARD, half), (0.0, 0.0, LOWER - half)),
        Shape(ShapeKind.BOX, (quarter, wide - BOARD, half), (quarter, 0.0, UPPER - half)),
    )
    sides = ((side * (wide - half), x, top) for side in (1, -1) for x, top in ((-quarter, LOWER), (quarter, UPPER)))
    return (*boards, *(Shape(ShapeKind.BOX, (quarter, half, top / 2), (x, y, top / 2)) for y, x, top in sides))


def _above(name: str, x: float, height: float) -> Region:
    center: Vector = (x, 0.0, height + SPACE / 2)
    return Region(center, (DEPTH / 4, WIDTH / 2 - BOARD, SPACE / 2), name)


SHELF = ObjectModel(
    name="shelf",
    prefixes=("shelf", "rack", "cupboard"),
    shapes=_shapes(),
    mass=4.0,
    friction=0.6,
    free=True,
    graspable=False,
    rest_height=0.0,
    color=(0.62, 0.50, 0.36, 1.0),
    doc=(
        "A stepped shelf of 0.48 m with boards 0.05 m and 0.12 m high. A workspace whose name contains 'lower' or "
        "'upper' is the space above that board, any other one the space above both."
    ),
    region=Region((0.0, 0.0, (UPPER + SPACE) / 2), (DEPTH / 2, WIDTH / 2, (UPPER + SPACE) / 2)),
    places=((0.19, 0.0, 0.0), (0.19, 0.50, 0.0), (0.19, -0.50, 0.0)),
    parts=(_above("lower", -DEPTH / 4, LOWER), _above("upper", DEPTH / 4, UPPER)),
)
