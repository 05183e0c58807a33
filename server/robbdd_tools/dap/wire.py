"""Messages of the Debug Adapter Protocol on a pair of byte streams.

No maintained library has types for adapters: those of debugpy are private, others are for clients only.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from threading import Lock
from typing import Any, BinaryIO

from robbdd_tools.base.limits import MESSAGE_SIZE

LONGEST_HEADER = 4096
"""Maximum bytes of a header line."""


class BrokenMessage(Exception):
    """The input is not the Debug Adapter Protocol; the message gives the reason."""


class Wire:
    """Reads the client's messages; numbers and writes the adapter's messages."""

    def __init__(self, received: BinaryIO, sent: BinaryIO) -> None:
        self._received = received
        self._sent = sent
        self._number = 0
        self._writing = Lock()

    def messages(self) -> Iterator[dict[str, Any]]:
        """Yield the client's messages until the input ends. Raises ``BrokenMessage``."""
        while (length := self._length()) is not None:
            content = self._received.read(length)
            if len(content) < length:
                return
            try:
                message = json.loads(content)
            except ValueError as error:
                raise BrokenMessage(f"a message is not JSON: {error}") from None
            if not isinstance(message, dict):
                raise BrokenMessage("a message is not a JSON object")
            yield message

    def write(self, kind: str, **fields: Any) -> int:
        """Send a message; return its number. If the client has gone, nothing is sent."""
        with self._writing:
            self._number += 1
            content = json.dumps({"seq": self._number, "type": kind, **fields}).encode()
            try:
                self._sent.write(b"Content-Length: %d\r\n\r\n%b" % (len(content), content))
                self._sent.flush()
            except (OSError, ValueError):  # the end of the input ends the adapter
                pass
            return self._number

    def _length(self) -> int | None:
        """Read a header; return the length of its message, or ``None`` at the end of the input."""
        length: int | None = None
        while line := self._received.readline(LONGEST_HEADER):
            name, _, value = line.partition(b":")
            if name.strip().lower() == b"content-length" and value.strip().isdigit():
                length = int(value)
            elif not line.strip() and length is not None:
                if length > MESSAGE_SIZE.value():
                    raise BrokenMessage(f"a message has {length} bytes; the limit is {MESSAGE_SIZE.value()}")
                return length
            elif not line.strip():
                raise BrokenMessage("a message has no Content-Length")
        return None
