"""Events in the metadata records of MCAP files; attachments are not read."""

from __future__ import annotations

from pathlib import Path

import pytest
from mcap.writer import Writer

from logs.bags import ROS2, transform, write
from robbdd_tools.logs.log_contents import UnreadableLog
from robbdd_tools.logs.open_log import read_log

MOVED = [transform("cup", (tick, 0, 0), stamp=100 + tick / 10) for tick in range(30)]


def annotated(path: Path, *records: dict[str, str], encoding: str = "cdr", attachment: str = "") -> Path:
    """Write a drive with metadata records, as messages of ROS 2 or with a topic in JSON, too."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        definition, _ = ROS2.generate_msgdef(MOVED[0].kind, ros_version=2)
        kind = writer.register_schema(MOVED[0].kind, "ros2msg", definition.encode())
        channel = writer.register_channel("/tf", "cdr", kind)
        for one in MOVED:
            data = bytes(ROS2.serialize_cdr(one.make(ROS2), one.kind))
            writer.add_message(channel, round(one.received * 1e9), data, 0)
        if encoding == "json":
            plain = writer.register_schema("foxglove.Log", "jsonschema", b"{}")
            writer.add_message(writer.register_channel("/log", "json", plain), 100 * 10**9, b'{"message": "x"}', 0)
        for record in records:
            writer.add_metadata("by hand", record)
        if attachment:
            writer.add_attachment(0, 0, attachment, "text/plain", b"seen")
        writer.finish()
    return path


@pytest.mark.parametrize("encoding", ["cdr", "json"])
def test_metadata_records_report_events(encoding: str, tmp_path: Path) -> None:
    records = (
        {"event": "pick-end", "time": "1.5"},
        {"event": "pick-start", "log_time": "100500000000"},
        {"version": "3", "time": "noon"},
    )
    found = read_log(annotated(tmp_path / "drive.mcap", *records, encoding=encoding, attachment="notes.txt"))
    events = [(one.topic, one.text, one.time) for one in found.texts if one.text != "x"]
    assert events == [("by hand", "pick-start", 0.5), ("by hand", "pick-end", 1.5)]
    assert "attachments are not read: 'notes.txt'" in found.remarks
    assert len(found.tracks["cup"].times) == 30


def test_files_of_a_folder_have_records_too(tmp_path: Path) -> None:
    folder = write(tmp_path / "drive", MOVED, "mcap")
    (path,) = folder.glob("*.mcap")
    annotated(path, {"event": "pick-end", "time": "1.5"})
    assert [one.text for one in read_log(folder).texts] == ["pick-end"]


def test_a_time_that_is_none_is_refused(tmp_path: Path) -> None:
    path = annotated(tmp_path / "drive.mcap", {"event": "pick-end", "time": "soon"})
    words = "'time' of the metadata record 'by hand' must be a time in s since the begin of the log, but is 'soon'"
    with pytest.raises(UnreadableLog, match=words):
        read_log(path)
