"""Grasps of objects in different orientations."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from robbdd_tools.catalog.api import ObjectModel, Shape, ShapeKind
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.world.errors import BehaviourError
from robbdd_tools.world.grasp import Grasp, finger_grasps, suction_grasps

OBJECTS = load_catalog().objects
AT = np.array([0.4, 0.1, 0.2])
UPRIGHT = np.eye(3)
STROKE = 0.08


def thing(kind: ShapeKind, *size: float) -> ObjectModel:
    a, b, c = (*size, 0.0, 0.0)[:3]
    return ObjectModel("x", ("x",), (Shape(kind, (a, b, c)),), 0.1, 0.5, True, True, c, (1, 1, 1, 1), "X.")


def test_a_cube_is_taken_across_its_faces_at_its_middle() -> None:
    found = finger_grasps("cube", OBJECTS["cube"], AT, UPRIGHT, STROKE)
    assert sorted(round(grasp.closing % pi, 6) for grasp in found) == [0.0, round(pi / 2, 6)]
    assert all(grasp.width == pytest.approx(0.0315) for grasp in found)
    assert all(grasp.position == pytest.approx(AT) for grasp in found)


def test_the_grasp_turns_with_the_object() -> None:
    half = sqrt(0.5)
    turned = np.array([[half, -half, 0.0], [half, half, 0.0], [0.0, 0.0, 1.0]])
    found = finger_grasps("cube", OBJECTS["cube"], AT, turned, STROKE)
    assert sorted(round(grasp.closing % pi, 6) for grasp in found) == [round(pi / 4, 6), round(3 * pi / 4, 6)]


def test_a_ball_is_taken_from_every_side() -> None:
    assert len(finger_grasps("ball", OBJECTS["ball"], AT, UPRIGHT, STROKE)) == 8


def test_a_flat_thing_is_taken_only_where_it_is_narrow_enough() -> None:
    (only,) = finger_grasps("plate", thing(ShapeKind.BOX, 0.06, 0.02, 0.01), AT, UPRIGHT, STROKE)
    assert only.width == pytest.approx(0.04)
    assert abs(only.closing) == pytest.approx(pi / 2)


def test_a_tipped_thing_is_taken_as_it_lies() -> None:
    tipped = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    found = finger_grasps("rod", thing(ShapeKind.BOX, 0.1, 0.02, 0.03), AT, tipped, STROKE)
    assert sorted(grasp.width for grasp in found) == pytest.approx([0.04, 0.06])


def test_a_tall_thing_is_taken_no_deeper_than_the_fingers_reach() -> None:
    found = finger_grasps("post", thing(ShapeKind.CYLINDER, 0.02, 0.1), AT, UPRIGHT, STROKE)
    assert all(grasp.position[2] == pytest.approx(0.2 + 0.1 - 0.03) for grasp in found)


def test_what_is_too_wide_is_explained() -> None:
    with pytest.raises(BehaviourError, match=r"crate is 0\.200 m wide, the gripper opens 0\.080 m"):
        finger_grasps("crate", thing(ShapeKind.BOX, 0.1, 0.1, 0.1), AT, UPRIGHT, STROKE)


def test_what_is_narrower_than_a_closed_gripper_is_explained() -> None:
    with pytest.raises(BehaviourError, match=r"pin is 0\.020 m wide, the gripper closes to 0\.020 m"):
        finger_grasps("pin", thing(ShapeKind.BOX, 0.01, 0.01, 0.1), AT, UPRIGHT, STROKE, 0.02)
    (only,) = finger_grasps("strip", thing(ShapeKind.BOX, 0.015, 0.01, 0.1), AT, UPRIGHT, STROKE, 0.02)
    assert only.width == pytest.approx(0.03)


def made_of(*parts: tuple[tuple[float, float, float], tuple[float, float, float]]) -> ObjectModel:
    """Return an object of boxes, each given by half edges and position (m)."""
    shapes = tuple(Shape(ShapeKind.BOX, size, place) for size, place in parts)
    return ObjectModel("x", ("x",), shapes, 0.1, 0.5, True, True, 0.0, (1, 1, 1, 1), "X.")


PLATE = ((0.04, 0.035, 0.004), (0.0, 0.0, -0.025))
LEG = ((0.004, 0.03, 0.025), (0.036, 0.0, 0.004))


def test_a_part_beside_the_middle_is_taken_after_the_middle() -> None:
    plate, *of_leg = finger_grasps("bracket", made_of(PLATE, LEG), AT, UPRIGHT, STROKE)
    assert plate.part is None
    assert {leg.part for leg in of_leg} == {1}
    assert [leg.width for leg in of_leg] == pytest.approx([0.008, 0.06])
    assert all(leg.position == pytest.approx([0.436, 0.1, 0.204]) for leg in of_leg)
    assert all(leg.aside == pytest.approx((-0.036, 0.0)) for leg in of_leg)


def test_what_fits_without_play_is_said_to_need_it() -> None:
    with pytest.raises(
        BehaviourError, match=r"wide, the gripper opens 0\.033 m; with 4 mm of play, that is too little"
    ):
        finger_grasps("cube", OBJECTS["cube"], AT, UPRIGHT, 0.033)


def test_what_is_too_wide_in_its_middle_is_taken_at_a_wall() -> None:
    walls = [((0.1, 0.003, 0.04), (0.0, side * 0.1, 0.04)) for side in (-1, 1)]
    found = finger_grasps("crate", made_of(((0.1, 0.1, 0.003), (0.0, 0.0, 0.0)), *walls), AT, UPRIGHT, STROKE)
    assert {grasp.part for grasp in found} == {1, 2}
    assert all(grasp.width == pytest.approx(0.006) for grasp in found)


def test_a_part_below_another_one_or_without_room_for_a_finger_is_not_taken() -> None:
    beside = ((0.004, 0.03, 0.04), (0.024, 0.0, 0.02))
    for other in (((0.05, 0.02, 0.004), (0.036, 0.0, 0.05)), beside):
        found = finger_grasps("stack", made_of(PLATE, LEG, other), AT, UPRIGHT, STROKE)
        assert 1 not in {grasp.part for grasp in found}


def test_a_cup_takes_hold_on_the_top() -> None:
    for kind in ("cube", "ball", "box"):
        model = OBJECTS[kind]
        found = suction_grasps(kind, model, AT, UPRIGHT, 0.03)
        assert all(grasp.position == pytest.approx([0.4, 0.1, 0.2 + model.rest_height]) for grasp in found)
        assert all(grasp.below == pytest.approx(2 * model.rest_height) for grasp in found)


def test_what_is_smaller_than_the_cup_is_explained() -> None:
    with pytest.raises(BehaviourError, match=r"bolt is 0\.020 m wide, the suction cup 0\.030 m"):
        suction_grasps("bolt", thing(ShapeKind.BOX, 0.01, 0.02, 0.01), AT, UPRIGHT, 0.03)


def test_a_grasp_may_be_higher_as_long_as_the_fingers_hold_enough() -> None:
    grasp = Grasp(np.array([0.1, 0.2, 0.3]), 0.5, 0.04, below=0.01, depth=0.019)
    found = [(float(one.position[2]), one.below, one.depth) for one in grasp.higher()]
    assert found == [pytest.approx((0.305, 0.015, 0.014)), pytest.approx((0.31, 0.02, 0.009))]
