"""Read an input of this process so that another thread can interrupt the read. This needs the system call ``poll``."""

from __future__ import annotations

import io
import os
import select
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

CAN_INTERRUPT = hasattr(select, "poll")
"""Whether this system has ``poll``, which Windows lacks."""


class InterruptibleInput(io.RawIOBase):
    """Reads a file descriptor until its end or an interruption. It needs ``CAN_INTERRUPT``."""

    def __init__(self, descriptor: int) -> None:
        super().__init__()
        self._descriptor = descriptor
        self._woken, self._waker = os.pipe()
        self._ready = select.poll()
        self._ready.register(descriptor, select.POLLIN)
        self._ready.register(self._woken, select.POLLIN)

    def interrupt(self) -> None:
        """Let this read and all later ones return the end of the input."""
        os.write(self._waker, b"\0")

    def readable(self) -> bool:
        """Return true: the stream can be read."""
        return True

    def readinto(self, buffer: WriteableBuffer, /) -> int:
        """Read into a buffer; return the number of bytes, 0 at the end."""
        if any(descriptor == self._woken for descriptor, _ in self._ready.poll()):
            return 0
        return os.readv(self._descriptor, [buffer])
