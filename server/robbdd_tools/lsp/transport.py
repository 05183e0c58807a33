"""Input of the server for pygls. It tolerates variants of headers, limits the size of messages, and ends reliably."""

from __future__ import annotations

import asyncio
import logging
import os
import re
import threading
from collections.abc import Callable
from typing import IO, BinaryIO, Protocol, cast

from robbdd_tools.base.limits import MESSAGE_SIZE

LONGEST_HEADER = 4096
"""Maximum bytes of a header line; the protocol has no longer ones."""
WAKING_SECONDS = 1.0
"""Maximum seconds until the event loop notices a signal."""
EXIT_SECONDS = 5.0
"""Seconds that threads have to end after the client has gone or has sent ``exit``."""
_CHUNK = 1 << 16
# Matched at the end of a line: the rest of a message with a wrong length may precede it.
_LENGTH = re.compile(rb"content-length[ \t]*:[ \t]*(\d{1,18})[ \t]*\r?\n$", re.IGNORECASE)
_LOG = logging.getLogger(__name__)


class HeaderTimer(Protocol):
    """Limits the time from the first byte of a header to its end."""

    def begin_header(self) -> None:
        """Wait for the first byte of a header, then start its time."""
        ...

    def end_header(self) -> None:
        """Stop the time: the header is complete."""
        ...


class Connection(Protocol):
    """The streams of one client."""

    input: BinaryIO
    output: BinaryIO

    def close(self) -> None:
        """Close the connection, which also ends a read in another thread."""
        ...


class BoundedInput:
    """The lines and contents that pygls reads, with normalised headers.

    A message above the size limit is skipped and logged. After a broken header, reading continues at the next valid
    one. A ``timer`` ends the stream if a header takes too long.
    """

    def __init__(self, stream: BinaryIO, timer: HeaderTimer | None = None) -> None:
        self._stream = stream
        self._timer = timer
        self._in_header = False
        self._has_length = False

    def readline(self) -> bytes:
        """Return the next header line, or ``b""`` at the end of the input."""
        line = self._header_line()
        stated = _LENGTH.search(line)
        if stated is not None:
            length = int(stated[1])
            if length > MESSAGE_SIZE.value():
                _LOG.error("skipped a message of %d bytes; the limit is %d", length, MESSAGE_SIZE.value())
                return self._skip(length)
            self._has_length = length > 0
            return b"Content-Length: %d\r\n" % length if self._has_length else b"\n"
        if line and not line.strip():
            if not self._has_length:
                _LOG.error("skipped a message without 'Content-Length'")
            return b"\r\n"
        return line

    def read(self, size: int) -> bytes:
        """Return the content of a message. It is shorter than ``size`` at the end of the input."""
        self._has_length = False
        return self._stream.read(size)

    def _header_line(self) -> bytes:
        if self._timer is not None and not self._in_header:
            self._timer.begin_header()
        line = self._line()
        self._in_header = bool(line.strip())
        if self._timer is not None and line and not self._in_header:
            self._timer.end_header()
        return line

    def _line(self) -> bytes:
        line = self._stream.readline(LONGEST_HEADER)
        while len(line) >= LONGEST_HEADER and not line.endswith(b"\n"):
            # The last bytes may be the beginning of a valid header.
            line = line[-128:] + self._stream.readline(LONGEST_HEADER)
        return line

    def _skip(self, length: int) -> bytes:
        while self._header_line().strip():
            pass
        while length > 0 and (data := self._stream.read(min(length, _CHUNK))):
            length -= len(data)
        return b"\n" if length == 0 else b""


def bounded(stream: IO[bytes], timer: HeaderTimer | None = None) -> BinaryIO:
    """Return a stream for pygls, which uses only its methods for reading lines and contents."""
    return cast("BinaryIO", BoundedInput(cast("BinaryIO", stream), timer))


def end_soon(code: int, seconds: float = EXIT_SECONDS) -> None:
    """End the process with an exit code within some seconds, even if a thread, a task or a worker hangs."""

    def end() -> None:
        _LOG.error("work is still running %g s after the end of the session: ending the process", seconds)
        os._exit(code)

    timer = threading.Timer(seconds, end)
    timer.daemon = True
    timer.start()


async def end_after_loop(code: Callable[[], int]) -> None:
    """Make sure that the process ends soon after the event loop, whether by ``exit``, Ctrl-C or the client's end.

    The loop waits for its tasks, but a task that is starting a process may never end (CPython 3.11). It also notices a
    Ctrl-C that comes right before it begins to wait only when it wakes, which it does regularly here. ``code`` returns
    the exit code.
    """
    try:
        while True:
            await asyncio.sleep(WAKING_SECONDS)
    finally:
        end_soon(code())


class RefusalFilter(logging.Filter):
    """A logging filter that drops deliberate error responses, for example the refusal of an invalid rename."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a log record is an error of the server itself."""
        error = record.exc_info[1] if record.exc_info else None
        if error is None or not record.name.startswith("pygls"):
            return True
        return not any(kind.__name__ == "JsonRpcException" for kind in type(error).__mro__)
