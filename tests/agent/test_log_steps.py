"""Remarks on frames of an odometry that step, as a localisation makes them do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from robbdd_tools.agent.log_steps import steps_of_frames
from robbdd_tools.logs.log_contents import Track


def track(parent: str, places: Sequence[float], turns: Sequence[float] | None = None) -> Track:
    """A frame at places along x (m), turned about z (degrees), one each 0.1 s."""
    half = np.radians(turns if turns is not None else [0.0] * len(places)) / 2
    count = len(places)
    positions = np.stack([np.array(places), np.zeros(count), np.zeros(count)], axis=1)
    orientations = np.stack([np.cos(half), np.zeros(count), np.zeros(count), np.sin(half)], axis=1)
    return Track(parent, np.arange(count) / 10, positions, orientations)


def remarks(odometry: Track, *, frame: str = "odom", world: str = "map") -> list[str]:
    tracks = {frame: odometry, "base_link": track(frame, [0.1 * tick for tick in range(len(odometry.times))])}
    return list(steps_of_frames(["base_link"], tracks, world))


@pytest.mark.parametrize(
    ("places", "turns", "words"),
    [
        ([0, 0, 0.05, 0.05], None, "(by 50 mm at 0.20 s)"),
        ([0, 0.05, 0.05, 0.05, 0.1, 0.1], None, "(by 50 mm at 0.10 s, and 1 more)"),
        ([0, 0, 0, 0], [0, 0, 3, 3], "(by 3.0° at 0.20 s)"),
        ([0, 0, 0.05, 0.05], [0, 0, -3, -3], "(by 50 mm and 3.0° at 0.20 s)"),
    ],
)
def test_a_step_has_its_size_and_its_time(places: list[float], turns: list[float] | None, words: str) -> None:
    (remark,) = remarks(track("map", places, turns))
    assert remark.startswith(f"the frame 'odom' steps in 'map' {words}")
    assert "--world odom leaves the steps out" in remark


@pytest.mark.parametrize(
    "places",
    [[0.0, 0.05, 0.1, 0.15], [0.0, 0.0, 0.01, 0.01], [0.0], [0.0, 0.03, 0.05, 0.05]],
    ids=["moves", "small", "one report", "corrected slowly"],
)
def test_what_is_no_step_is_not_reported(places: list[float]) -> None:
    assert remarks(track("map", places)) == []


def test_frames_that_are_no_odometry_and_the_world_itself_are_not_reported() -> None:
    stepping = track("map", [0, 0, 0.05, 0.05])
    assert remarks(stepping, frame="link3") == []
    assert remarks(stepping, world="odom") == []


def test_the_frame_of_the_robot_itself_and_frames_in_a_circle_end_the_search() -> None:
    stepping = track("map", [0, 0, 0.05, 0.05])
    assert list(steps_of_frames(["odom", "absent"], {"odom": stepping}, "map")) == []
    circle = {"base_link": track("odom", [0, 0]), "odom": track("base_link", [0, 0])}
    assert list(steps_of_frames(["base_link"], circle, "map")) == []


def test_a_position_without_orientation_steps_by_its_distance() -> None:
    seen = track("map", [0, 0, 0.05, 0.05])
    without = Track("map", seen.times, seen.positions, np.full_like(seen.orientations, np.nan))
    assert "(by 50 mm at 0.20 s)" in remarks(without)[0]
