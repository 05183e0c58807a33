"""Frames that several topics publish are never mixed; one whose place is unclear is a frame without a place."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from logs.bags import Message, header, pose, text, transform, write
from robbdd_tools.logs.log_contents import LogContents
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.logs.transforms import poses_at


def read(folder: Path, messages: list[Message]) -> LogContents:
    return read_log(write(folder / "drive", messages))


def odometry(topic: str, child: str, x: float, stamp: float, parent: str = "odom") -> Message:
    def make(store: Any) -> Any:
        types = store.types
        nothing = types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
        pose = types["geometry_msgs/msg/Pose"](
            position=types["geometry_msgs/msg/Point"](x, 0.0, 0.0),
            orientation=types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
        )
        still = types["geometry_msgs/msg/Twist"](linear=nothing, angular=nothing)
        return types["nav_msgs/msg/Odometry"](
            header=header(store, stamp, parent),
            child_frame_id=child,
            pose=types["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=np.zeros(36)),
            twist=types["geometry_msgs/msg/TwistWithCovariance"](twist=still, covariance=np.zeros(36)),
        )

    return Message(topic, stamp, "nav_msgs/msg/Odometry", make)


def robot(space: str, x: float) -> list[Message]:
    """A robot whose transforms are in a namespace: a base that drives, and a tool that is fixed to it."""
    base = [transform("base_link", (x, 0, 0), stamp=1 + tick / 10, topic=f"{space}/tf") for tick in range(10)]
    tool = transform("tool0", (0, 0, 1), stamp=1.0, parent="base_link", topic=f"{space}/tf_static")
    return [tool, *base]


def place(found: LogContents, frame: str) -> list[float]:
    places, _ = poses_at(frame, "map", found.tracks, np.array([0.5]), 1.0)
    return [round(float(value), 6) for value in places[0]]


def test_robots_with_frames_of_the_same_names_are_told_apart_by_their_namespaces(tmp_path: Path) -> None:
    found = read(tmp_path, [*robot("/r1", 1.0), *robot("/r2", 2.0)])
    assert {frame: track.parent for frame, track in found.tracks.items()} == {
        "r1/base_link": "map",
        "r1/tool0": "r1/base_link",
        "r2/base_link": "map",
        "r2/tool0": "r2/base_link",
    }
    assert (place(found, "r1/tool0"), place(found, "r2/tool0")) == ([1, 0, 1], [2, 0, 1])
    words = "several topics have frames of the same names: those of '/r2/tf' are called 'r2/tool0', 'r2/base_link'"
    assert words in found.remarks


def test_a_namespace_does_not_change_names_that_are_there_once(tmp_path: Path) -> None:
    found = read(tmp_path, robot("/r1", 1.0))
    assert set(found.tracks) == {"base_link", "tool0"}
    found = read(tmp_path / "plain", [*robot("", 1.0), *robot("/r2", 2.0)])
    assert set(found.tracks) == {"base_link", "tool0", "r2/base_link", "r2/tool0"}
    assert place(found, "tool0") == [1, 0, 1]


def test_odometries_of_one_frame_are_called_by_their_topics(tmp_path: Path) -> None:
    wheels = [odometry("/wheel/odom", "base_link", 1.0, 1 + tick / 10) for tick in range(10)]
    camera = [odometry("/visual/odom", "base_link", 2.0, 1 + tick / 10) for tick in range(10)]
    found = read(tmp_path, [*wheels, *camera])
    assert {frame: track.positions[0, 0] for frame, track in found.tracks.items()} == {
        "wheel/odom": 1.0,
        "visual/odom": 2.0,
    }
    assert "several topics have poses of 'base_link': they are called 'visual/odom', 'wheel/odom'" in [
        one.replace("'wheel/odom', 'visual/odom'", "'visual/odom', 'wheel/odom'") for one in found.remarks
    ]


def test_transforms_outrank_odometry_and_poses_of_the_same_name(tmp_path: Path) -> None:
    moved = [transform("base_link", (5, 0, 0), stamp=1 + tick / 10, parent="odom") for tick in range(10)]
    wheels = [odometry("/odom", "base_link", 1.0, 1 + tick / 10) for tick in range(10)]
    found = read(tmp_path / "odom", [*moved, *wheels])
    assert found.tracks["base_link"].positions[:, 0].tolist() == [5.0] * 10
    assert not any("base_link" in one for one in found.remarks)
    goal = [pose("/base_link", (9, 9, 9), stamp=1 + tick / 10) for tick in range(10)]
    found = read(tmp_path / "goal", [*moved, *goal])
    assert found.tracks["base_link"].positions[:, 0].tolist() == [5.0] * 10
    words = "'base_link' is in 'map' on '/base_link', but in 'odom' by the transforms, which are used"
    assert words in found.remarks


def test_a_frame_with_two_parents_has_no_place_and_neither_have_its_children(tmp_path: Path) -> None:
    messages = [
        transform("cup", (0, 0, 0), stamp=1.0),
        transform("cup", (0, 0, 0), stamp=1.5, parent="camera"),
        transform("cup", (0, 0, 0), stamp=1.9),
        transform("lid", (0, 0, 0), stamp=1.0, parent="cup", topic="/tf_static"),
        transform("mug", (1, 0, 0), stamp=1.0),
        transform("mug", (1, 0, 0), stamp=2.0),
    ]
    found = read(tmp_path, messages)
    words = "frame 'cup' has two parents, 'map' and 'camera': publish one of them only; its place is not known"
    assert words in found.remarks
    assert np.isnan([place(found, "cup"), place(found, "lid")]).all()
    assert place(found, "mug") == [1, 0, 0]


def test_a_static_frame_that_moves_has_no_place(tmp_path: Path) -> None:
    same = [transform("bench", (0, 0, 0), stamp=time, topic="/tf_static") for time in (1.0, 2.0)]
    assert read(tmp_path / "same", same).tracks["bench"].static
    moved = [*same, transform("bench", (0, 0, 0.1), stamp=3.0, topic="/tf_static"), text("pick-end", 1.0)]
    found = read(tmp_path / "moved", moved)
    assert np.isnan(place(found, "bench")).all()
    assert "frame 'bench' has several static poses: its place is not known" in found.remarks


def test_a_frame_that_is_lost_does_not_set_the_begin_of_the_log(tmp_path: Path) -> None:
    early = [transform("cup", (0, 0, 0), stamp=1 + tick / 10, parent=("map", "camera")[tick % 2]) for tick in range(3)]
    late = [transform("mug", (0, 0, 0), stamp=3.0), transform("mug", (0, 0, 0), stamp=4.0)]
    found = read(tmp_path, [*early, *late])
    assert (found.end, found.tracks["mug"].times.tolist()) == (1.0, [0.0, 1.0])
