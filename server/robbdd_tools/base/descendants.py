"""Ends the processes that code of users leaves behind, daemons in sessions of their own included.

On Linux they are found in ``/proc``: as descendants of the agent, which adopts orphans, and once that has ended by the
mark in the environment that they inherited from it. Elsewhere only the members of its group are found, see
``processes.end_group``.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path

MARK = "ROBBDD_AGENT"
"""Environment variable whose value is different for each agent."""
PROCESSES = Path("/proc")
_SET_CHILD_SUBREAPER = 36
"""``PR_SET_CHILD_SUBREAPER`` of ``linux/prctl.h``."""
_ROUNDS = 100
"""Searches for processes that begin while others are ended, until they are left alone."""


def adopt_orphans() -> None:
    """Become the parent of all descendants whose own parent ends, so that ``end_descendants`` finds them."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def end_descendants() -> None:
    """End the processes below this one at once."""
    _end_all(lambda: _below(os.getpid()))


def end_marked(mark: str) -> None:
    """End the processes that inherited a value of ``MARK`` at once."""
    entry = f"{MARK}={mark}".encode()
    _end_all(lambda: (pid for pid in _pids() if pid != os.getpid() and entry in _environment(pid)))


def _end_all(find: Callable[[], Iterable[int]]) -> None:
    if sys.platform == "win32":
        return
    for _ in range(_ROUNDS):
        found = list(find())
        if not found:
            return
        for pid in found:
            with suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        for pid in found:
            # An own child, adopted ones included, stays as a zombie until someone asks for its end.
            with suppress(OSError):
                os.waitpid(pid, 0)


def _below(root: int) -> Iterator[int]:
    children: dict[int, list[int]] = {}
    for pid in _pids():
        children.setdefault(_parent(pid), []).append(pid)
    waiting = children.get(root, [])
    while waiting:
        pid = waiting.pop()
        yield pid
        waiting += children.get(pid, ())


def _pids() -> Iterator[int]:
    """Yield the numbers of running processes; none where the system does not list them as files."""
    with suppress(OSError):
        yield from (int(entry.name) for entry in PROCESSES.iterdir() if entry.name.isdecimal())


def _parent(pid: int) -> int:
    """Return the number of a process's parent; 0 for one that has ended."""
    try:
        # The name, in parentheses, may hold anything.
        state, parent = (PROCESSES / str(pid) / "stat").read_bytes().rpartition(b")")[2].split()[:2]
    except (OSError, ValueError):
        return 0
    return 0 if state in (b"Z", b"X") else int(parent)


def _environment(pid: int) -> list[bytes]:
    try:
        return (PROCESSES / str(pid) / "environ").read_bytes().split(b"\0")
    except OSError:
        return []
