"""Logs of each kind are read alike; damaged and foreign ones are refused with a reason."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import Writer

from logs.bags import Message, pose, text, transform, truth, write
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.log_files import is_log
from robbdd_tools.logs.open_log import read_log

DRIVE = [
    transform("bench", (1, 0, 0.5), stamp=100.0, topic="/tf_static"),
    transform("cup", (0, 0, 0), stamp=100.0),
    text("pick-start", 100.1),
    transform("cup", (1, 0, 0), stamp=100.2),
    text("pick-end", 100.3),
]
TABLE = """time, frame, x, y, z, event
100.0, cup, 0, 0, 0,
100.1, , , , , pick-start
100.2, cup, 1, 0, 0,
100.3, , , , , pick-end
"""


def summary(found: LogContents) -> tuple[object, ...]:
    cup = found.tracks["cup"]
    return (
        [(round(time, 6), *place) for time, place in zip(cup.times.tolist(), cup.positions.tolist(), strict=True)],
        [(one.text, round(one.time, 6)) for one in found.texts],
        round(found.end, 6),
    )


EXPECTED = (
    [(0.0, 0.0, 0.0, 0.0), (0.2, 1.0, 0.0, 0.0)],
    [("pick-start", 0.1), ("pick-end", 0.3)],
    0.3,
)


@pytest.mark.parametrize("kind", ["sqlite", "mcap", "ros1"])
def test_a_bag_of_each_kind_says_the_same(kind: str, tmp_path: Path) -> None:
    path = write(tmp_path / ("drive.bag" if kind == "ros1" else "drive"), DRIVE, kind)
    found = read_log(path)
    assert is_log(path)
    assert summary(found) == EXPECTED
    assert (found.tracks["bench"].static, found.tracks["cup"].static) == (True, False)
    assert found.tracks["bench"].parent == "map"


def test_a_file_of_a_bag_is_read_without_its_metadata(tmp_path: Path) -> None:
    folder = write(tmp_path / "drive", DRIVE, "mcap")
    (path,) = folder.glob("*.mcap")
    moved = path.rename(tmp_path / "alone.mcap")
    assert summary(read_log(moved)) == EXPECTED


def test_a_table_says_the_same(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text(TABLE, encoding="utf-8")
    assert is_log(path)
    assert summary(read_log(path)) == EXPECTED


def foxglove(path: Path, library: str = "test") -> Path:
    def stamp(time: float) -> dict[str, int]:
        return {"sec": int(time), "nsec": round(time % 1 * 1e9)}

    def moved(time: float, x: float) -> tuple[str, float, object]:
        turn = {"w": 1, "x": 0, "y": 0, "z": 0}
        frame = {"timestamp": stamp(time), "parent_frame_id": "map", "child_frame_id": "cup", "rotation": turn}
        return "foxglove.FrameTransform", time, {**frame, "translation": {"x": x, "y": 0, "z": 0}}

    messages = [
        moved(100.0, 0),
        ("foxglove.Log", 100.1, {"message": "pick-start"}),
        moved(100.2, 1),
        ("foxglove.Log", 100.3, {"message": "pick-end"}),
    ]
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(library=library)
        channels: dict[str, int] = {}
        for name, time, content in messages:
            if name not in channels:
                number = writer.register_schema(name, "jsonschema", b"{}")
                channels[name] = writer.register_channel(f"/{name}", "json", number)
            log_time = round(time * 1e9)
            writer.add_message(channels[name], log_time, json.dumps(content).encode(), log_time)
        writer.finish()
    return path


def test_foxglove_messages_say_the_same(tmp_path: Path) -> None:
    assert summary(read_log(foxglove(tmp_path / "drive.mcap"))) == EXPECTED


def test_order_and_repetition_of_messages_do_not_matter(tmp_path: Path) -> None:
    shuffled = [DRIVE[4], DRIVE[3], DRIVE[0], DRIVE[2], DRIVE[1], DRIVE[3]]
    assert summary(read_log(write(tmp_path / "drive", shuffled))) == EXPECTED


def test_a_pose_topic_is_a_frame_of_its_name(tmp_path: Path) -> None:
    path = write(tmp_path / "drive", [pose("/cup/pose", (1, 2, 3), stamp=5.0), pose("/cup/pose", (1, 2, 4), stamp=6.0)])
    assert read_log(path).tracks["cup/pose"].positions.tolist() == [[1, 2, 3], [1, 2, 4]]


def test_clocks_that_differ_are_corrected_and_stated(tmp_path: Path) -> None:
    """The headers have simulated time, the reception has the wall clock's."""
    late = 1_700_000_000.0
    messages = [
        transform("cup", (0, 0, 0), stamp=1.0, received=late + 1.0),
        text("pick-start", late + 1.5),
        transform("cup", (0, 0, 0), stamp=2.0, received=late + 2.0),
    ]
    found = read_log(write(tmp_path / "drive", messages))
    assert [(one.text, round(one.time, 3)) for one in found.texts] == [("pick-start", 0.5)]
    assert "the time of reception is 1700000000.000 s ahead of the headers, and was corrected" in found.remarks


