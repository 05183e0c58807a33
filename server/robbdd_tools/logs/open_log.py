"""Determine the kind of a log, and read it."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.logs.growing_mcap import is_cut, is_of_ros, read_mcap
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.log_files import METADATA, SUFFIXES, bag_files
from robbdd_tools.logs.log_table import read_table
from robbdd_tools.logs.mcap_annotations import annotated, read_annotations
from robbdd_tools.logs.parquet_table import PARQUET
from robbdd_tools.logs.ros_bag import read_ros_bag
from robbdd_tools.logs.sqlite_wal import has_wal, without_wal

if TYPE_CHECKING:
    from robbdd_tools.protocol.event_signals import EventSignal

ReceivedEvent = tuple[int, str, str]
"""The time of reception (ns), a topic, and an event."""


def read_log(
    path: Path,
    columns: Mapping[str, str] | None = None,
    clocks: Mapping[str, float] | None = None,
    signals: Sequence[EventSignal] = (),
) -> LogContents:
    """Return the contents of a log.

    ``columns`` maps names of a table's columns to titles in the file. ``clocks`` maps topics of a ROS bag to the time
    (s) by which the clock of their headers is ahead. ``signals`` define which messages report events; these become
    texts.

    Raises ``UnreadableLog``.
    """
    if has_wal(path):
        return _with_wal(path, columns, clocks, signals)
    if not path.is_dir() and path.suffix.lower() in (".csv", PARQUET):
        return _checked(path, _read_table(path, columns, clocks, signals))
    files = bag_files(path) if path.is_dir() else [path]
    found = read_annotations(one for one in files if one.suffix.lower() == ".mcap" and not is_cut(one))
    contents = (_read_folder if path.is_dir() else _read_file)(path, clocks, signals, found.received)
    return _checked(path, annotated(contents, found))


def _read_file(
    path: Path, clocks: Mapping[str, float] | None, signals: Sequence[EventSignal], events: Sequence[ReceivedEvent]
) -> LogContents:
    match path.suffix.lower():
        case ".mcap" if is_cut(path) or not is_of_ros(path):
            return read_mcap(path, clocks or {}, signals, events)
        case ".bag" | ".db3" | ".mcap":
            return read_ros_bag(path, clocks, signals, events)
        case _:
            raise UnreadableLog(f"{path} is no log: name a rosbag2 folder, or a file {', '.join(SUFFIXES)}")


def _read_table(
    path: Path, columns: Mapping[str, str] | None, clocks: Mapping[str, float] | None, signals: Sequence[EventSignal]
) -> LogContents:
    if signals:
        raise UnreadableLog(f"{path} has no topics: name the events of a table in a column 'event'")
    if clocks:
        raise UnreadableLog(f"{path} has one clock: clocks of topics can be stated for bags only")
    return read_table(path, columns)


def _with_wal(
    path: Path, columns: Mapping[str, str] | None, clocks: Mapping[str, float] | None, signals: Sequence[EventSignal]
) -> LogContents:
    try:
        with without_wal(path) as copied:
            found = read_log(copied, columns, clocks, signals)
    except sqlite3.Error as error:
        raise UnreadableLog(f"{path} cannot be read: {error}") from error
    words = f"the recorder of {path.name} did not end: its last messages were read from the write-ahead log"
    return replace(found, unfinished=True, remarks=(words, *found.remarks))


def _read_folder(
    path: Path, clocks: Mapping[str, float] | None, signals: Sequence[EventSignal], events: Sequence[ReceivedEvent]
) -> LogContents:
    """Return the contents of a rosbag2 folder.

    If the recording was interrupted, the folder has no metadata, and its last file has no end.
    """
    files = bag_files(path)
    if len(files) == 1 and files[0].suffix.lower() == ".mcap" and is_cut(files[0]):
        return read_mcap(files[0], clocks or {}, signals)
    if (path / METADATA).is_file():
        return read_ros_bag(path, clocks, signals, events)
    if len(files) != 1:
        raise UnreadableLog(f"{path} has no {METADATA} and several files: write it with 'ros2 bag reindex {path.name}'")
    found = read_ros_bag(files[0], clocks, signals, events)
    if files[0].suffix.lower() == ".mcap":
        return found
    words = f"{path.name} has no {METADATA}, so its recorder did not end"
    return replace(found, unfinished=True, remarks=(words, *found.remarks))


def _checked(path: Path, found: LogContents) -> LogContents:
    if not (found.tracks or found.texts or found.truths or found.joints or found.forces):
        raise UnreadableLog(
            f"{path} contains no message that can be judged: record transforms, poses, joint states or texts of events"
        )
    return found
