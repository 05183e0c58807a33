"""Poses of frames at an offset in another one."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from robbdd_tools.world.pose import Pose

HALF = sqrt(0.5)


@pytest.mark.parametrize(
    ("pose", "expected"),
    [
        (Pose((10.0, 20.0, 30.0)), (11.0, 22.0, 33.0)),
        (Pose((10.0, 20.0, 30.0), pi / 2), (8.0, 21.0, 33.0)),
        (Pose((10.0, 20.0, 30.0), -pi / 2), (12.0, 19.0, 33.0)),
        (Pose((10.0, 20.0, 30.0), pi), (9.0, 18.0, 33.0)),
        (Pose((10.0, 20.0, 30.0), rotation=(HALF, HALF, 0.0, 0.0)), (11.0, 17.0, 32.0)),
        (Pose((10.0, 20.0, 30.0), rotation=(HALF, 0.0, HALF, 0.0)), (13.0, 22.0, 29.0)),
        (Pose((10.0, 20.0, 30.0), rotation=(HALF, 0.0, 0.0, HALF)), (8.0, 21.0, 33.0)),
    ],
)
def test_an_offset_turns_with_its_frame(pose: Pose, expected: tuple[float, float, float]) -> None:
    found = pose.at((1.0, 2.0, 3.0))
    assert found.position == pytest.approx(expected)
    assert (found.yaw, found.rotation) == (pose.yaw, pose.rotation)


def test_a_rotation_about_any_axis_is_that_of_its_matrix() -> None:
    w, x, y, z = 0.5, 0.1, -0.7, 0.5
    matrix = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    offset = (0.3, -0.2, 0.9)
    assert Pose((0.0, 0.0, 0.0), rotation=(w, x, y, z)).at(offset).position == pytest.approx(matrix @ offset)
