"""Read the complete part of an MCAP file that is still being recorded, or whose recording was interrupted."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.event_watch import EventWatch
from robbdd_tools.logs.foxglove_mcap import OWN_TRACE, READ, take_json
from robbdd_tools.logs.log_contents import LogContents, UnreadableLog
from robbdd_tools.logs.mcap_records import MAGIC, McapRecords
from robbdd_tools.logs.ros_bag import NO_ROSBAGS, not_read, stated_clocks, take_message
from robbdd_tools.logs.ros_messages import READERS, RosContents

if TYPE_CHECKING:
    from robbdd_tools.logs.mcap_records import McapMessage
    from robbdd_tools.protocol.event_signals import EventSignal

Decoder = Callable[[bytes], Any]


def is_cut(path: Path) -> bool:
    """Return whether an MCAP file has no end. Raises ``UnreadableFile`` and ``OSError``."""
    with open_regular(path) as file:
        size = file.seek(0, 2)
        file.seek(max(size - len(MAGIC), 0))
        return size <= len(MAGIC) or file.read() != MAGIC


def read_mcap(path: Path, clocks: Mapping[str, float], signals: Iterable[EventSignal]) -> LogContents:
    """Return the contents of an MCAP file with messages of ROS 2 or of Foxglove in JSON, or both.

    A file without an end is read up to its last complete record. Raises ``UnreadableLog``.
    """
    log = GrowingMcap(path, clocks, signals)
    if not log.read():
        raise UnreadableLog(f"{path} cannot be read as MCAP: it has no complete record with a message")
    log.check()
    found = log.contents()
    if log.complete:
        return found
    words = f"the recording of {path.name} was interrupted: it is read up to its last complete record, at"
    return replace(found, unfinished=True, remarks=(f"{words} {found.end:.2f} s", *found.remarks))


class GrowingMcap:
    """The contents of an MCAP file with messages of ROS 2 or of Foxglove in JSON. ``read`` adds new messages."""

    def __init__(self, path: Path, clocks: Mapping[str, float], signals: Iterable[EventSignal]) -> None:
        self._path = path
        self._records = McapRecords(path)
        self._clocks = clocks
        self._contents, self._watch = RosContents(clocks), EventWatch(signals)
        self._decoders: dict[str, Decoder | None] = {}
        self._topics: dict[str, str] = {}

    @property
    def complete(self) -> bool:
        """Whether the recorder has written the end of the file."""
        return self._records.complete

    @property
    def empty(self) -> bool:
        """Whether no message has been read so far."""
        return not self._topics

    def read(self) -> bool:
        """Read the new messages; return whether there were any. Raises ``UnreadableLog``."""
        count = 0
        for one in self._records.new_messages():
            count += 1
            self._take(one)
        return count > 0

    def check(self) -> None:
        """Raise ``UnreadableLog`` if a topic that the user states has not occurred so far."""
        self._watch.check(self._topics)
        list(stated_clocks(self._clocks, {topic: kind for topic, kind in self._topics.items() if kind in READERS}))

    def contents(self) -> LogContents:
        """Return the contents that have been read so far."""
        # Finishing converts times by clocks that later messages may change.
        found = deepcopy(self._contents)
        found.remarks += self._watch.remarks
        unread = {topic: kind for topic, kind in self._topics.items() if kind not in READERS and kind not in READ}
        found.remarks += not_read({one: unread[one] for one in unread if one not in self._watch.topics}, ())
        return found.finish()

    def _take(self, one: McapMessage) -> None:
        topic, kind = one.channel.topic, "" if one.schema is None else one.schema.name
        self._topics[topic] = kind
        if one.channel.message_encoding == OWN_TRACE:
            raise UnreadableLog(f"{self._path} is the trace of a simulated execution: judge its run, by its number")
        if kind not in READERS and kind not in READ and topic not in self._watch.topics:
            return
        try:
            self._take_known(one, topic, kind)
        except UnreadableLog as error:
            raise UnreadableLog(f"{self._path}: {error}") from None
        except Exception as error:  # On damaged bytes each decoder raises exceptions of its own types.
            words = f"{self._path} cannot be read: '{topic}' ({kind}): {error or type(error).__name__}"
            raise UnreadableLog(words) from error

    def _take_known(self, one: McapMessage, topic: str, kind: str) -> None:
        received = one.message.log_time
        if one.channel.message_encoding == "json":
            message = json.loads(one.message.data)
            if kind in READ:
                take_json(self._contents.found, topic, kind, received, message)
            for event in self._watch.events(topic, message) if topic in self._watch.topics else ():
                self._contents.found.text(topic, received, event)
            return
        if kind not in self._decoders:
            self._decoders[kind] = _decoder(one)
        decoder = self._decoders[kind]
        if decoder is not None:
            self._contents.ahead = round(self._clocks.get(topic, 0.0) * 1e9)
            take_message(self._contents, self._watch, (topic, kind), received, decoder(one.message.data))


def _decoder(one: McapMessage) -> Decoder | None:
    """Return the function that decodes messages of a channel of ROS 2; ``None`` for other encodings."""
    schema = one.schema
    if schema is None or one.channel.message_encoding != "cdr" or schema.encoding != "ros2msg":
        return None
    try:
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    except ImportError:
        raise UnreadableLog(NO_ROSBAGS) from None
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(schema.data.decode(), schema.name))
    return lambda data: store.deserialize_cdr(data, schema.name)
