"""Standard input and output as the connection of a client, with a read that the server can end."""

from __future__ import annotations

import io
import os
import select
import sys
from typing import TYPE_CHECKING, BinaryIO

from robbdd_tools.lsp.transport import bounded

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer


class StandardStreams:
    """The streams of a client that has started this process.

    The client may keep its end open after ``exit``, while a thread reads from it. On a system without ``poll``
    (Windows), ``close`` has no effect: the process ends by ``end_soon`` then.
    """

    def __init__(self) -> None:
        self._interruptible = _Interruptible(sys.stdin.fileno()) if hasattr(select, "poll") else None
        self.input: BinaryIO = bounded(
            sys.stdin.buffer if self._interruptible is None else io.BufferedReader(self._interruptible)
        )
        self.output: BinaryIO = sys.stdout.buffer

    def close(self) -> None:
        """End a read in another thread, and all later ones."""
        if self._interruptible is not None:
            self._interruptible.interrupt()


class _Interruptible(io.RawIOBase):
    """The bytes of a file descriptor, until its end or an interruption."""

    def __init__(self, descriptor: int) -> None:
        super().__init__()
        self._descriptor = descriptor
        self._woken, self._waker = os.pipe()
        self._ready = select.poll()
        self._ready.register(descriptor, select.POLLIN)
        self._ready.register(self._woken, select.POLLIN)

    def interrupt(self) -> None:
        """Let this read and all later ones return the end of the stream."""
        os.write(self._waker, b"\0")

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: WriteableBuffer, /) -> int:
        if any(descriptor == self._woken for descriptor, _ in self._ready.poll()):
            return 0
        return os.readv(self._descriptor, [buffer])
