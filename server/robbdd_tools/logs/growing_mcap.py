"""Read MCAP files with messages of ROS 2 or of Foxglove, complete, cut off or still being recorded."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcap.reader import NonSeekingReader, make_reader

from robbdd_tools.base.files import load_text, open_regular
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.logs.event_watch import EventWatch
from robbdd_tools.logs.foxglove_messages import FOXGLOVE, take_foxglove
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.mcap_records import MAGIC, McapMessage, McapRecords
from robbdd_tools.logs.protobuf_decoding import protobuf_decoder
from robbdd_tools.logs.ros_bag import NO_ROSBAGS, not_read, stated_clocks, take_message
from robbdd_tools.logs.ros_definitions import known_types
from robbdd_tools.logs.ros_messages import READERS, RosContents
from robbdd_tools.logs.sqlite_records import SqliteRecords

if TYPE_CHECKING:
    from robbdd_tools.protocol.event_signals import EventSignal

Decoder = Callable[[bytes], Any]
OWN_TRACE = "robbdd-trace-1"
"""Encoding of the exact trace, which files of simulated runs contain."""
_COUNT = re.compile(r"^  message_count: (\d+)\s*$", re.MULTILINE)
ROS_PROFILE = "ros2"
PLAIN = ("json", "protobuf")
"""Encodings of messages that become plain data."""


def is_cut(path: Path) -> bool:
    """Return whether an MCAP file has no end. Raises ``UnreadableFile`` and ``OSError``."""
    with open_regular(path) as file:
        size = file.seek(0, 2)
        file.seek(max(size - len(MAGIC), 0))
        return size <= len(MAGIC) or file.read() != MAGIC


def is_of_ros(path: Path) -> bool:
    """Return whether an MCAP file has the ROS 2 profile, and messages of ROS 2 only. Raises ``UnreadableLog``."""
    try:
        with open_regular(path) as file:
            reader = make_reader(file)
            summary = reader.get_summary()
            found = set[str]() if summary is None else {one.message_encoding for one in summary.channels.values()}
            # rosbags requires an index of the chunks.
            is_indexed = summary is not None and bool(summary.chunk_indexes)
            return found == {"cdr"} and is_indexed and reader.get_header().profile == ROS_PROFILE
    except Exception as error:  # On damaged bytes the decoder raises exceptions of several types.
        raise UnreadableLog(f"{path} cannot be read as MCAP: {error or type(error).__name__}") from error


def read_mcap(
    path: Path,
    clocks: Mapping[str, float],
    signals: Iterable[EventSignal],
    events: Iterable[tuple[int, str, str]] = (),
) -> LogContents:
    """Return the contents of an MCAP file with messages of ROS 2, or of Foxglove in JSON or Protobuf, or both.

    A file without an end is read up to its last complete record. ``events`` are further ones: the time of reception
    (ns), a topic, and the event. Raises ``UnreadableLog``.
    """
    log = GrowingMcap(path, clocks, signals)
    if not is_cut(path):
        log.read_whole()
        log.add(events)
        log.check()
        return log.contents()
    if not log.read():
        raise UnreadableLog(f"{path} cannot be read as MCAP: it has no complete record with a message")
    log.check()
    found = log.contents()
    if log.complete:
        return found
    words = f"the recording of {path.name} was interrupted: it is read up to its last complete record, at"
    return replace(found, unfinished=True, remarks=(f"{words} {found.end:.2f} s", *found.remarks))


class GrowingMcap:
    """The contents of a file with messages of ROS 2 or of Foxglove, or of a folder of such files.

    The files are MCAP files, or SQLite files of a rosbag2. ``read`` adds new messages, and new files of the folder.
    """

    def __init__(self, path: Path, clocks: Mapping[str, float], signals: Iterable[EventSignal]) -> None:
        self._path = path
        self._records: dict[Path, McapRecords | SqliteRecords] = {}
        self._count = 0
        self._clocks = clocks
        self._contents, self._watch = RosContents(clocks), EventWatch(signals)
        self._decoders: dict[tuple[str, str], Decoder | None] = {}
        self._topics: dict[str, str] = {}

    @property
    def complete(self) -> bool:
        """Whether the recorder has written the end of the file, or the metadata of all messages of the folder."""
        if self._path.is_dir():
            return _recorded(self._path) == self._count
        return all(one.complete for one in self._records.values()) and bool(self._records)

    @property
    def empty(self) -> bool:
        """Whether no message has been read so far."""
        return not self._topics

    def read(self) -> bool:
        """Read the new messages, in the order of the file; return whether there were any. Raises ``UnreadableLog``."""
        before = self._count
        for path in _files(self._path) if self._path.is_dir() else [self._path]:
            if path not in self._records:
                self._records[path] = (SqliteRecords if path.suffix.lower() == ".db3" else McapRecords)(path)
            for one in self._records[path].new_messages():
                self._count += 1
                self._take(one)
        return self._count > before

    def read_whole(self) -> None:
        """Read a complete file in the order of reception, which is not always that of the file.

        Raises ``UnreadableLog``.
        """
        try:
            with open_regular(self._path) as file:
                reader = make_reader(file, validate_crcs=True)
                summary = reader.get_summary()
                if summary is None or not summary.channels:
                    # Without a summary of the channels, all of the file is read before the first message.
                    file.seek(0)
                    reader = NonSeekingReader(file, validate_crcs=True)
                for found in reader.iter_messages():
                    self._take(McapMessage(*found))
        except UnreadableLog:
            raise
        except Exception as error:  # Damaged bytes raise exceptions of the decompressors, too.
            raise UnreadableLog(f"{self._path} cannot be read as MCAP: {error or type(error).__name__}") from error

    def add(self, events: Iterable[tuple[int, str, str]]) -> None:
        """Add events: the time of reception (ns), a topic, and the event."""
        for received, topic, event in events:
            self._contents.found.text(topic, received, event, declared=True)

    def check(self) -> None:
        """Raise ``UnreadableLog`` if a topic that the user states has not occurred so far."""
        self._watch.check(self._topics)
        known = {topic: kind for topic, kind in self._topics.items() if kind in READERS or kind in FOXGLOVE}
        list(stated_clocks(self._clocks, known))

    def contents(self) -> LogContents:
        """Return the contents that have been read so far."""
        # Finishing converts times by clocks that later messages may change.
        found = deepcopy(self._contents)
        found.remarks += self._watch.remarks
        unread = {topic: kind for topic, kind in self._topics.items() if kind not in READERS and kind not in FOXGLOVE}
        found.remarks += not_read({one: unread[one] for one in unread if one not in self._watch.topics}, ())
        return found.finish()

    def _take(self, one: McapMessage) -> None:
        topic, kind = one.channel.topic, "" if one.schema is None else one.schema.name
        self._topics[topic] = kind
        if one.channel.message_encoding == OWN_TRACE:
            raise UnreadableLog(f"{self._path} is the trace of a simulated execution: judge its run, by its number")
        if kind not in READERS and kind not in FOXGLOVE and topic not in self._watch.topics:
            return
        try:
            self._take_known(one, topic, kind)
        except UnreadableLog as error:
            raise UnreadableLog(f"{self._path}: {error}") from None
        except Exception as error:  # On damaged bytes each decoder raises exceptions of its own types.
            words = f"{self._path} cannot be read: '{topic}' ({kind}): {error or type(error).__name__}"
            raise UnreadableLog(words) from error

    def _take_known(self, one: McapMessage, topic: str, kind: str) -> None:
        received, encoding = one.message.log_time, one.channel.message_encoding
        if (encoding, kind) not in self._decoders:
            self._decoders[encoding, kind] = _decoder(one)
        decoder = self._decoders[encoding, kind]
        if decoder is None:
            return
        message = decoder(one.message.data)
        self._contents.ahead = round(self._clocks.get(topic, 0.0) * 1e9)
        if encoding not in PLAIN:
            take_message(self._contents, self._watch, (topic, kind), received, message)
            return
        if kind in FOXGLOVE:
            take_foxglove(self._contents, topic, kind, received, message)
        for event in self._watch.events(topic, message) if topic in self._watch.topics else ():
            self._contents.found.text(topic, received, event, declared=True)


def _files(folder: Path) -> list[Path]:
    """Return the files of a folder in the order in which a recorder makes them: ``drive_9``, ``drive_10`` …"""
    files = [one for one in folder.iterdir() if one.suffix.lower() in (".mcap", ".db3") and one.is_file()]
    numbers = {one: [int(part) for part in re.findall(r"\d+", one.stem)] for one in files}
    return sorted(files, key=lambda one: (re.sub(r"\d+", "", one.stem), numbers[one], one.name))


def _recorded(folder: Path) -> int | None:
    """Return how many messages the folder of a rosbag2 has by its metadata; ``None`` if it does not say so yet."""
    path = folder / "metadata.yaml"
    found = _COUNT.search(load_text(path, RESULT_SIZE)) if path.is_file() else None
    return None if found is None else int(found[1])


def _decoder(one: McapMessage) -> Decoder | None:
    """Return the function that decodes messages of a channel; ``None`` for encodings that are not read."""
    schema, encoding = one.schema, one.channel.message_encoding
    if encoding == "json":
        return json.loads
    if schema is None:
        return None
    if encoding == "protobuf" and schema.encoding == "protobuf":
        return protobuf_decoder(schema.name, schema.data)
    if encoding != "cdr" or schema.encoding not in ("ros2msg", "ros2idl"):
        return None
    try:
        from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
    except ImportError:
        raise UnreadableLog(NO_ROSBAGS) from None
    if not schema.data:
        known = known_types()
        return (lambda data: known.deserialize_cdr(data, schema.name)) if schema.name in known.fielddefs else None
    store = get_typestore(Stores.EMPTY)
    text = schema.data.decode()
    store.register(get_types_from_msg(text, schema.name) if schema.encoding == "ros2msg" else get_types_from_idl(text))
    return lambda data: store.deserialize_cdr(data, schema.name)
