"""Read the orders of the parent, and end this process when the parent is gone."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from queue import SimpleQueue
from time import sleep
from typing import TextIO

PAUSE = 0.2
"""After the parent process has closed the stream, check at this interval (s) that the parent is alive."""


def read_requests(stream: TextIO, is_taken: Callable[[str], bool] = lambda _: False) -> Iterator[str]:
    """Yield the lines of a stream as they arrive, except those that ``is_taken`` takes in the reading thread.

    When the stream ends and the parent process is gone, this process exits immediately, even while it executes a
    scenario. If the parent is alive, all orders are completed.
    """
    lines: SimpleQueue[str | None] = SimpleQueue()
    threading.Thread(target=_read, args=(stream, is_taken, os.getppid(), lines), daemon=True).start()
    while (line := lines.get()) is not None:
        yield line


def _read(stream: TextIO, is_taken: Callable[[str], bool], parent: int, lines: SimpleQueue[str | None]) -> None:
    for line in stream:
        if not is_taken(line):
            lines.put(line)
    lines.put(None)
    while os.getppid() == parent:
        sleep(PAUSE)
    os._exit(1)