def test_values_that_are_no_poses_are_left_out(tmp_path: Path) -> None:
    messages = [
        transform("cup", (0, 0, 0), stamp=1.0),
        transform("cup", (float("nan"), 0, 0), stamp=2.0),
        transform("cup", (1, 0, 0), stamp=3.0, turn=(0, 0, 0, 0)),
        transform("cup", (2, 0, 0), stamp=4.0, turn=(2, 0, 0, 0)),
    ]
    found = read_log(write(tmp_path / "drive", messages)).tracks["cup"]
    assert found.times.tolist() == [0.0, 3.0]
    assert np.linalg.norm(found.orientations, axis=1).tolist() == [1.0, 1.0]


def test_truths_are_reported_by_topics(tmp_path: Path) -> None:
    messages = [
        transform("cup", (0, 0, 0), stamp=1.0),
        truth("/seen", True, 1.5),
        truth("/near", 2, 1.5),
        truth("/near", 1, 2.0),
        truth("/near", 0, 3.0),
    ]
    found = read_log(write(tmp_path / "drive", messages)).truths
    assert (found["/seen"].times.tolist(), found["/seen"].values.tolist()) == ([0.5], [1.0])
    assert found["/near"].times.tolist() == [0.5, 1.0, 2.0]
    assert str(found["/near"].values.tolist()) == "[nan, 1.0, -1.0]"


def refused(path: Path) -> str:
    with pytest.raises(UnreadableLog) as caught:
        read_log(path)
    return str(caught.value)


