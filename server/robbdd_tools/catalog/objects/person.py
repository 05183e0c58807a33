"""A person who stands at the end of a table and executes nothing: for clauses about distance and contact."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind, Vector

HEAD = 0.11
"""Radius of the head, m."""
LEG, LEGS = 0.08, 0.85
"""Radius and length of a leg, m."""
TRUNK: Vector = (0.16, 0.11, 0.30)
"""Half edges of the trunk, m: across, deep, high."""
ARM, ARMS = 0.045, 0.58
"""Radius and length of an arm, m."""
NECK = 0.08
"""Diameter of the neck, and its visible length, m."""


def _shapes() -> tuple[Shape, ...]:
    shoulders = LEGS + 2 * TRUNK[2]
    legs = (Shape(ShapeKind.CYLINDER, (LEG, LEGS / 2, 0.0), (x, 0.0, LEGS / 2)) for x in (-0.09, 0.09))
    side = TRUNK[0] + ARM
    arms = (Shape(ShapeKind.CYLINDER, (ARM, ARMS / 2, 0.0), (x, 0.0, shoulders - ARMS / 2)) for x in (-side, side))
    trunk = Shape(ShapeKind.BOX, TRUNK, (0.0, 0.0, shoulders - TRUNK[2]))
    neck = Shape(ShapeKind.CYLINDER, (NECK / 2, NECK, 0.0), (0.0, 0.0, shoulders + NECK))
    head = Shape(ShapeKind.SPHERE, (HEAD, 0.0, 0.0), (0.0, 0.0, shoulders + NECK + HEAD))
    return (*legs, *arms, trunk, neck, head)


PERSON = ObjectModel(
    name="person",
    prefixes=("person", "people", "human", "operator", "worker", "technician", "nurse", "visitor"),
    shapes=_shapes(),
    mass=75.0,
    friction=0.5,
    free=False,
    graspable=False,
    rest_height=0.0,
    color=(0.90, 0.52, 0.20, 1.0),
    doc=(
        "A person of 1.75 m who stands still, at first next to the left end of a table, and executes no behaviour; "
        "poses refer to the point between the feet."
    ),
    places=((0.10, 1.0, 0.0), (0.10, -1.0, 0.0), (0.60, 1.0, 0.0), (0.60, -1.0, 0.0)),
    bystander=True,
)
