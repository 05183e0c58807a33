"""End all processes that users' code leaves running, including daemons in sessions of their own.

On Linux they are found in ``/proc``. While the agent runs, they are its descendants, because it adopts orphans. After
the agent has ended, they are found by the mark in their environment, which they have inherited. On other systems, only
the members of the agent's process group are found (see ``processes.end_group``).
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
"""Name of an environment variable. Each agent sets it to a different value."""
PROCESSES = Path("/proc")
_SET_CHILD_SUBREAPER = 36
"""``PR_SET_CHILD_SUBREAPER`` of ``linux/prctl.h``."""
_ROUNDS = 100
"""Maximum number of searches, since processes may start while others are ended."""


def adopt_orphans() -> None:
    """Make this process the parent of all its orphaned descendants, so that ``end_descendants`` finds them."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def end_descendants() -> None:
    """Kill all descendants of this process."""
    _end_all(lambda: _below(os.getpid()))


def end_marked(mark: str) -> None:
    """Kill all processes whose environment has this value of ``MARK``."""
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
            # A child, adopted ones included, stays a zombie until its parent waits for it.
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
    """Yield the IDs of running processes; none on systems without ``/proc``."""
    with suppress(OSError):
        yield from (int(entry.name) for entry in PROCESSES.iterdir() if entry.name.isdecimal())


def _parent(pid: int) -> int:
    """Return the id of the parent of a process; 0 if the process has ended."""
    try:
        # The process name, in parentheses, may contain any character.
        state, parent = (PROCESSES / str(pid) / "stat").read_bytes().rpartition(b")")[2].split()[:2]
    except (OSError, ValueError):
        return 0
    return 0 if state in (b"Z", b"X") else int(parent)


def _environment(pid: int) -> list[bytes]:
    try:
        return (PROCESSES / str(pid) / "environ").read_bytes().split(b"\0")
    except OSError:
        return []
