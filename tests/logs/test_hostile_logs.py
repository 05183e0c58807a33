"""Logs that are damaged, unusual or written by other recorders: they are read as they are, or refused with a reason."""

from __future__ import annotations

import random
import shutil
import sqlite3
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import IndexType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from logs.bags import ROS1, ROS2, Message, text, transform, write
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.open_log import read_log

DRIVE = sorted(
    [
        *(transform("cup", (tick, 0, 0), stamp=1 + tick / 10) for tick in range(30)),
        text("pick-start", 2.05),
        text("pick-end", 3.05),
    ],
    key=lambda one: one.received,
)


def assert_is_drive(found: LogContents) -> None:
    assert found.tracks["cup"].positions[:, 0].tolist() == list(range(30))
    assert [(one.text, round(one.time, 6)) for one in found.texts] == [("pick-start", 1.05), ("pick-end", 2.05)]
    assert not found.unfinished


def compressed(path: Path, mode: str, storage: str) -> Path:
    """Write the drive as a bag of ROS 2 whose files or messages are compressed."""
    writer = Writer(path, version=9, storage_plugin=StoragePlugin[storage])
    writer.set_compression(CompressionMode[mode], CompressionFormat.ZSTD)
    with writer:
        connections: dict[str, Any] = {}
        for one in DRIVE:
            if one.topic not in connections:
                connections[one.topic] = writer.add_connection(one.topic, one.kind, typestore=ROS2)
            data = ROS2.serialize_cdr(one.make(ROS2), one.kind)
            writer.write(connections[one.topic], round(one.received * 1e9), data)
    return path


def mcap(path: Path, messages: Sequence[Message], *, profile: str = "ros2", **options: Any) -> Path:
    """Write an MCAP file with the ``options`` of the writer."""
    with path.open("wb") as file:
        writer = McapWriter(file, **options)
        writer.start(profile=profile)
        channels: dict[str, int] = {}
        for one in messages:
            if one.topic not in channels:
                definition, _ = ROS2.generate_msgdef(one.kind, ros_version=2)
                schema = writer.register_schema(one.kind, "ros2msg", definition.encode())
                channels[one.topic] = writer.register_channel(one.topic, "cdr", schema)
            data = bytes(ROS2.serialize_cdr(one.make(ROS2), one.kind))
            writer.add_message(channels[one.topic], round(one.received * 1e9), data, round(one.received * 1e9))
        writer.finish()
    return path


@pytest.mark.parametrize("chunks", ["", "BZ2", "LZ4"])
def test_chunks_of_ros1_are_decompressed(chunks: str, tmp_path: Path) -> None:
    path = tmp_path / "drive.bag"
    writer = Writer1(path)
    if chunks:
        writer.set_compression(Writer1.CompressionFormat[chunks])
    with writer:
        connections: dict[str, Any] = {}
        for one in DRIVE:
            if one.topic not in connections:
                connections[one.topic] = writer.add_connection(one.topic, one.kind, typestore=ROS1)
            data = ROS1.serialize_ros1(one.make(ROS1), one.kind)
            writer.write(connections[one.topic], round(one.received * 1e9), data)
    assert_is_drive(read_log(path))


@pytest.mark.parametrize("storage", ["MCAP", "SQLITE3"])
@pytest.mark.parametrize("mode", ["FILE", "MESSAGE"])
def test_compressed_files_and_messages_are_read_by_the_folder(mode: str, storage: str, tmp_path: Path) -> None:
    assert_is_drive(read_log(compressed(tmp_path / "drive", mode, storage)))


@pytest.mark.parametrize("storage", ["MCAP", "SQLITE3"])
def test_a_file_of_compressed_messages_alone_is_refused_with_the_fix(storage: str, tmp_path: Path) -> None:
    (path,) = (
        one for one in compressed(tmp_path / "drive", "MESSAGE", storage).iterdir() if one.suffix in (".mcap", ".db3")
    )
    with pytest.raises(UnreadableLog, match=r"its messages are compressed, .*: name the folder of the bag"):
        read_log(path)


@pytest.mark.parametrize(
    "options",
    [
        {"use_chunking": False},
        {"index_types": IndexType.NONE},
        {"use_statistics": False, "use_summary_offsets": False, "repeat_channels": False, "repeat_schemas": False},
        {"profile": ""},
        {"chunk_size": 500},
    ],
)
@pytest.mark.parametrize("shuffled", [False, True])
def test_mcap_files_of_any_order_with_and_without_an_index_are_read(
    options: dict[str, Any], shuffled: bool, tmp_path: Path
) -> None:
    messages = list(DRIVE)
    if shuffled:
        random.Random(1).shuffle(messages)
    assert_is_drive(read_log(mcap(tmp_path / "drive.mcap", messages, **options)))


