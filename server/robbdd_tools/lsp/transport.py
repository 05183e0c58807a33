"""Standard input as the protocol frames it: headers of any form, messages of a limited size, and an end that holds."""

from __future__ import annotations

import logging
import os
import re
import threading
from typing import IO, BinaryIO, cast

from robbdd_tools.base.limits import MESSAGE_SIZE

LONGEST_HEADER = 4096
"""Bytes of a header line that are kept; a longer one is none of the protocol's."""
EXIT_SECONDS = 5.0
"""Seconds that threads have to end after the client has gone or has said ``exit``."""
_CHUNK = 1 << 16
# At the end of a line: what is left of a message whose length was wrong may be before it.
_LENGTH = re.compile(rb"content-length[ \t]*:[ \t]*(\d{1,18})[ \t]*\r?\n$", re.IGNORECASE)
_LOG = logging.getLogger(__name__)


class BoundedInput:
    """The lines and contents that pygls reads, with headers in the one form that it knows.

    A message larger than the limit is skipped and logged. After a broken header the next sound one is found again.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._has_length = False

    def readline(self) -> bytes:
        """Return the next header line, ``b""`` at the end of the input."""
        line = self._line()
        stated = _LENGTH.search(line)
        if stated is not None:
            length = int(stated[1])
            if length > MESSAGE_SIZE.value():
                _LOG.error("a message of %d bytes is skipped; the limit is %d", length, MESSAGE_SIZE.value())
                return self._skip(length)
            self._has_length = length > 0
            return b"Content-Length: %d\r\n" % length if self._has_length else b"\n"
        if line and not line.strip():
            if not self._has_length:
                _LOG.error("a message without 'Content-Length' is skipped")
            return b"\r\n"
        return line

    def read(self, size: int) -> bytes:
        """Return the content of a message, less at the end of the input."""
        self._has_length = False
        return self._stream.read(size)

    def _line(self) -> bytes:
        line = self._stream.readline(LONGEST_HEADER)
        while len(line) >= LONGEST_HEADER and not line.endswith(b"\n"):
            # The last bytes may be the beginning of a sound header.
            line = line[-128:] + self._stream.readline(LONGEST_HEADER)
        return line

    def _skip(self, length: int) -> bytes:
        while self._line().strip():
            pass
        while length > 0 and (data := self._stream.read(min(length, _CHUNK))):
            length -= len(data)
        return b"\n" if length == 0 else b""


def bounded(stream: IO[bytes]) -> BinaryIO:
    """Return a stream for pygls, which reads lines and contents and nothing else."""
    return cast("BinaryIO", BoundedInput(cast("BinaryIO", stream)))


def end_soon(code: int, seconds: float = EXIT_SECONDS) -> None:
    """End the process with an exit code within some seconds, even while a thread or a worker hangs."""

    def end() -> None:
        _LOG.error("a thread still works %g s after the end of the session: the process is ended", seconds)
        os._exit(code)

    timer = threading.Timer(seconds, end)
    timer.daemon = True
    timer.start()


class RefusalFilter(logging.Filter):
    """Keeps out of the log what is an answer: a request that is refused with a reason, such as a rename of nothing."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a record is an error of ours."""
        error = record.exc_info[1] if record.exc_info else None
        if error is None or not record.name.startswith("pygls"):
            return True
        return not any(kind.__name__ == "JsonRpcException" for kind in type(error).__mro__)
