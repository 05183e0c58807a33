"""Size-limited log of an agent process's output."""

from __future__ import annotations

import os
from pathlib import Path
from threading import Thread
from typing import IO

from robbdd_tools.base.files import load_bytes
from robbdd_tools.base.limits import RESULT_SIZE

LIMIT = 4 * 1024 * 1024
"""Bytes kept of one agent process's output: half from its beginning, half from its end."""
_PART = 65536


class BoundedLog:
    """Copy everything that is written to ``stream`` to a log file of limited size.

    A log of more than ``limit`` bytes keeps only its first and its last half. The first half is written immediately,
    the last half when the write end of ``stream`` is closed. If the disk is full, only the log is lost. The constructor
    raises ``OSError`` if the file cannot be created.
    """

    def __init__(self, path: Path, limit: int = LIMIT) -> None:
        self.path = path
        self._half = max(1, limit // 2)
        self._file = path.open("wb", buffering=0)
        self._read, write = os.pipe()
        self.stream: IO[bytes] = os.fdopen(write, "wb", buffering=0)
        """Standard error stream for the process. Close it once the process has it."""
        self._thread = Thread(target=self._copy, daemon=True)
        self._thread.start()

    def wait(self, seconds: float) -> None:
        """Wait at most ``seconds`` until the log is complete.

        An escaped child process may still hold the stream open.
        """
        self._thread.join(seconds)

    def last_line(self) -> str:
        """Return the last non-empty line of the log."""
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
                self._write(f"\n… {cut} bytes left out: the output exceeds the log's limit …\n".encode())
            self._write(tail[-self._half :])
        os.close(self._read)

    def _write(self, data: bytes | bytearray) -> None:
        left = memoryview(data)
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError:
            # Keep reading, so that the process does not block on a full pipe.
            return