@pytest.mark.parametrize("back", [0.4, 0.9, 1.5])
def test_headers_of_a_clock_that_was_set_back_are_not_used(back: float, tmp_path: Path) -> None:
    """Otherwise, two places of the cup that are seconds apart would be at one time."""
    messages = [
        transform("cup", (tick, 0, 0), stamp=1 + tick / 10 - back * (tick > 25), received=1 + tick / 10)
        for tick in range(60)
    ]
    found = read_log(write(tmp_path / "drive", messages))
    assert np.isnan(found.tracks["cup"].positions).all()
    assert any("the headers of 'cup' on '/tf' jump back by" in one for one in found.remarks)


def test_a_late_message_is_no_clock_that_was_set_back(tmp_path: Path) -> None:
    received = [1 + tick / 10 + 0.35 * (tick == 25) for tick in range(60)]
    messages = [transform("cup", (tick, 0, 0), stamp=1 + tick / 10, received=received[tick]) for tick in range(60)]
    found = read_log(write(tmp_path / "drive", sorted(messages, key=lambda one: one.received)))
    assert found.tracks["cup"].positions[:, 0].tolist() == list(range(60))


@pytest.mark.parametrize("named", ["folder", "file"])
def test_messages_in_a_write_ahead_log_are_read(named: str, tmp_path: Path) -> None:
    """The recorder was killed: its file is nearly empty, and has not even tables."""
    (source,) = write(tmp_path / "source", DRIVE).glob("*.db3")
    folder, recorded = tmp_path / "drive", tmp_path / "recording" / "drive.db3"
    recorded.parent.mkdir()
    connection = sqlite3.connect(recorded)
    connection.execute("PRAGMA journal_mode=WAL")
    connection.execute("PRAGMA wal_autocheckpoint=0")
    connection.execute("ATTACH ? AS whole", (str(source),))
    tables = "FROM whole.sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite%'"
    for name, statement in connection.execute(f"SELECT name, sql {tables}").fetchall():
        connection.execute(statement)
        connection.execute(f"INSERT INTO main.{name} SELECT * FROM whole.{name}")
    connection.commit()
    shutil.copytree(recorded.parent, folder)
    connection.close()
    before = {one.name: one.read_bytes() for one in folder.iterdir()}
    found = read_log(folder if named == "folder" else folder / "drive.db3")
    assert len(found.tracks["cup"].times) == 30
    assert found.unfinished, "the end of what was written is not the end of the scenario"
    assert "its last messages were read from the write-ahead log" in found.remarks[0]
    assert {one.name: one.read_bytes() for one in folder.iterdir()} == before, "a log is never changed"


def test_a_stamp_with_too_many_nanoseconds_is_the_sum(tmp_path: Path) -> None:
    def stamped(nanoseconds: int, x: float) -> Message:
        plain = transform("cup", (x, 0, 0), stamp=1.0)

        def make(store: Any) -> Any:
            content = plain.make(store)
            time = store.types["builtin_interfaces/msg/Time"](sec=1, nanosec=nanoseconds)
            content.transforms[0].header.stamp = time
            return content

        return Message("/tf", 1 + nanoseconds / 1e9, plain.kind, make)

    found = read_log(write(tmp_path / "drive", [stamped(0, 0), stamped(1_500_000_000, 1), stamped(4_000_000_000, 2)]))
    assert found.tracks["cup"].times.tolist() == [0.0, 1.5, 4.0]


@pytest.mark.parametrize("name", ["a.db3", "a.bag", "a.mcap", "a.csv"])
def test_an_empty_file_is_refused(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(b"")
    with pytest.raises(UnreadableLog, match=name):
        read_log(tmp_path / name)


def test_a_type_that_only_the_file_defines_reports_an_event(tmp_path: Path) -> None:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    from robbdd_tools.protocol.event_signals import read_event_signal

    store = get_typestore(Stores.ROS2_HUMBLE)
    kind, fields = "cell_msgs/msg/State", "uint8 IDLE=0\nuint8 PICKED=3\nuint8 mode\nstring note"
    store.register(get_types_from_msg(fields, kind))
    idl = "module cell_msgs { module msg { struct State { uint8 mode; string note; }; }; };"
    for encoding, definition in (("ros2msg", fields), ("ros2idl", idl)):
        path = tmp_path / f"{encoding}.mcap"
        with path.open("wb") as file:
            writer = McapWriter(file)
            writer.start(profile="ros2")
            channel = writer.register_channel(
                "/cell", "cdr", writer.register_schema(kind, encoding, definition.encode())
            )
            for tick in range(5):
                data = store.serialize_cdr(store.types[kind](mode=3 * (tick > 2), note=""), kind)
                writer.add_message(channel, tick * 10**9, bytes(data), tick * 10**9)
            writer.finish()
        found = read_log(path, signals=[read_event_signal("evt-pick-end=/cell.mode becomes 3")])
        assert [(one.text, one.time) for one in found.texts] == [("evt-pick-end", 0.0)], encoding
