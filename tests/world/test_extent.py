"""How far objects reach around their position."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import hypot

import numpy as np
import pytest

from robbdd_tools.catalog.api import Region, Shape, ShapeKind
from robbdd_tools.catalog.objects.bin import BIN
from robbdd_tools.catalog.objects.cube import CUBE
from robbdd_tools.world.extent import RIM, bounds_of, centred, outline_of, with_walls

BOX = Shape(ShapeKind.BOX, (0.1, 0.2, 0.3), (1.0, 2.0, 3.0))
BALL = Shape(ShapeKind.SPHERE, (0.5, 0.0, 0.0), (1.0, 2.0, 3.0))
CAN = Shape(ShapeKind.CYLINDER, (0.2, 0.5, 0.0), (1.0, 2.0, 3.0))


def test_a_box_is_touched_at_its_corners() -> None:
    found = outline_of(replace(CUBE, shapes=(BOX,)))
    corners = product((0.9, 1.1), (1.8, 2.2), (2.7, 3.3))
    assert [(tuple(round(value, 6) for value in point), radius) for point, radius in found] == [
        (corner, 0.0) for corner in corners
    ]


def test_a_ball_is_its_own_outline() -> None:
    assert outline_of(replace(CUBE, shapes=(BALL, BALL))) == (((1.0, 2.0, 3.0), 0.5),) * 2


def test_a_cylinder_is_touched_all_around_its_rims() -> None:
    found = outline_of(replace(CUBE, shapes=(CAN,)))
    assert len(found) == 2 * RIM
    assert {radius for _, radius in found} == {0.0}
    points = np.array([point for point, _ in found])
    assert sorted({round(float(z), 6) for z in points[:, 2]}) == [2.5, 3.5]
    assert np.hypot(points[:, 0] - 1.0, points[:, 1] - 2.0) == pytest.approx(np.full(2 * RIM, 0.2))
    angles = np.sort(np.arctan2(points[:RIM, 1] - 2.0, points[:RIM, 0] - 1.0) % (2 * np.pi - 1e-9))
    assert np.diff(angles) == pytest.approx(np.full(RIM - 1, 2 * np.pi / RIM))


def test_the_box_around_shapes_holds_all_of_them() -> None:
    low, high = bounds_of((CAN, BALL, BOX))
    assert (low.tolist(), high.tolist()) == (pytest.approx([0.5, 1.5, 2.5]), pytest.approx([1.5, 2.5, 3.5]))
    low, high = bounds_of((CAN,))
    assert (low.tolist(), high.tolist()) == (pytest.approx([0.8, 1.8, 2.5]), pytest.approx([1.2, 2.2, 3.5]))
    low, high = bounds_of((BOX,))
    assert (low.tolist(), high.tolist()) == (pytest.approx([0.9, 1.8, 2.7]), pytest.approx([1.1, 2.2, 3.3]))


def test_an_object_is_moved_to_the_middle_of_its_shapes_with_all_that_it_has() -> None:
    part = Region((1.5, 2.5, 3.5), (0.1, 0.1, 0.1), "upper")
    model = replace(BIN, shapes=(BOX,), region=replace(part, name=""), parts=(part,), frame=(0.2, 0.3, 0.4))
    found = centred(model)
    assert found.shapes[0].position == pytest.approx((0.0, 0.0, 0.0))
    assert found.region is not None
    assert found.region.center == found.parts[0].center == pytest.approx((0.5, 0.5, 0.5))
    assert found.parts[0].name == "upper"
    assert found.frame == pytest.approx((-0.8, -1.7, -2.6))
    assert found.rest_height == pytest.approx(0.3)
    assert centred(replace(model, region=None, parts=())).region is None


def test_a_real_bin_rests_on_its_bottom() -> None:
    low, high = bounds_of(centred(BIN).shapes)
    assert low.tolist() == pytest.approx((-high).tolist())
    assert centred(BIN).rest_height == pytest.approx(0.075)
    corners = [point for point, _ in outline_of(centred(BIN))]
    assert max(hypot(*point[:2]) for point in corners) == pytest.approx(hypot(0.15, 0.1))


FLOOR = Shape(ShapeKind.BOX, (0.15, 0.1, 0.005), (0.0, 0.0, 0.005))
INSIDE = Region((0.0, 0.0, 0.06), (0.14, 0.09, 0.05))


def walls(height: float, sides: str = "news") -> tuple[Shape, ...]:
    """Return walls of a height (m) above the floor of a tray, on some sides: north, east, west, south."""
    half = middle = (height + 0.01) / 2
    every = {
        "n": Shape(ShapeKind.BOX, (0.15, 0.005, half), (0.0, 0.1, middle)),
        "s": Shape(ShapeKind.BOX, (0.15, 0.005, half), (0.0, -0.1, middle)),
        "e": Shape(ShapeKind.BOX, (0.005, 0.1, half), (0.15, 0.0, middle)),
        "w": Shape(ShapeKind.BOX, (0.005, 0.1, half), (-0.15, 0.0, middle)),
    }
    return (FLOOR, *(every[side] for side in sides))


@pytest.mark.parametrize(
    ("shapes", "expected"),
    [
        (walls(0.1), True),
        (walls(0.1, "new"), False),
        (walls(0.1, "nsw"), False),
        (walls(0.008), False),
        ((FLOOR,), False),
    ],
    ids=["a bin", "no south wall", "no east wall", "a low rim", "a board"],
)
def test_a_workspace_is_walled_if_walls_rise_on_all_four_sides(shapes: tuple[Shape, ...], expected: bool) -> None:
    assert with_walls(INSIDE, shapes).walled is expected


def test_a_wall_may_consist_of_pieces_but_not_of_a_post() -> None:
    pieces = tuple(Shape(ShapeKind.BOX, (0.07, 0.005, 0.05), (x, 0.1, 0.05)) for x in (-0.08, 0.08))
    post = Shape(ShapeKind.BOX, (0.01, 0.005, 0.05), (0.0, 0.1, 0.05))
    assert with_walls(INSIDE, (*walls(0.1, "ews"), *pieces)).walled
    assert not with_walls(INSIDE, (*walls(0.1, "ews"), post)).walled


def test_a_roof_is_no_wall() -> None:
    roof = Shape(ShapeKind.BOX, (0.15, 0.1, 0.005), (0.0, 0.1, 0.1))
    assert not with_walls(INSIDE, (*walls(0.1, "ews"), roof)).walled


def test_a_wall_far_from_the_workspace_does_not_count() -> None:
    narrow = Region((0.0, 0.0, 0.06), (0.05, 0.09, 0.05))
    assert not with_walls(narrow, walls(0.1)).walled