@pytest.mark.parametrize("kind", ["sqlite", "mcap", "ros1"])
@pytest.mark.parametrize("damage", ["empty", "half", "noise"])
def test_a_damaged_bag_is_refused(kind: str, damage: str, tmp_path: Path) -> None:
    path = write(tmp_path / ("drive.bag" if kind == "ros1" else "drive"), DRIVE * 20, kind)
    file = path if path.is_file() else next(one for one in path.iterdir() if one.suffix in (".db3", ".mcap"))
    data = file.read_bytes()
    noise = np.random.default_rng(1).integers(0, 256, len(data), dtype=np.uint8).tobytes()
    file.write_bytes({"empty": b"", "half": data[: len(data) // 2], "noise": noise}[damage])
    assert path.name in refused(path)


def test_a_log_without_anything_to_judge_is_refused(tmp_path: Path) -> None:
    def make(store: Any) -> Any:
        return store.types["std_msgs/msg/Int32"](data=1)

    path = write(tmp_path / "drive", [Message("/ok", 1.0, "std_msgs/msg/Int32", make)])
    assert "contains no message that can be judged" in refused(path)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("x,y\n1,2\n", "drive.csv:1: there is no column 'time'"),
        ("", "drive.csv:1: there is no column 'time'"),
        ("time,frame,x,y,z\n0,cup,1,2,three\n", "drive.csv:2: column 'z' must be a number, but is 'three'"),
        (
            "time,frame,x,y,z\nnoon,cup,1,2,3\n",
            "drive.csv:2: column 'time' must be a number, or a date and a time, but is 'noon'",
        ),
        ("time,event\n", "contains no message that can be judged"),
    ],
)
def test_a_table_that_cannot_be_read_is_refused_with_its_line(content: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text(content, encoding="utf-8")
    assert words in refused(path)


def table(folder: Path, text: str, columns: dict[str, str] | None = None) -> LogContents:
    path = folder / "drive.csv"
    path.write_text(text, encoding="utf-8")
    return read_log(path, columns)


@pytest.mark.parametrize("cell", ["", "nan", "inf"])
def test_a_missing_coordinate_is_a_gap(cell: str, tmp_path: Path) -> None:
    found = table(tmp_path, f"time,frame,x,y,z\n0,cup,1,2,3\n1,cup,{cell},2,3\n2,cup,4,2,3\n")
    assert found.tracks["cup"].times.tolist() == [0.0, 2.0]


@pytest.mark.parametrize("cell", ["", "nan", "inf", "1700000000000000000"])
def test_a_time_that_cannot_be_is_refused(cell: str, tmp_path: Path) -> None:
    with pytest.raises(UnreadableLog) as caught:
        table(tmp_path, f"time,frame,x,y,z\n{cell},cup,1,2,3\n")
    assert "drive.csv:2: column 'time' " in str(caught.value)
    assert ("say --column 'time=time [ns]'" in str(caught.value)) is cell.startswith("17")


@pytest.mark.parametrize(
    ("title", "columns", "times"),
    [
        ("time", {"time": "time [ns]"}, ("1700000000000000000", "1700000000500000000")),
        ("stamp (ns)", {"time": "stamp"}, ("1700000000000000000", "1700000000500000000")),
        ("time [us]", {}, ("1700000000000000", "1700000000500000")),
        ("Time", {}, ("2026-01-02T10:00:00.25Z", "2026-01-02T10:00:00.750000001Z")),
        ("time", {}, ("2026-01-02 10:00:00", "2026-01-02 10:00:00,5")),
    ],
)
def test_times_have_a_unit_or_are_dates(
    title: str, columns: dict[str, str], times: tuple[str, str], tmp_path: Path
) -> None:
    text = f"{title}\tframe\tX\tY\tZ\n{times[0]}\tcup\t1\t2\t3\n{times[1]}\tcup\t1\t2\t3\n"
    assert table(tmp_path, text, columns).tracks["cup"].times.tolist() == pytest.approx([0.0, 0.5], abs=1e-6)


def test_numbers_have_decimal_commas_if_columns_are_separated_otherwise(tmp_path: Path) -> None:
    found = table(tmp_path, "time;frame;x;y;z;elbow\n0,5;cup;-1,25;2;3;0,75\n")
    assert found.tracks["cup"].positions.tolist() == [[-1.25, 2.0, 3.0]]
    assert found.joints["drive.csv"]["elbow"].positions.tolist() == [0.75]


def test_angles_with_units_are_the_orientation(tmp_path: Path) -> None:
    head, row = "time,frame,x,y,z,roll [deg],pitch [deg],yaw [deg]", "0,cup,1,2,3,90,0,90"
    ((w, x, y, z),) = table(tmp_path, f"{head}\n{row}\n").tracks["cup"].orientations
    # First about x, then about the fixed z: the cup's own z lies along world x.
    assert (w, x, y, z) == pytest.approx((0.5, 0.5, 0.5, 0.5))
    found = table(tmp_path, f"{head.replace(' [deg]', '')}\n{row}\n")
    assert np.isnan(found.tracks["cup"].orientations).all()
    assert any("or roll, pitch and yaw with their unit: 'roll [deg]'" in one for one in found.remarks)


def test_angles_are_the_orientation_of_a_frame_in_a_column_of_another_name(tmp_path: Path) -> None:
    text = "time,body,x,y,z,roll [deg],pitch [deg],Yaw [deg]\n0,cup,1,2,3,90,0,90\n"
    ((w, x, y, z),) = table(tmp_path, text, {"frame": "body"}).tracks["cup"].orientations
    assert (w, x, y, z) == pytest.approx((0.5, 0.5, 0.5, 0.5))
    for head, missing in (
        ("roll [deg],pitch [deg],heading", "no column 'yaw'"),
        ("roll,pitch,yaw", "no unit of an angle"),
    ):
        text = f"time,body,x,y,z,{head}\n0,cup,1,2,3,90,0,90\n"
        stated = {"frame": "body", "roll": head.partition(",")[0]}
        with pytest.raises(UnreadableLog, match=f"roll, pitch and yaw with their units; there is {missing}"):
            table(tmp_path, text, stated)
        assert np.isnan(table(tmp_path, text, {"frame": "body"}).tracks["cup"].orientations).all()


def test_an_orientation_of_zeros_is_named(tmp_path: Path) -> None:
    found = table(tmp_path, "time,frame,x,y,z,qw,qx,qy,qz\n0,cup,1,2,3,0,0,0,0\n1,cup,1,2,3,0,0,0,0\n")
    assert np.isnan(found.tracks["cup"].positions).all()
    assert any(
        "the place of 'cup' is not known: the quaternions of its poses have no length" in one for one in found.remarks
    )


def test_other_paths_are_no_logs(tmp_path: Path) -> None:
    (tmp_path / "model.bdd").write_text("", encoding="utf-8")
    assert not any(map(is_log, (tmp_path, tmp_path / "model.bdd", tmp_path / "gone.csv", Path("latest"))))


def test_a_folder_without_metadata_is_that_of_an_interrupted_recorder(tmp_path: Path) -> None:
    drive = write(tmp_path / "drive", [transform("cup", (tick, 0, 0), stamp=1 + tick) for tick in range(3)])
    assert not read_log(drive).unfinished
    (drive / "metadata.yaml").unlink()
    found = read_log(drive)
    assert found.unfinished
    assert "drive has no metadata.yaml, so its recorder did not end" in found.remarks
