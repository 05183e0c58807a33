"""A chest with one drawer, loose on a table: a pull that sticks moves the chest."""

from robbdd_tools.base.articulation import PassiveJoint
from robbdd_tools.catalog.api import ObjectModel, Region, Shape, ShapeKind

DEPTH, WIDTH, HEIGHT = 0.24, 0.26, 0.075
"""Outer edges of the chest along x (away from the robot), y and z, m."""
BOARD = 0.008
"""Thickness of the boards of the chest, m."""
PLAY = 0.002
"""Room between the drawer and the boards around it, m."""
PANEL, WALL = 0.010, 0.004
"""Thickness of the drawer's front, and of its bottom and other sides, m."""
SIDE = 0.040
"""Height of the drawer's sides, m."""
TRAVEL = 0.16
"""How far the drawer opens, m."""
KNOB, KNOB_HEIGHT, STANDOFF = 0.016, 0.024, 0.046
"""Radius and height of the knob, and its distance from the front, m: a finger or a hand fits behind the knob."""
STEM = 0.005
"""Half edge of the bar that holds the knob, m."""
SLIDING, DAMPING = 1.0, 5.0
"""Dry friction (N) and damping (N s/m) of the drawer's runners, as for a light drawer on plastic."""


def _chest() -> tuple[Shape, ...]:
    long, wide, thick = DEPTH / 2, WIDTH / 2, BOARD / 2
    side = (HEIGHT - 2 * BOARD) / 2
    middle = HEIGHT / 2
    return (
        Shape(ShapeKind.BOX, (long, wide, thick), (0.0, 0.0, thick)),
        Shape(ShapeKind.BOX, (long, wide, thick), (0.0, 0.0, HEIGHT - thick)),
        Shape(ShapeKind.BOX, (long, thick, side), (0.0, wide - thick, middle)),
        Shape(ShapeKind.BOX, (long, thick, side), (0.0, thick - wide, middle)),
        Shape(ShapeKind.BOX, (thick, wide - BOARD, side), (long - thick, 0.0, middle)),
    )


def _drawer() -> tuple[Shape, ...]:
    """Return the shapes of the drawer; the origin is in the middle of the front's lower back edge. The knob is last."""
    long, wide = (DEPTH - BOARD - 2 * PLAY) / 2, WIDTH / 2 - BOARD - PLAY
    thick, half = WALL / 2, SIDE / 2
    front = (HEIGHT - BOARD) / 2
    high = HEIGHT / 2
    return (
        Shape(ShapeKind.BOX, (long, wide, thick), (long, 0.0, thick)),
        Shape(ShapeKind.BOX, (long, thick, half), (long, wide - thick, half)),
        Shape(ShapeKind.BOX, (long, thick, half), (long, thick - wide, half)),
        Shape(ShapeKind.BOX, (thick, wide, half), (2 * long - thick, 0.0, half)),
        Shape(ShapeKind.BOX, (PANEL / 2, WIDTH / 2, front), (-PANEL / 2, 0.0, front - BOARD / 2)),
        Shape(ShapeKind.BOX, (STANDOFF / 2, STEM, STEM), (-PANEL - STANDOFF / 2, 0.0, high - BOARD)),
        Shape(ShapeKind.CYLINDER, (KNOB, KNOB_HEIGHT / 2, 0.0), (-PANEL - STANDOFF, 0.0, high - BOARD)),
    )


def _moving() -> ObjectModel:
    long, wide = (DEPTH - BOARD - 2 * PLAY) / 2, WIDTH / 2 - BOARD - PLAY
    shapes = _drawer()
    inside = (SIDE - WALL) / 2
    return ObjectModel(
        name="box",
        prefixes=(),
        shapes=shapes,
        mass=0.5,
        friction=0.6,
        free=False,
        graspable=False,
        rest_height=0.0,
        color=(0.72, 0.58, 0.42, 1.0),
        doc="The drawer of a chest.",
        region=Region((long, 0.0, WALL + inside), (long - WALL, wide - WALL, inside), walled=True),
        joint=PassiveJoint(
            parent="",
            kind="slide",
            axis=(-1.0, 0.0, 0.0),
            anchor=(0.0, 0.0, 0.0),
            position=(-DEPTH / 2, 0.0, BOARD + PLAY),
            rotation=(1.0, 0.0, 0.0, 0.0),
            bounds=(0.0, TRAVEL),
            friction=SLIDING,
            damping=DAMPING,
            handle=len(shapes) - 1,
        ),
    )


DRAWER = ObjectModel(
    name="drawer",
    prefixes=("drawer",),
    shapes=_chest(),
    mass=3.0,
    friction=0.6,
    free=True,
    graspable=False,
    rest_height=0.0,
    color=(0.52, 0.40, 0.28, 1.0),
    doc=(
        "A chest of 0.24 × 0.26 × 0.075 m with a drawer that opens by 0.16 m towards the robot and has a knob; its "
        "workspace is the inside of the drawer, 36 mm high."
    ),
    places=((0.10, 0.33, 0.0), (0.10, -0.33, 0.0)),
    moving=_moving(),
)
