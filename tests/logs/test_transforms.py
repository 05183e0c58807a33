"""Poses of frames in other frames: chains of transforms, interpolation, gaps. Matrices are the oracle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robbdd_tools.logs.log_contents import Track
from robbdd_tools.logs.transforms import Unconnected, poses_at, product, root_of, steadier_poses_at

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

QUARTER = (np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5))
"""A quarter turn about z."""


def track(
    parent: str,
    *poses: tuple[float, tuple[float, float, float]],
    turn: tuple[float, ...] = (1, 0, 0, 0),
    static: bool = False,
) -> Track:
    times = np.array([time for time, _ in poses], dtype=float)
    places = np.array([place for _, place in poses], dtype=float)
    return Track(parent, times, places, np.tile(np.array(turn, dtype=float), (len(poses), 1)), static)


def at(frame: str, reference: str, tracks: dict[str, Track], *times: float, max_gap: float = 1.0) -> list[list[float]]:
    places, _ = poses_at(frame, reference, tracks, np.array(times), max_gap)
    return [[round(float(value), 9) for value in place] for place in places]


def test_a_pose_between_two_is_interpolated() -> None:
    tracks = {"cup": track("map", (0.0, (0, 0, 0)), (1.0, (2, 0, 4)))}
    assert at("cup", "map", tracks, 0.0, 0.25, 1.0) == [[0, 0, 0], [0.5, 0, 1], [2, 0, 4]]


@pytest.mark.parametrize(("lies", "found"), [(True, [0.3, 0.0, 0.0]), (False, [0.9, 0.0, 0.0])])
def test_between_two_poses_a_frame_is_where_it_moves_less(lies: bool, found: list[float]) -> None:
    """A hand moves by 1 m within half a second and stops. A part lies still, or moves with the hand."""
    hand = [(tick / 100, (min(tick / 50, 1.0), 0.0, 0.0)) for tick in range(101)]
    part = [(0.0, (0.3, 0.0, 0.0)), (1.0, (-0.7 if lies else 0.3, 0.0, 0.0))]
    tracks = {"hand": track("map", *hand), "part": track("camera", *part)}
    tracks["camera"] = track("hand", (0.0, (0.0, 0.0, 0.0)), static=True)
    place, turn = steadier_poses_at("part", "map", tracks, np.array([0.3]), 1.0)
    assert place[0].tolist() == pytest.approx(found)
    assert turn[0].tolist() == pytest.approx([1, 0, 0, 0])
    known = steadier_poses_at("part", "map", tracks, np.array([1.1]), 1.0)[0]
    assert np.isnan(known).all()


def test_nothing_is_known_in_a_gap_and_beyond_the_ends() -> None:
    tracks = {"cup": track("map", (1.0, (0, 0, 0)), (1.5, (1, 0, 0)), (3.0, (2, 0, 0)))}
    found = np.array(at("cup", "map", tracks, 0.9, 1.0, 1.25, 1.5, 2.0, 3.0, 3.1, max_gap=0.5))
    assert np.isnan(found[:, 0]).tolist() == [True, False, False, False, True, False, True]


def test_a_frame_that_never_moves_is_known_at_all_times() -> None:
    tracks = {"table": track("map", (5.0, (1, 2, 3)), static=True)}
    assert at("table", "map", tracks, 0.0, 9.0) == [[1, 2, 3], [1, 2, 3]]


def test_transforms_are_chained_through_turned_frames() -> None:
    tracks = {
        "arm": track("map", (0.0, (1, 0, 0)), turn=QUARTER, static=True),
        "tool": track("arm", (0.0, (0, 0, 1)), (1.0, (1, 0, 1))),
    }
    assert at("tool", "map", tracks, 1.0) == [[1, 1, 1]]
    assert at("map", "tool", tracks, 1.0) == [[-1, 1, -1]]


def test_frames_are_related_by_the_frame_that_they_share() -> None:
    tracks = {
        "map": track("earth", (0.0, (9, 9, 9)), static=True),
        "camera": track("map", (0.0, (0, 1, 0)), static=True),
        "cup": track("map", (0.0, (3, 1, 0)), static=True),
    }
    assert at("cup", "camera", tracks, 0.0) == [[3, 0, 0]]
    assert root_of("cup", tracks) == "earth"


def test_frames_of_different_trees_are_refused() -> None:
    tracks = {"cup": track("camera", (0.0, (0, 0, 0)), static=True)}
    with pytest.raises(Unconnected, match="'cup' is connected to 'camera', but not to 'map'"):
        at("cup", "map", tracks, 0.0)


def test_a_circle_is_refused() -> None:
    tracks = {"a": track("b", (0.0, (0, 0, 0)), static=True), "b": track("a", (0.0, (0, 0, 0)), static=True)}
    with pytest.raises(Unconnected, match="circle: a → b → a"):
        root_of("a", tracks)


def test_a_rotation_is_interpolated_along_the_shorter_arc() -> None:
    times, places = np.array([0.0, 1.0]), np.zeros((2, 3))
    turns = np.array([(1.0, 0.0, 0.0, 0.0), (-QUARTER[0], 0.0, 0.0, -QUARTER[3])])
    _, found = poses_at("cup", "map", {"cup": Track("map", times, places, turns)}, np.array([0.5]), 1.0)
    eighth = (np.cos(np.pi / 8), 0.0, 0.0, np.sin(np.pi / 8))
    assert abs(float(np.dot(found[0], eighth))) == pytest.approx(1.0)


def matrix(turn: FloatArray, place: FloatArray) -> FloatArray:
    w, x, y, z = turn
    found = np.eye(4)
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    found[:3, 3] = place
    return found


NUMBERS = st.floats(-3, 3)
POSES = st.lists(
    st.tuples(*[NUMBERS] * 7).filter(lambda values: np.linalg.norm(values[3:]) > 0.1), min_size=3, max_size=3
)


@given(POSES)
def test_a_chain_equals_the_product_of_its_matrices(poses: list[tuple[float, ...]]) -> None:
    frames, parents = ("arm", "tool", "camera"), ("map", "arm", "map")
    tracks: dict[str, Track] = {}
    matrices: dict[str, FloatArray] = {"map": np.eye(4)}
    for frame, parent, pose in zip(frames, parents, poses, strict=True):
        turn = np.array(pose[3:]) / np.linalg.norm(pose[3:])
        tracks[frame] = Track(parent, np.zeros(1), np.array([pose[:3]]), turn[None], static=True)
        matrices[frame] = matrices[parent] @ matrix(turn, np.array(pose[:3]))
    place, turn = poses_at("tool", "camera", tracks, np.zeros(1), 1.0)
    expected = np.linalg.inv(matrices["camera"]) @ matrices["tool"]
    assert matrix(turn[0], place[0]) == pytest.approx(expected, abs=1e-9)


@given(POSES)
def test_a_product_with_the_inverse_is_no_rotation(poses: list[tuple[float, ...]]) -> None:
    turn = np.array(poses[0][3:]) / np.linalg.norm(poses[0][3:])
    found = product(turn[None], turn[None] * (1, -1, -1, -1))
    assert found[0] == pytest.approx([1, 0, 0, 0], abs=1e-9)


def test_a_frame_without_orientation_has_a_place_and_gives_none_to_what_is_away_from_it() -> None:
    times, turned = np.array([0.0, 1.0]), np.tile((1.0, 0.0, 0.0, 0.0), (2, 1))
    tracks = {
        "part": Track("map", times, np.array([[1.0, 0, 0], [3, 0, 0]]), np.full((2, 4), np.nan)),
        "pin": Track("part", times, np.array([[0.0, 0, 0.1], [0, 0, 0.1]]), turned),
    }
    place, turn = poses_at("part", "map", tracks, np.array([0.5]), 2.0)
    assert place.tolist() == [[2.0, 0.0, 0.0]]
    assert np.isnan(turn).all()
    assert np.isnan(poses_at("pin", "map", tracks, np.array([0.5]), 2.0)[0]).any()
