"""Folders of a rosbag2 that are still recorded: SQLite files that grow, and files that follow one another."""

from __future__ import annotations

import shutil
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from logs.bags import Message, text, transform, truth, write
from robbdd_tools.logs.growing_mcap import GrowingMcap
from robbdd_tools.logs.log_contents import LogContents
from robbdd_tools.logs.open_log import read_log
from robbdd_tools.protocol.event_signals import read_event_signal

SIGNAL = read_event_signal("on=/seen becomes true")


def messages(begin: int, end: int) -> list[Message]:
    return [
        one
        for tick in range(begin, end)
        for one in (
            transform("cup", (tick, 0, 0), stamp=1 + tick / 100),
            text(f"e{tick}", 1 + tick / 100),
            truth("/seen", tick % 7 == 0, 1 + tick / 100),
        )
    ]


def assert_same(found: LogContents, expected: LogContents) -> None:
    assert found.texts == expected.texts
    assert np.array_equal(found.tracks["cup"].times, expected.tracks["cup"].times)
    assert np.array_equal(found.tracks["cup"].positions, expected.tracks["cup"].positions)
    assert np.array_equal(found.truths["/seen"].values, expected.truths["/seen"].values)


@pytest.mark.parametrize("kind", ["sqlite", "old"])
def test_a_sqlite_file_that_grows_says_in_the_end_what_the_whole_one_says(kind: str, tmp_path: Path) -> None:
    whole = write(tmp_path / "whole", messages(0, 100), kind)
    (source,) = whole.glob("*.db3")
    folder = tmp_path / "drive"
    folder.mkdir()
    log = GrowingMcap(folder, {}, [SIGNAL])
    assert not log.read()
    (folder / "drive_0.db3").write_bytes(b"")
    assert not log.read(), "the recorder has not made its tables yet"
    recorder = sqlite3.connect(folder / "drive_0.db3")
    recorder.execute("PRAGMA journal_mode=WAL")
    recorder.execute("ATTACH ? AS whole", (str(source),))
    tables = "FROM whole.sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite%'"
    for name, statement in recorder.execute(f"SELECT name, sql {tables}").fetchall():
        recorder.execute(statement)
        if name != "messages":
            recorder.execute(f"INSERT INTO main.{name} SELECT * FROM whole.{name}")
    counts: list[int] = []
    for begin in range(0, 300, 50):
        query = "INSERT INTO main.messages SELECT * FROM whole.messages WHERE id > ? AND id <= ?"
        recorder.execute(query, (begin, begin + 50))
        recorder.commit()
        assert log.read()
        assert not log.complete
        counts.append(len(log.contents().texts))
    assert counts == sorted(set(counts))
    assert not log.read()
    recorder.close()
    shutil.copyfile(whole / "metadata.yaml", folder / "metadata.yaml")
    assert log.complete
    assert_same(log.contents(), read_log(whole, signals=[SIGNAL]))


def test_files_that_follow_one_another_are_one_recording(tmp_path: Path) -> None:
    """The tenth file comes after the ninth, and a file that is begun has no end yet."""
    expected = read_log(write(tmp_path / "whole", messages(0, 110), "mcap"), signals=[SIGNAL])
    folder = tmp_path / "drive"
    folder.mkdir()
    log = GrowingMcap(folder, {}, [SIGNAL])
    for number in range(11):
        part = write(tmp_path / f"part{number}", messages(10 * number, 10 * number + 10), "mcap")
        (source,) = part.glob("*.mcap")
        data = source.read_bytes()
        path = folder / f"drive_{number}.mcap"
        path.write_bytes(data[:60])
        log.read()
        path.write_bytes(data)
        assert log.read()
        assert not log.complete, "another file may follow"
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  message_count: 30\n", encoding="utf-8")
    assert not log.complete, "the metadata is that of the first file"
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  message_count: 330\n", encoding="utf-8")
    assert log.complete
    assert_same(log.contents(), expected)


def test_files_that_exist_already_are_read_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    folder = tmp_path / "drive"
    folder.mkdir()
    for number in (10, 9):
        part = write(tmp_path / f"part{number}", messages(10 * number, 10 * number + 10), "mcap")
        shutil.copyfile(next(part.glob("*.mcap")), folder / f"drive_{number}.mcap")
    log = GrowingMcap(folder, {}, [SIGNAL])
    log.read()
    assert [one.text for one in log.contents().texts if one.text != "on"] == [f"e{tick}" for tick in range(90, 110)]
