"""A large hexagon head bolt that stands on its head, M20 × 60 by ISO 4017."""

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind
from robbdd_tools.catalog.objects.nut import FLATS, hexagonal_prism

HEAD, LENGTH, RADIUS = 0.0125, 0.060, 0.010
"""Height of the head, length and radius of the shank, m."""
HEIGHT = HEAD + LENGTH

BOLT = ObjectModel(
    name="bolt",
    prefixes=("bolt", "screw"),
    shapes=(
        hexagonal_prism(FLATS, HEAD, (0.0, 0.0, (HEAD - HEIGHT) / 2)),
        Shape(ShapeKind.CYLINDER, (RADIUS, LENGTH / 2, 0.0), (0.0, 0.0, HEAD / 2)),
    ),
    mass=0.22,
    friction=0.5,
    free=True,
    graspable=True,
    rest_height=HEIGHT / 2,
    color=(0.62, 0.64, 0.67, 1.0),
    doc="An M20 × 60 hexagon head bolt of steel (ISO 4017) that stands on its head; gripped by its shank.",
    whole_words=True,
)
