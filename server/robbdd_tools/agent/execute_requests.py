"""Read the orders of the parent, and end this process when the parent is gone."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from queue import SimpleQueue
from time import sleep
from typing import TextIO

PAUSE = 0.2
"""Seconds between two checks that the parent process is alive, after it has closed the stream."""


def read_requests(stream: TextIO) -> Iterator[str]:
    """Yield the lines of a stream as they arrive.

    When the stream ends and the parent process is gone, this process exits immediately, even while it executes a
    scenario. If the parent is alive, all orders are completed.
    """
    lines: SimpleQueue[str | None] = SimpleQueue()
    threading.Thread(target=_read, args=(stream, os.getppid(), lines), daemon=True).start()
    while (line := lines.get()) is not None:
        yield line


def _read(stream: TextIO, parent: int, lines: SimpleQueue[str | None]) -> None:
    for line in stream:
        lines.put(line)
    lines.put(None)
    while os.getppid() == parent:
        sleep(PAUSE)
    os._exit(1)
