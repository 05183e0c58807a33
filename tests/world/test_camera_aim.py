"""The camera of a whole scene sees all of it, however large it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.world.camera_aim import aim, corners_of
from robbdd_tools.world.engine import mujoco
from world.worlds import execution

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

FIELD, ASPECT = 45.0, 1.6
coordinates = st.floats(-20.0, 20.0)
scenes = st.lists(st.tuples(coordinates, coordinates, st.floats(0.0, 5.0)), min_size=2, max_size=20, unique=True)


def shares(seen: FloatArray, azimuth: float, elevation: float) -> FloatArray:
    """Return where points are in a picture: (n, 2), from -1 to 1 across and upwards; behind the camera: infinity."""
    target, distance = aim(seen, azimuth, elevation, FIELD, ASPECT)
    camera = mujoco.MjvCamera()
    camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = target, distance, azimuth, elevation
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    scene = mujoco.MjvScene(model, 10)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    everything = mujoco.mjtCatBit.mjCAT_ALL
    mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, camera, everything, scene)
    left, right = scene.camera
    place, ahead, above = (left.pos + right.pos) / 2, np.array(left.forward), np.array(left.up)
    ray = seen - place
    depth = ray @ ahead
    reach = np.tan(np.radians(FIELD) / 2)
    found = np.stack([ray @ np.cross(ahead, above) / (reach * ASPECT), ray @ above / reach], axis=1)
    return np.where(depth[:, None] > 0.0, found / depth[:, None], np.inf)


@given(scenes, st.floats(-180.0, 180.0), st.floats(-80.0, -5.0))
def test_every_point_is_in_the_picture(
    seen: list[tuple[float, float, float]], azimuth: float, elevation: float
) -> None:
    assert np.abs(shares(np.array(seen), azimuth, elevation)).max() <= 1.0


def test_the_scene_fills_the_picture() -> None:
    simulation = execution().simulation
    found = shares(corners_of(simulation.model, simulation.data), 128.0, -36.0)
    assert np.abs(found).max() == pytest.approx(1 / 1.06, abs=0.02)
    middle = (found.min(axis=0) + found.max(axis=0)) / 2
    assert middle == pytest.approx([0.0, 0.0], abs=0.02)


def test_the_floor_does_not_count() -> None:
    simulation = execution().simulation
    found = corners_of(simulation.model, simulation.data)
    assert np.abs(found).max() < 3.0
