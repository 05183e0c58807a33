"""Joint states of logs of each kind, and the positions of a joint between them."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import Writer

from logs.bags import joints, write
from robbdd_tools.logs.joint_tracks import JointTrack, positions_at
from robbdd_tools.logs.log_contents import UnreadableLog
from robbdd_tools.logs.open_log import read_log

NAMES = ("elbow_joint", "grip")
STATES = [(20.0, (0.5, 0.01)), (20.5, (0.7, 0.02)), (21.0, (0.9, 0.03))]


def foxglove(path: Path, kind: str) -> Path:
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="", library="test")
        schema = writer.register_schema(kind, "jsonschema", b"{}")
        channel = writer.register_channel("/joint_states", "json", schema)
        for time, positions in STATES:
            message = _message(kind, time, positions)
            writer.add_message(channel, round(time * 1e9), json.dumps(message).encode(), round(time * 1e9))
        writer.finish()
    return path


def _message(kind: str, time: float, positions: tuple[float, float]) -> dict[str, Any]:
    if kind == "foxglove.JointStates":
        stamp = {"sec": int(time), "nsec": round(time % 1 * 1e9)}
        states: list[dict[str, object]] = [
            {"name": name, "position": one} for name, one in zip(NAMES, positions, strict=True)
        ]
        return {"timestamp": stamp, "joints": [*states, {"name": "wheel", "velocity": 2.0}]}
    stamp = {"secs": int(time), "nsecs": round(time % 1 * 1e9)}
    return {"header": {"stamp": stamp}, "name": list(NAMES), "position": list(positions), "velocity": [], "effort": []}


def log_of(kind: str, folder: Path) -> Path:
    messages = [joints(NAMES, positions, time) for time, positions in STATES]
    match kind:
        case "foxglove.JointStates" | "sensor_msgs/JointState":
            return foxglove(folder / "drive.mcap", kind)
        case "csv":
            path = folder / "drive.csv"
            rows = [f"{1000 * time};{math.degrees(elbow)};{1000 * grip};on" for time, (elbow, grip) in STATES]
            path.write_text("\n".join(["t [ms];elbow_joint [deg];grip (mm);lamp", *rows]), encoding="utf-8")
            return path
        case _:
            return write(folder / ("drive.bag" if kind == "ros1" else "drive"), messages, kind)


@pytest.mark.parametrize(
    "kind", ["sqlite", "old", "mcap", "ros1", "foxglove.JointStates", "sensor_msgs/JointState", "csv"]
)
def test_joint_states_of_each_kind_are_read_alike(kind: str, tmp_path: Path) -> None:
    contents = read_log(log_of(kind, tmp_path), {"time": "t"} if kind == "csv" else None)
    ((topic, found),) = contents.joints.items()
    assert topic == ("drive.csv" if kind == "csv" else "/joint_states")
    assert set(found) == set(NAMES)
    assert found["elbow_joint"].times.tolist() == pytest.approx([0.0, 0.5, 1.0])
    assert found["elbow_joint"].positions.tolist() == pytest.approx([0.5, 0.7, 0.9])
    assert found["grip"].positions.tolist() == pytest.approx([0.01, 0.02, 0.03])
    assert contents.end == pytest.approx(1.0)


def test_states_without_a_stamp_are_stamped_by_their_reception(tmp_path: Path) -> None:
    messages = [joints(["a"], [1.0], 0.0, received=50.0), joints(["a"], [2.0], 0.0, received=51.5)]
    found = read_log(write(tmp_path / "drive", messages)).joints["/joint_states"]["a"]
    assert found.times.tolist() == [0.0, 1.5]


def test_a_message_whose_positions_do_not_fit_its_names_is_not_used(tmp_path: Path) -> None:
    messages = [joints(["a", "b"], [1.0, 2.0], 5.0), joints(["a", "b"], [1.0], 6.0), joints(["a", "b"], [], 6.5)]
    contents = read_log(write(tmp_path / "drive", messages))
    assert contents.joints["/joint_states"]["a"].positions.tolist() == [1.0]
    assert "a message on '/joint_states' has 2 joints but 1 positions: it is not used" in contents.remarks


def test_efforts_are_kept_where_they_are_published(tmp_path: Path) -> None:
    messages = [joints(["a"], [1.0], 5.0, efforts=[3.5]), joints(["a"], [1.0], 6.0)]
    efforts = read_log(write(tmp_path / "drive", messages)).joints["/joint_states"]["a"].efforts
    assert efforts[0] == 3.5
    assert math.isnan(efforts[1])


def test_a_joint_is_interpolated_within_gaps_only() -> None:
    track = JointTrack(np.array([1.0, 2.0, 4.0]), np.array([0.0, 1.0, 3.0]), np.zeros(3))
    found = positions_at(track, np.array([0.9, 1.0, 1.25, 2.0, 3.0, 4.0, 4.1]), 1.5)
    assert found.tolist() == pytest.approx([math.nan, 0.0, 0.25, 1.0, math.nan, 3.0, math.nan], nan_ok=True)


def test_a_joint_without_limits_jumps_by_whole_turns() -> None:
    track = JointTrack(np.array([0.0, 1.0]), np.array([math.pi - 0.1, 0.1 - math.pi]), np.zeros(2))
    (between,) = positions_at(track, np.array([0.5]), 2.0, wraps=True)
    assert abs(between) == pytest.approx(math.pi)
    assert positions_at(track, np.array([0.5]), 2.0).tolist() == pytest.approx([0.0])


@pytest.mark.parametrize(
    ("text", "stated", "words"),
    [
        ("stamp,frame,x,y,z\n", {}, "drive.csv:1: there is no column 'time'"),
        ("stamp,frame,x,y,z\n", {"time": "stmp"}, "drive.csv:1: there is no column 'stmp'; it has: stamp, frame"),
        ("stamp,frame,x,y,z\n", {"when": "stamp"}, "'when' is no column of a table; the columns are time, frame"),
        ("time [mm],elbow\n", {}, "drive.csv:1: 'mm' is no unit of column 'time'"),
        (
            "time,elbow\n1,2\nnoon,3\n",
            {},
            "drive.csv:3: column 'time' must be a number, or a date and a time, but is 'noon'",
        ),
    ],
)
def test_a_table_with_other_columns_is_refused_with_its_place(
    text: str, stated: dict[str, str], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "drive.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UnreadableLog) as caught:
        read_log(path, stated)
    assert words in str(caught.value)


def test_columns_of_other_titles_and_units_are_poses(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("t\tbody\tpx [mm]\tpy [mm]\tpz [mm]\n1\tcup\t10\t20\t30\n", encoding="utf-8")
    found = read_log(path, {"time": "t", "frame": "body", "x": "px", "y": "py [mm]", "z": "pz"})
    assert found.tracks["cup"].positions.tolist() == [pytest.approx([0.01, 0.02, 0.03])]
    assert not found.joints
