"""What a process and its descendants hold of the machine: memory, descriptors, threads."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import psutil


@dataclass(frozen=True, slots=True)
class Usage:
    """``memory`` is resident bytes of each process, the server first, by order of start; the rest are sums."""

    memory: tuple[int, ...]
    descriptors: int
    threads: int

    @property
    def processes(self) -> int:
        """How many processes there are."""
        return len(self.memory)

    @property
    def total(self) -> int:
        """Resident bytes of all processes."""
        return sum(self.memory)


def usage(pid: int) -> Usage:
    """Return the resources of a process and its descendants; processes that end in the meantime are skipped."""
    found = [entry for process in _family(pid) if (entry := _held(process)) is not None]
    memory, descriptors, threads = zip(*found, strict=True)
    return Usage(memory, sum(descriptors), sum(threads))


def _family(pid: int) -> Iterator[psutil.Process]:
    first = psutil.Process(pid)
    yield first
    yield from sorted(first.children(recursive=True), key=lambda child: child.pid)


def _held(process: psutil.Process) -> tuple[int, int, int] | None:
    with suppress(psutil.NoSuchProcess), process.oneshot():
        return process.memory_info().rss, _descriptors(process), process.num_threads()
    return None


def _descriptors(process: psutil.Process) -> int:
    return getattr(process, "num_fds" if psutil.POSIX else "num_handles")()
