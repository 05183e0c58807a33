"""Messages of simulators, detectors and actions: the frames and events that they give, and those that they cannot."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from logs.bags import (
    Message,
    detected,
    detected_alone,
    diagnostics,
    goals,
    header,
    models,
    pose,
    poses,
    text,
    transform,
    write,
)
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.open_log import read_log

KINDS = ["sqlite", "old", "mcap", "ros1"]


def read(folder: Path, messages: list[Message], kind: str = "sqlite") -> LogContents:
    return read_log(write(folder / ("drive.bag" if kind == "ros1" else "drive"), messages, kind))


def places(found: LogContents) -> dict[str, list[list[float]]]:
    return {frame: track.positions.tolist() for frame, track in found.tracks.items()}


def times(found: LogContents, frame: str) -> list[float]:
    return [round(time, 6) for time in found.tracks[frame].times.tolist()]


@pytest.mark.parametrize("kind", KINDS)
def test_models_of_a_simulator_are_frames_of_their_names(kind: str, tmp_path: Path) -> None:
    seen: dict[str, Any] = {"mug": (1, 2, 3), "ur5::tool0": (0, 0, 1)}
    found = read(tmp_path, [models(seen, 7.0), models({"mug": (1, 2, 4)}, 8.0)], kind)
    assert places(found) == {
        "gazebo/model_states/mug": [[1, 2, 3], [1, 2, 4]],
        "gazebo/model_states/ur5/tool0": [[0, 0, 1]],
    }
    assert found.tracks["gazebo/model_states/mug"].parent == "world"


def test_poses_without_headers_are_corrected_by_the_offset_of_the_others(tmp_path: Path) -> None:
    late = 1_700_000_000.0
    moved = [transform("arm", (0, 0, 0), stamp=time, received=late + time) for time in (1.0, 2.0, 3.0)]
    found = read(tmp_path, [*moved, models({"mug": (1, 2, 3)}, late + 2.5)])
    assert times(found, "gazebo/model_states/mug") == [1.5]
    assert found.end == 2.0


def test_the_end_of_a_log_is_its_last_pose_also_without_headers(tmp_path: Path) -> None:
    found = read(tmp_path, [models({"mug": (0, 0, 0)}, 5.0), models({"mug": (0, 0, 0)}, 9.0)])
    assert (found.end, times(found, "gazebo/model_states/mug")) == (4.0, [0.0, 4.0])


def test_poses_of_a_list_are_frames_of_their_indices(tmp_path: Path) -> None:
    messages = [poses("/blocks", [(1, 0, 0), (2, 0, 0)], stamp=time) for time in (1.0, 2.0)]
    assert places(read(tmp_path, messages)) == {"blocks/0": [[1, 0, 0]] * 2, "blocks/1": [[2, 0, 0]] * 2}


def test_an_index_is_no_name_if_the_lists_are_of_different_lengths(tmp_path: Path) -> None:
    """If one of three blocks is not seen, the second pose is that of another block."""
    lists = [[(1, 0, 0), (2, 0, 0), (3, 0, 0)], [(1, 0, 0), (3, 0, 0)]]
    blocks = [poses("/blocks", one, stamp=float(number)) for number, one in enumerate(lists)]
    found = read(tmp_path, [*blocks, pose("/mug", (0, 0, 0), stamp=1.0)])
    assert set(found.tracks) == {"mug"}
    words = "the lists on '/blocks' have from 2 to 3 poses, so an index is not always the same thing: they are not used"
    assert f"{words}; record names with them" in found.remarks


A, B, C = (0.40, 0.1, 0.82), (0.40, 0.3, 0.82), (0.55, -0.2, 0.82)


@pytest.mark.parametrize("after", [[B, A, C], [B, C, A], [A, C, B]])
def test_an_index_is_no_name_if_the_poses_change_their_order(after: list[Any], tmp_path: Path) -> None:
    lists = [[A, B, C], [A, B, C], after, after]
    blocks = [poses("/blocks", one, stamp=float(number)) for number, one in enumerate(lists)]
    found = read(tmp_path, [*blocks, pose("/mug", (0, 0, 0), stamp=1.0)])
    assert set(found.tracks) == {"mug"}
    (remark,) = [one for one in found.remarks if "/blocks" in one]
    assert "change their order, so an index is not always the same thing: they are not used; record names" in remark


@pytest.mark.parametrize(
    "after",
    [
        [A, (0.39, 0.11, 0.82), C],  # one thing is put beside another
        [(0.55, 0.1, 0.82), (0.55, 0.3, 0.82), (0.70, -0.2, 0.82)],  # all ride on a belt
        [(0.402, 0.099, 0.82), (0.401, 0.302, 0.821), (0.549, -0.202, 0.82)],  # noise
    ],
)
def test_things_that_move_keep_their_indices(after: list[Any], tmp_path: Path) -> None:
    blocks = [poses("/blocks", one, stamp=float(number)) for number, one in enumerate([[A, B, C], after])]
    assert set(read(tmp_path, blocks).tracks) == {"blocks/0", "blocks/1", "blocks/2"}


@pytest.mark.parametrize("topic", ["/plan/next_event", "/commands", "/arm/goal_state", "/requested"])
def test_texts_about_plans_report_no_events(topic: str, tmp_path: Path) -> None:
    said = [text("pick-end", 1.0, topic), text("pick-start", 0.5, "/events"), pose("/mug", (0, 0, 0), stamp=1.0)]
    found = read(tmp_path, said)
    assert [one.text for one in found.texts] == ["pick-start"]
    assert any(f"texts on '{topic}' may say what is planned" in one for one in found.remarks)


@pytest.mark.parametrize("kind", KINDS)
def test_detections_are_frames_of_their_ids_or_else_of_their_likeliest_class(kind: str, tmp_path: Path) -> None:
    messages = [detected([("7", "cup", (1, 0, 0)), ("", "plate", (2, 0, 0))], time) for time in (1.0, 1.5)]
    found = read(tmp_path, messages, kind)
    assert places(found) == {"seen/7": [[1, 0, 0]] * 2, "seen/plate": [[2, 0, 0]] * 2}
    assert found.tracks["seen/7"].parent == "map"


def test_a_detection_without_a_pose_stands_where_its_box_is(tmp_path: Path) -> None:
    found = read(tmp_path, [detected([("", "cup", (1, 2, 3))], 1.0, boxed=True), detected([("9", "", (4, 5, 6))], 1.0)])
    assert places(found) == {"seen/cup": [[1, 2, 3]], "seen/9": [[4, 5, 6]]}


def test_two_detections_of_a_class_have_no_frame(tmp_path: Path) -> None:
    messages = [
        detected([("", "cup", (1, 0, 0)), ("", "plate", (2, 0, 0))], 1.0),
        detected([("", "cup", (1, 0, 0)), ("", "cup", (5, 0, 0))], 2.0),
        detected([("", "", (1, 0, 0))], 3.0),
    ]
    found = read(tmp_path, messages)
    assert set(found.tracks) == {"seen/plate"}
    words = "'seen/cup' on '/seen' is at two places at one time, so it is not used; record an id for each thing"
    assert words in found.remarks
    assert "things on '/seen' have neither an id nor a class, so they are not used" in found.remarks


def test_two_detections_of_a_class_in_messages_of_their_own_have_no_frame(tmp_path: Path) -> None:
    twice = [detected_alone("", "cup", (1, 0, 0), 1.0), detected_alone("", "cup", (5, 0, 0), 1.0)]
    alone = [detected_alone("4", "plate", (2, 0, 0), time) for time in (1.0, 1.0, 2.0)]
    found = read(tmp_path, [*twice, *alone])
    assert places(found) == {"seen/4": [[2, 0, 0]] * 2}


@pytest.mark.parametrize(
    ("states", "expected"),
    [
        ([(1.0, {"a": 1}), (1.2, {"a": 2}), (3.0, {"a": 4})], ["1.2 grasp-start", "3.0 grasp-end"]),
        ([(1.2, {"a": 2}), (1.3, {"a": 2}), (3.0, {"a": 4}), (3.5, {"a": 4})], ["1.2 grasp-start", "3.0 grasp-end"]),
        ([(1.0, {"a": 2}), (2.0, {"a": 6})], ["1.0 grasp-start"]),
        ([(1.0, {"a": 2}), (2.0, {"a": 3}), (2.5, {"a": 5})], ["1.0 grasp-start"]),
        ([(1.0, {"a": 1}), (2.0, {"a": 5})], []),
        ([(1.0, {"a": 1}), (2.0, {"a": 4})], ["2.0 grasp-end"]),
        ([(1.0, {"a": 4, "b": 2}), (2.0, {"a": 4, "b": 4})], ["1.0 grasp-start", "2.0 grasp-end"]),
        (
            [(1.0, {"a": 2}), (2.0, {"a": 4, "b": 2}), (3.0, {"b": 4})],
            ["1.0 grasp-start", "2.0 grasp-end", "2.0 grasp-start", "3.0 grasp-end"],
        ),
    ],
)
def test_goals_of_an_action_report_its_start_and_end(
    states: list[tuple[float, dict[str, int]]], expected: list[str], tmp_path: Path
) -> None:
    messages = [pose("/mug", (0, 0, 0), stamp=0.0), *(goals("arm/grasp", one, time) for time, one in states)]
    assert [f"{round(one.time, 3)} {one.text}" for one in read(tmp_path, messages).texts] == expected


def test_the_start_of_a_goal_that_began_before_the_log_is_not_known(tmp_path: Path) -> None:
    messages = [goals("grasp", {"a": 2}, 9.0, accepted=2.0), goals("grasp", {"a": 4}, 10.0)]
    found = read(tmp_path, messages)
    assert [one.text for one in found.texts] == ["grasp-end"]
    assert "a goal on '/grasp/_action/status' began before the log: its start is not known" in found.remarks


def test_a_goal_that_fails_is_stated(tmp_path: Path) -> None:
    found = read(tmp_path, [goals("grasp", {"a": 2}, 1.0), goals("grasp", {"a": 6}, 2.0)])
    assert "a goal on '/grasp/_action/status' did not succeed: 'grasp-end' is not reported" in found.remarks


def test_goals_of_ros_1_have_its_numbers(tmp_path: Path) -> None:
    """3 is *succeeded* in ROS 1, and *cancelling* in ROS 2."""

    def status(number: int, received: float) -> Message:
        def make(store: Any) -> Any:
            types = store.types
            time = types["builtin_interfaces/msg/Time"](sec=int(received), nanosec=0)
            goal = types["actionlib_msgs/msg/GoalID"](stamp=time, id="first")
            one = types["actionlib_msgs/msg/GoalStatus"](goal_id=goal, status=number, text="")
            return types["actionlib_msgs/msg/GoalStatusArray"](header=header(store, received, ""), status_list=[one])

        return Message("/arm/grasp/status", received, "actionlib_msgs/msg/GoalStatusArray", make)

    found = read(tmp_path, [status(1, 4.0), status(1, 4.5), status(3, 6.0)], "ros1")
    assert [(one.text, one.time) for one in found.texts] == [("grasp-start", 0.0), ("grasp-end", 2.0)]


def test_an_estimate_is_a_pose(tmp_path: Path) -> None:
    def make(store: Any) -> Any:
        types = store.types
        there = types["geometry_msgs/msg/Pose"](
            position=types["geometry_msgs/msg/Point"](1.0, 2.0, 3.0),
            orientation=types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
        )
        estimate = types["geometry_msgs/msg/PoseWithCovariance"](pose=there, covariance=np.eye(6).ravel())
        kind = types["geometry_msgs/msg/PoseWithCovarianceStamped"]
        return kind(header=header(store, 3.0, "map"), pose=estimate)

    found = read(tmp_path, [Message("/base", 3.0, "geometry_msgs/msg/PoseWithCovarianceStamped", make)])
    assert places(found) == {"base": [[1, 2, 3]]}


def test_topics_that_are_not_read_are_named_with_their_types(tmp_path: Path) -> None:
    def make(store: Any) -> Any:
        return store.types["std_msgs/msg/Int32"](data=1)

    counters = [Message(f"/count{index}", 1.0, "std_msgs/msg/Int32", make) for index in range(10)]
    found = read(tmp_path, [pose("/mug", (0, 0, 0), stamp=1.0), *counters])
    (listed,) = [one for one in found.remarks if one.startswith("not read: ")]
    assert listed.startswith("not read: /count0 (std_msgs/msg/Int32), /count1 (std_msgs/msg/Int32)")
    assert listed.endswith("and 2 more")


def test_a_topic_whose_messages_do_not_fit_their_type_is_named(tmp_path: Path) -> None:
    """The definition of the bag is not that of the messages: another version of the package wrote them."""
    folder = write(tmp_path / "drive", [detected([("7", "cup", (1, 0, 0))], 1.0)], "old")
    (file,) = folder.glob("*.db3")
    with sqlite3.connect(file) as base:
        base.execute("update messages set data = substr(data, 1, 60)")
    base.close()
    with pytest.raises(Exception, match=r"'/seen' \(vision_msgs/msg/Detection3DArray\)"):
        read_log(folder)


@pytest.mark.parametrize("kind", KINDS)
def test_diagnostics_report_changed_levels_and_messages(kind: str, tmp_path: Path) -> None:
    states = [(1.0, 0, "ready"), (2.0, 0, "ready"), (3.0, 2, "no vacuum"), (4.0, 2, ""), (5.0, 0, "pick_end")]
    messages = [diagnostics({"gripper": (level, words)}, time) for time, level, words in states]
    found = read(tmp_path, messages, kind)
    assert [(one.topic, one.text, one.time) for one in found.texts] == [
        ("/diagnostics/gripper", "gripper ok", 0.0),
        ("/diagnostics/gripper", "ready", 0.0),
        ("/diagnostics/gripper", "gripper error", 2.0),
        ("/diagnostics/gripper", "no vacuum", 2.0),
        ("/diagnostics/gripper", "gripper ok", 4.0),
        ("/diagnostics/gripper", "pick_end", 4.0),
    ]


@pytest.mark.parametrize("kind", KINDS)
def test_the_clock_of_a_topic_that_is_ahead_is_moved_back(kind: str, tmp_path: Path) -> None:
    messages = [pose("/seen/cup", (time, 0, 0), stamp=time) for time in (1.0, 2.0, 3.0)]
    messages += [transform("arm", (0, 0, 0), stamp=time) for time in (0.5, 2.5)]
    path = write(tmp_path / ("drive.bag" if kind == "ros1" else "drive"), messages, kind)
    found = read_log(path, clocks={"/seen/cup": 0.25})
    assert times(found, "seen/cup") == [0.25, 1.25, 2.25]
    assert times(found, "arm") == [0.0, 2.0]
    assert times(read_log(path), "seen/cup") == [0.5, 1.5, 2.5]


def test_a_clock_of_no_topic_or_without_headers_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "drive", [pose("/cup", (0, 0, 0), stamp=1.0), text("pick-start", 1.0)])
    with pytest.raises(UnreadableLog, match=r"there is no topic '/mug' with headers; the log has /cup$"):
        read_log(path, clocks={"/mug": 1.0})
    with pytest.raises(UnreadableLog, match=r"'/events' \(std_msgs/msg/String\) has the time of its reception"):
        read_log(path, clocks={"/events": 1.0})


@pytest.mark.parametrize(("apart", "known"), [(0.1, False), (0.0005, True)])
def test_a_frame_that_two_programs_publish_is_nowhere(apart: float, known: bool, tmp_path: Path) -> None:
    twice = [
        transform("tool", (shift, 0, 0), stamp=1 + tick / 50, received=1 + tick / 50 + shift / 1000)
        for tick in range(20)
        for shift in (0.0, apart)
    ]
    found = read_log(write(tmp_path / "drive", twice))
    assert bool(np.isfinite(found.tracks["tool"].positions).all()) is known
    words = "frame 'tool' has two places at one time, 100 mm apart, 20 times: two programs publish it"
    assert any(words in one for one in found.remarks) is not known
