"""Frames of a scene instance: poses relative to each other, samples from distributions, and their errors."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from robbdd_tools.catalog.executable import Body, Law, Link
from robbdd_tools.world.errors import SceneError
from robbdd_tools.world.frames import Frames
from world.scene_instances import ROOT, SAMPLED, instance, link
from world.worlds import CUBE

HALF = sqrt(0.5)


def test_frames_are_composed_along_what_they_are_relative_to() -> None:
    quarter = (HALF, 0.0, 0.0, HALF)
    staged = instance(
        link("x:g.table.top", (1.0, 0.0, 0.5), turn=quarter), link("x:g.cube.mid", (0.2, 0.0, 0.1), "x:g.table.top")
    )
    pose = Frames(staged, 1).pose("x:g.cube", CUBE)
    assert pose is not None
    assert pose[0] == pytest.approx((1.0, 0.2, 0.6))
    assert pose[1] == pytest.approx(quarter)


def test_a_pose_leads_both_ways_and_goes_before_a_joint() -> None:
    mount = Link("x:g.arm.foot", "x:g.table.top", "fixed")
    hinge = Link("x:g.door.edge", "x:g.arm.foot", "revolute", (0.0, 0.0, 0.1), axes=("z", "x"))
    staged = instance(
        link(ROOT, (0.0, 0.0, -1.0), "x:g.table.top"), link("x:g.arm.foot", (0.0, 2.0, 0.0)), mount, hinge
    )
    frames = Frames(staged, 1)
    table, arm, door = (frames.pose(f"x:g.{name}", "e") for name in ("table", "arm", "door"))
    assert table is not None
    assert arm is not None
    assert door is not None
    assert table[0] == pytest.approx((0.0, 0.0, 1.0))
    assert arm[0] == pytest.approx((0.0, 2.0, 0.0))
    assert door[0] == pytest.approx((0.0, 2.0, 0.1))
    assert door[1] == pytest.approx((HALF, 0.0, -HALF, 0.0))


def test_a_body_that_nothing_places_has_no_pose() -> None:
    staged = instance(link("x:g.arm.foot", (0, 0, 0)))
    frames = Frames(replace(staged, bodies=(*staged.bodies, Body("x:g.cube", ("x:g.cube.mid",)))), 1)
    assert frames.pose("x:g.cube", CUBE) is None
    assert frames.pose("x:g.world", "e") is not None


def test_what_no_frame_leads_to_is_an_error_with_its_place() -> None:
    staged = instance(link("x:g.cube.mid", (0, 0, 0), "x:g.shelf.board"))
    with pytest.raises(
        SceneError, match=r"cell\.scenex:4:9: the body 'x:g\.cube' is placed nowhere.*'x:g\.world\.root'"
    ):
        Frames(staged, 1).pose("x:g.cube", CUBE)


def drawn(law: Law, seed: int = 1, element: str = CUBE, attempt: int = 0) -> np.ndarray:
    pose = Frames(instance(SAMPLED, laws=(law,)), seed).pose("x:g.cube", element, attempt)
    assert pose is not None
    return pose[0]


UNIFORM = Law("x:spread", "uniform", (25.0, -40.0, 2.0), (60.0, 40.0, 2.0))


def test_samples_follow_from_the_seed_and_differ_between_the_members_of_a_set() -> None:
    assert drawn(UNIFORM).tolist() == drawn(UNIFORM).tolist()
    others = [drawn(UNIFORM, 2), drawn(UNIFORM, element="env:cube2"), drawn(UNIFORM, attempt=1)]
    assert all(drawn(UNIFORM).tolist() != other.tolist() for other in others)


def test_a_uniform_sample_keeps_within_its_bounds_and_unit() -> None:
    found = np.array([drawn(UNIFORM, seed) for seed in range(200)])
    assert found.min(axis=0) == pytest.approx((0.25, -0.40, 0.02), abs=0.02)
    assert found.max(axis=0) == pytest.approx((0.60, 0.40, 0.02), abs=0.02)
    assert (found[:, 0] >= 0.25).all()
    assert (found[:, 0] <= 0.60).all()


def test_a_normal_sample_has_its_mean_and_covariance() -> None:
    law = Law("x:spread", "normal", mean=(10.0, 0.0, 50.0), covariance=(4.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.25))
    found = np.array([drawn(law, seed) for seed in range(3000)]) / 0.01
    assert found.mean(axis=0) == pytest.approx((10.0, 0.0, 50.0), abs=0.15)
    assert np.cov(found.T) == pytest.approx(np.array(law.covariance).reshape(3, 3), abs=0.3)


def test_every_rotation_is_drawn_alike() -> None:
    turned = replace(link("x:g.cube.mid", (0, 0, 0)), rotation=(), rotation_law="x:tumble")
    law = Law("x:tumble", "uniform-rotation")
    poses = [Frames(instance(turned, laws=(law,)), seed).pose("x:g.cube", CUBE) for seed in range(2000)]
    turns = np.array([pose[1] for pose in poses if pose is not None])
    assert np.linalg.norm(turns, axis=1) == pytest.approx(np.ones(2000))
    # The mean angle of uniform random rotations is π/2 + 2/π.
    assert (2 * np.arccos(np.abs(turns[:, 0]))).mean() == pytest.approx(pi / 2 + 2 / pi, abs=0.04)


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (
            Law("x:spread", "normal", mean=(0, 0, 0), covariance=(1, 0, 0, 0, 1, 0, 0, 0, 0)),
            "has a singular covariance",
        ),
        (Law("x:spread", "normal", mean=(0, 0, 0), covariance=(1, 2, 0, 0, 1, 0, 0, 0, 1)), "is not symmetric"),
        (Law("x:spread", "normal", mean=(0, 0, 0), covariance=(1.0,)), "needs a covariance of 3 × 3 numbers"),
        (Law("x:spread", "uniform", (0.0,), (1.0,)), "a position needs 3 numbers, not 1"),
    ],
)
def test_a_distribution_that_cannot_be_drawn_from_is_an_error(law: Law, words: str) -> None:
    with pytest.raises(SceneError, match=words):
        drawn(law)
