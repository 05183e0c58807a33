"""The connection of a TCP client, with the limits of standard input and a time limit for headers."""

from __future__ import annotations

import io
import logging
import selectors
import socket
from contextlib import ExitStack, suppress
from time import monotonic
from typing import TYPE_CHECKING, BinaryIO, cast

from robbdd_tools.base.limits import HEADER_SECONDS
from robbdd_tools.lsp.transport import bounded

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

_LOG = logging.getLogger(__name__)


def accept_client(host: str, port: int) -> socket.socket:
    """Wait for one client at all addresses of a host and return its connection; raises ``OSError``."""
    found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    with ExitStack() as listeners, selectors.DefaultSelector() as selector:
        for family, address in dict.fromkeys((family, address) for family, _, _, _, address in found):
            listener = listeners.enter_context(socket.create_server(address[:2], family=family))
            selector.register(listener, selectors.EVENT_READ)
        (ready, _), *_ = selector.select()
        connection, _ = cast("socket.socket", ready.fileobj).accept()
    return connection


class TcpConnection:
    """The input and output of one client."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection
        self._received = _Received(connection)
        self._lines = io.BufferedReader(self._received)
        self.input = bounded(self._lines, self)
        self.output: BinaryIO = connection.makefile("wb")

    def close(self) -> None:
        """Close the connection, which also ends a read in another thread."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()

    def begin_header(self) -> None:
        """Wait for the first byte of a header, then start its time."""
        self._lines.peek(1)
        self._received.deadline = monotonic() + HEADER_SECONDS.value()

    def end_header(self) -> None:
        """Stop the time: the header is complete."""
        self._received.deadline = None


class _Received(io.RawIOBase):
    """The bytes from a client. They end when the client is gone or at the deadline (by ``monotonic``, in seconds)."""

    def __init__(self, connection: socket.socket) -> None:
        super().__init__()
        self._socket = connection
        self.deadline: float | None = None

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: WriteableBuffer, /) -> int:
        if self.deadline is not None and not self._is_ready(self.deadline - monotonic()):
            _LOG.error("closed the connection: a header took longer than %d s", HEADER_SECONDS.value())
            return 0
        try:
            return self._socket.recv_into(buffer)
        except OSError:
            return 0

    def _is_ready(self, seconds: float) -> bool:
        if seconds <= 0:
            return False
        with selectors.DefaultSelector() as selector:
            selector.register(self._socket, selectors.EVENT_READ)
            return bool(selector.select(seconds))
