"""Read the messages of a SQLite file of a rosbag2 that is still being written."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from mcap.records import Channel, Message, Schema

from robbdd_tools.logs.mcap_records import McapMessage


class SqliteRecords:
    """The messages of a SQLite file in the order in which they were written, as records of MCAP.

    Call ``new_messages`` again when the file has grown. A schema is empty if the file does not define its type.
    """

    complete = False
    """Such a file has no end: only the folder's ``metadata.yaml`` says that the recorder has stopped."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._last = -1

    def new_messages(self) -> Iterator[McapMessage]:
        """Yield the committed messages that have not been read yet; none before the recorder has made its tables."""
        try:
            with closing(sqlite3.connect(f"{self._path.absolute().as_uri()}?mode=ro", uri=True)) as connection:
                channels = dict(_channels(connection))
                query = "SELECT id, topic_id, timestamp, data FROM messages WHERE id > ? ORDER BY id"
                for number, topic, time, data in connection.execute(query, [self._last]):
                    self._last = number
                    schema, channel = channels[topic]
                    yield McapMessage(schema, channel, Message(topic, time, bytes(data), time, 0))
        except sqlite3.OperationalError:
            # The recorder is making the tables, or has locked the file: the next reading gets the messages.
            return


def _channels(connection: sqlite3.Connection) -> Iterator[tuple[int, tuple[Schema, Channel]]]:
    defined: dict[str, tuple[str, str]] = {}
    if connection.execute("SELECT 1 FROM sqlite_master WHERE name = 'message_definitions'").fetchone():
        query = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"
        defined = {kind: (encoding, text) for kind, encoding, text in connection.execute(query)}
    for number, name, kind, encoding in connection.execute("SELECT id, name, type, serialization_format FROM topics"):
        form, text = defined.get(kind, ("ros2msg", ""))
        schema = Schema(data=text.encode(), encoding=form, id=number, name=kind)
        yield number, (schema, Channel(id=number, topic=name, message_encoding=encoding, metadata={}, schema_id=number))
