"""Read the complete records of an MCAP file that is still being written or was cut off."""

from __future__ import annotations

import os
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

from mcap.exceptions import EndOfFile
from mcap.records import Channel, Footer, Message, Schema
from mcap.stream_reader import StreamReader

from robbdd_tools.base.files import open_regular
from robbdd_tools.logs.log_contents import UnreadableLog

MAGIC = b"\x89MCAP0\r\n"
HEAD = 9
"""Bytes before the content of a record: its kind, and its length (8 bytes, little-endian)."""


class McapMessage(NamedTuple):
    """A message with its channel; ``schema`` is ``None`` for a channel without one."""

    schema: Schema | None
    channel: Channel
    message: Message


class McapRecords:
    """The messages of an MCAP file in the order of the file. Call ``new_messages`` again when the file has grown."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._offset = 0
        self._schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.complete = False
        """Whether the end of the file, which a recorder writes when it stops, has been read."""

    def new_messages(self) -> Iterator[McapMessage]:
        """Yield the messages of complete records that have not been read yet. Raises ``UnreadableLog``."""
        with open_regular(self._path) as file:
            if not self._offset:
                magic = file.read(len(MAGIC))
                if magic != MAGIC[: len(magic)]:
                    raise UnreadableLog(f"{self._path} cannot be read as MCAP: it does not begin as such a file")
                if len(magic) < len(MAGIC):
                    return
                self._offset = len(MAGIC)
            file.seek(self._offset)
            while not self.complete:
                head = file.read(HEAD)
                length = int.from_bytes(head[1:], "little")
                # The length in a damaged file can be larger than any memory.
                if len(head) < HEAD or length > os.fstat(file.fileno()).st_size - file.tell():
                    return
                body = file.read(length)
                yield from self._messages(head + body)
                self._offset += HEAD + length

    def _messages(self, record: bytes) -> Iterator[McapMessage]:
        for one in _parsed(self._path, record):
            if isinstance(one, Schema):
                self._schemas[one.id] = one
            elif isinstance(one, Channel):
                self.channels[one.id] = one
            elif isinstance(one, Footer):
                self.complete = True
            elif isinstance(one, Message) and one.channel_id in self.channels:
                channel = self.channels[one.channel_id]
                yield McapMessage(self._schemas.get(channel.schema_id), channel, one)


def _parsed(path: Path, record: bytes) -> Iterator[object]:
    """Yield the records of a chunk; for any other record, the record itself."""
    try:
        yield from StreamReader(BytesIO(record), skip_magic=True, validate_crcs=True).records
    except EndOfFile:
        # The reader expects a further record, or the magic after the footer.
        return
    except Exception as error:  # Damaged bytes raise exceptions of the decompressors, too.
        raise UnreadableLog(f"{path} is damaged: {error or type(error).__name__}") from error
