"""The log of an agent process: all that its code and users' code print, within a limit."""

from __future__ import annotations

import os
from pathlib import Path
from threading import Thread
from typing import IO

from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.limits import RESULT_SIZE

LIMIT = 4 * 1024 * 1024
"""Bytes that are kept of what one agent process prints, half from the beginning and half from the end."""
_PART = 65536


class BoundedLog:
    """Copies what is written to ``stream`` to a file; of more than ``limit`` bytes only the first and the last half.

    The first half is written at once, the last one when nobody can write any more. A disk that is full costs the log
    only. Raises ``OSError`` where the file cannot be made.
    """

    def __init__(self, path: Path, limit: int = LIMIT) -> None:
        self.path = path
        self._half = max(1, limit // 2)
        self._file = path.open("wb", buffering=0)
        self._read, write = os.pipe()
        self.stream: IO[bytes] = os.fdopen(write, "wb", buffering=0)
        """What the process gets as its standard error stream; close it once the process has it."""
        self._thread = Thread(target=self._copy, daemon=True)
        self._thread.start()

    def wait(self, seconds: float) -> None:
        """Wait until the log is complete, at most for a time: a process that got away may hold it open."""
        self._thread.join(seconds)

    def last_line(self) -> str:
        """Return the last line that is not empty."""
        try:
            lines = load_bytes(self.path, RESULT_SIZE).decode(errors="replace").split("\n")
        except OSError:
            return ""
        return next((line.strip() for line in reversed(lines) if line.strip()), "")

    def _copy(self) -> None:
        room, cut, tail = self._half, 0, bytearray()
        with self._file:
            while part := os.read(self._read, _PART):
                self._write(part[:room])
                tail += part[room:]
                room -= len(part[:room])
                if len(tail) > 2 * self._half + _PART:
                    cut += len(tail) - self._half
                    del tail[: -self._half]
            cut += max(0, len(tail) - self._half)
            if cut:
                self._write(f"\n… {cut} bytes are left out: more was printed than the log may hold …\n".encode())
            self._write(tail[-self._half :])
        os.close(self._read)

    def _write(self, data: bytes | bytearray) -> None:
        left = memoryview(data)
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError:
            # The process must not wait for a log that nobody reads any more.
            return
