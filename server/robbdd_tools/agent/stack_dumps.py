"""Dump the stack of this process for its parent when the process crashes, exits or takes too long.

The fault handler of the interpreter writes the dump, in a signal handler or in a thread that does not need the
interpreter.
"""

from __future__ import annotations

import faulthandler
import os
from pathlib import Path
from typing import Any, BinaryIO

from robbdd_tools.protocol.run_folder import CRASH, LIMIT, STARTUP, call_file, dump_file
from robbdd_tools.user_code import call_note

_file: BinaryIO | None = None
_limit = 0.0


def install() -> None:
    """Dump the stack if this process crashes, or if it is not ready within ``STARTUP`` seconds.

    This has no effect in a process that was started by hand.
    """
    global _file, _limit
    base, limit = os.environ.pop(CRASH, ""), os.environ.pop(LIMIT, "0")
    if not base:
        return
    _limit = float(limit)
    _file = dump_file(Path(base)).open("ab", buffering=0)
    call_note.keep_in(call_file(Path(base)))
    faulthandler.enable(_file)
    _dump_before_leaving(_file)
    _watch(STARTUP)


def watch() -> None:
    """Dump the stack when a scenario's time limit expires."""
    _watch(_limit)


def rest() -> None:
    """Cancel the dump at the time limit, and delete an earlier dump."""
    if _file is not None:
        faulthandler.cancel_dump_traceback_later()
        _file.truncate(0)


def _watch(seconds: float) -> None:
    rest()
    if _file is not None and seconds:
        faulthandler.dump_traceback_later(seconds, file=_file)


def _dump_before_leaving(file: BinaryIO) -> None:
    """Make ``os._exit`` dump the stack first, because it bypasses all handlers. Child processes are not affected."""
    leave, own = os._exit, os.getpid()

    def dump_and_leave(status: int) -> None:
        if os.getpid() == own:
            faulthandler.dump_traceback(file, all_threads=False)
        leave(status)

    replaced: Any = os
    replaced._exit = dump_and_leave
