"""The orders of the parent process, and the end of this process when the parent is gone."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from queue import SimpleQueue
from time import sleep
from typing import TextIO

PAUSE = 0.2
"""Seconds between two looks at whether the parent process is still there, once it has closed its end."""


def read_orders(stream: TextIO) -> Iterator[str]:
    """Yield the lines of a stream as they come.

    Whatever is being executed, this process ends at once when the stream has ended and the parent process is gone. A
    parent that has sent all that it wants gets it done.
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
