"""Frames that change their parent, as an object does that a robot grasps: never a place that nobody reported."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from logs.bags import ROS2, Message, text, transform, write
from robbdd_tools.logs.log_contents import LogContents, Track
from robbdd_tools.logs.log_period import cut
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.logs.transforms import Unconnected, poses_at


def grasped() -> list[Message]:
    """A cup stands at x = 1 m, is carried from 2 s to 4 s, 0.1 m below the tool, and stands at x = 3 m."""
    found: list[Message] = []
    for tick in range(61):
        time = 1 + tick / 10
        at = tick / 10
        tool = min(max(at - 1, 1.0), 3.0)
        found.append(transform("tool", (tool, 0, 1), stamp=time))
        if 2.0 <= at < 4.0:
            found.append(transform("cup", (0, 0, -0.1), stamp=time, parent="tool"))
        else:
            found.append(transform("cup", (1 if at < 2 else 3, 0, 0.9), stamp=time))
        found.append(transform("lid", (0, 0, 0.05), stamp=time, parent="cup"))
    return found


def places(found: LogContents, frame: str, times: list[float]) -> list[list[float]]:
    return poses_at(frame, "map", found.tracks, np.array(times), 0.5)[0].round(9).tolist()


def test_a_grasped_frame_is_where_its_parent_at_that_time_has_it(tmp_path: Path) -> None:
    found = read_log(write(tmp_path / "drive", grasped()))
    assert places(found, "cup", [0.0, 1.85, 2.0, 3.05, 3.9, 4.0, 6.0]) == [
        [1, 0, 0.9],
        [1, 0, 0.9],
        [1, 0, 0.9],
        [2.05, 0, 0.9],
        [2.9, 0, 0.9],
        [3, 0, 0.9],
        [3, 0, 0.9],
    ]
    assert places(found, "lid", [3.05]) == [[2.05, 0, 0.95]]
    assert np.isnan(places(found, "cup", [1.95, 3.95])).all(), "between two parents, nobody reports where it is"
    words = "frame 'cup' changes its parent 2 times: 'map', 'tool'; it has no place between two of them"
    assert words in found.remarks


def test_a_period_of_the_log_has_the_parents_of_that_period(tmp_path: Path) -> None:
    found = cut(read_log(write(tmp_path / "drive", grasped())), 2.5, 3.5)
    assert places(found, "cup", [0.0, 0.5, 1.0]) == [[1.5, 0, 0.9], [2, 0, 0.9], [2.5, 0, 0.9]]


def test_a_parent_that_is_not_connected_gives_no_place(tmp_path: Path) -> None:
    messages = [one for one in grasped() if one.make(ROS2).transforms[0].child_frame_id != "tool"]
    found = read_log(write(tmp_path / "drive", messages))
    assert places(found, "cup", [1.0, 5.0]) == [[1, 0, 0.9], [3, 0, 0.9]]
    assert np.isnan(places(found, "cup", [3.0])).all()


@pytest.mark.parametrize(
    ("parents", "known"),
    [
        # (parent, time of its poses in s)
        ([("map", 1.0), ("camera", 1.2), ("map", 1.4), ("camera", 1.6)], False),
        ([("map", 1.0), ("camera", 1.0)], False),
        ([("map", 1.0), ("camera", 1.5)], True),
        ([("map", 1.0), ("camera", 1.5), ("map", 2.5)], True),
    ],
)
def test_two_parents_at_once_are_no_change(parents: list[tuple[str, float]], known: bool, tmp_path: Path) -> None:
    messages = [transform("cup", (5, 0, 0), stamp=time, parent=parent) for parent, time in parents]
    found = read_log(write(tmp_path / "drive", [*messages, text("end", 9.0)]))
    assert np.isfinite(found.tracks["cup"].positions).any() == known
    assert any("'cup' has two parents, 'map' and 'camera'" in one for one in found.remarks) != known


def test_a_static_frame_that_also_moves_has_two_parents(tmp_path: Path) -> None:
    messages = [transform("cup", (0, 0, 0), stamp=1.0, parent="shelf", topic="/tf_static"), *grasped()[1::3]]
    found = read_log(write(tmp_path / "drive", messages))
    assert np.isnan(found.tracks["cup"].positions).all()


@st.composite
def chains(draw: st.DrawFn) -> tuple[dict[str, Track], dict[float, dict[str, tuple[str, float]]]]:
    """Draw the parents and the x of three frames at each second, with the tracks that say so."""
    states: dict[float, dict[str, tuple[str, float]]] = {}
    order = ("a", "b", "c")
    for second in range(draw(st.integers(2, 6))):
        states[float(second)] = {
            # A parent comes before its child in the order, so there is no circle.
            frame: (draw(st.sampled_from(["map", *order[:index]])), draw(st.integers(1, 9)) / 1.0)
            for index, frame in enumerate(order)
        }
    from robbdd_tools.logs.track_builder import TrackBuilder

    builder = TrackBuilder()
    for time, frames in states.items():
        for frame, (parent, x) in frames.items():
            builder.add(frame, parent, round(time * 1e9), (x, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    return builder.tracks(0, []), states


@given(chains())
def test_at_each_report_the_place_is_that_of_the_chain_then(
    drawn: tuple[dict[str, Track], dict[float, dict[str, tuple[str, float]]]],
) -> None:
    tracks, states = drawn
    for time, frames in states.items():
        for frame in frames:
            expected, current = 0.0, frame
            while current != "map":
                current, x = frames[current]
                expected += x
            try:
                (found,) = poses_at(frame, "map", tracks, np.array([time]), 5.0)[0]
            except Unconnected:
                pytest.fail("every chain ends at the map")
            assert found.tolist() == [expected, 0.0, 0.0]
            middle = poses_at(frame, "map", tracks, np.array([time + 0.5]), 5.0)[0]
            after = states.get(time + 1.0)
            if after is None or any(after[one][0] != frames[one][0] for one in on_the_way(frame, frames)):
                assert np.isnan(middle).all()
            else:
                assert np.isfinite(middle).all()


def on_the_way(frame: str, frames: dict[str, tuple[str, float]]) -> list[str]:
    found: list[str] = []
    while frame != "map":
        found.append(frame)
        frame = frames[frame][0]
    return found
