"""An object whose name does not say more than that it is one."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind

HALF = 0.020
"""Half edge, m (edge 40 mm)."""

PART = ObjectModel(
    name="part",
    prefixes=(
        "part",
        "workpiece",
        "piece",
        "item",
        "object",
        "obj",
        "thing",
        "product",
        "component",
        "sample",
        "article",
    ),
    shapes=(Shape(ShapeKind.BOX, (HALF, HALF, HALF)),),
    mass=0.080,
    friction=0.5,
    free=True,
    graspable=True,
    rest_height=HALF,
    color=(0.80, 0.72, 0.30, 1.0),
    doc="A block with an edge of 40 mm, for objects whose name says nothing more.",
    whole_words=True,
    unspecific=True,
)
